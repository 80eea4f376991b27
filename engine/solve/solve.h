// The solver as its callers see it.
//
//   auto surfaces = make_surfaces(faces);               // mesh/surfaces.h; throws where faces are wrong
//   Solution solution = make_solution(surfaces, settings);
//   while (refine(solution)) {                          // rounds, until nothing splits
//   }
//   freeze(solution);                                   // the mesh is final: pictures can be taken
//   while (!is_converged(solution)) advance(solution);  // pass by pass
//   std::vector<Rgb> radiosity = vertex_radiosity(solution);
//
// The caller owns the loops, the pictures in between and the stopping rule. Nothing here prints. All throw
// Cancelled once the solution's workers are asked to stop (parallel.h). Other ways to solve a frozen mesh:
// solvers.h. Pictures: film.h.
#pragma once

#include "engine/base/parallel.h"
#include "engine/light/emitters.h"
#include "engine/mesh/mesh.h"
#include "engine/mesh/surfaces.h"
#include "engine/settings.h"
#include "engine/transport/smoothing.h"

#include <optional>

namespace patchlight {

struct Scenery;

struct RoundReport {
  uint32_t round = 0;        // 1 is the starting mesh
  uint64_t patch_count = 0;  // elements after the round
  uint64_t split_count = 0;  // elements that it split
  uint64_t ray_count = 0;
  double seconds = 0;
};

// Powers in W when areas are m2: multiply by (metres a length) squared. Of other solvers (solvers.h): a shot,
// or the whole solution.
struct PassReport {
  uint32_t pass = 0;        // 1 is the first
  uint64_t ray_count = 0;   // rays that this pass cast, or whose results it used for the first time
  DRgb added_power{0};      // sum of area times the radiosity that the pass added
  DRgb unshot_power{0};     // the same of what nobody has sent on yet
  float added_largest = 0;  // largest radiosity that the pass added to any element, W/m2
  double seconds = 0;
};

// Measured, not made to fit: closure_error = |emitted - absorbed - escaped - unshot| / emitted. Of the sky
// and the sun, what first strikes a lit side counts as emitted.
struct PowerLedger {
  DRgb emitted{0}, absorbed{0}, escaped{0}, unshot{0};
  double closure_error = 0;
};

// What light travels along.
struct Transport {
  EmitterGroups groups;
  std::vector<float> emission_by_rows;  // a row a polygon: what its rows see of the emitters
  SightTable sights;                    // a row a receiver
  ReceiverTable receivers;              // of the patches
  HitTable hits;                        // a row of rays a receiver
  SmoothingTable smoothing;             // of what rows carry; made when the mesh is final
};

// In W/m2. The irradiance of an element, under every solver: its row of `sharp` and, at its centre, the
// surface of `smooth`. Radiosity is a column of the mesh.
struct Irradiance {
  std::vector<Rgb> sharp;           // a row an element: what was found element by element
  std::vector<Rgb> smooth;          // a row a patch: what was found patch by patch
  std::vector<Rgb> smooth_added;    // a row a patch: what the last pass added to it
  std::vector<float> smooth_error;  // a row a patch: what may be wrong in it, root mean square
  std::vector<Rgb> direct;          // a row an element: from the lamps aimed at
  std::vector<float> direct_error;  // a row an element: its standard error (luminance)
  std::vector<float> direct_noise;  // a row an element: a sample of its error (channels' mean)
  std::vector<Rgb> coarse;          // a row a patch: all bounces, as the coarse solution forecasts them
  std::vector<float> coarse_error;  // a row a patch: its standard error (luminance)
  float mean_radiosity = 0;         // of the coarse solution, reflected light only (largest channel)
};

struct Log {
  std::vector<RoundReport> rounds;
  std::vector<PassReport> passes;
  double trace_seconds = 0, split_seconds = 0, solve_seconds = 0;
  uint64_t direct_ray_count = 0;
  uint64_t transport_ray_count = 0;  // probes, rows and the aimed rays of pass 2, or rays of shots
  uint64_t factor_count = 0;         // form factors that the steps so far took, each estimate of one counted
};

// What only the solver `shooting` keeps.
struct ShootingState {
  std::vector<uint32_t> shots;  // a row a patch: how often it was the shooter
  double power = 0;             // what all shots added, as PassReport has it, channels summed
};

struct Solution {
  std::shared_ptr<const Surfaces> surfaces;
  SolverSettings settings;
  std::shared_ptr<Workers> workers;
  Mesh mesh;
  Transport transport;
  Irradiance light;
  Log log;
  std::optional<ShootingState> shooting;
};

// Starting meshes, the rows of all patches and a coarse solution on them. Workers: those that all later steps
// run on, too.
Solution make_solution(std::shared_ptr<const Surfaces> surfaces, const SolverSettings& settings,
                       std::shared_ptr<Workers> workers = current_workers());

// One refinement round: splits where neighbours differ; false once nothing splits (then nothing has changed).
bool refine(Solution& solution);

// The mesh is final from here on: casts more rays where shadow edges lie, shares out the corners of the
// elements and sets B = E, before pass 1.
void freeze(Solution& solution);

// One pass: adds the next bounce; freezes the mesh if that was not done.
const PassReport& advance(Solution& solution);

// True once the last pass added less than the share `until` of what pass 1 added: of its largest radiosity,
// and of its power. Beside a small bright spot the first alone would leave a dim room short of its last
// bounces.
bool is_converged(const Solution& solution);

// Radiosity at the vertices of the elements after the passes so far, W/m2: what the smooth picture shows.
// ambient: irradiance that is added everywhere, as find_ambient() guesses it.
std::vector<Rgb> vertex_radiosity(const Solution& solution, Rgb ambient = Rgb(0));
// The same as a converged guess before pass 1, from the coarse solution: for choosing an exposure.
std::vector<Rgb> vertex_radiosity_forecast(const Solution& solution);
// A guess of what the light that no shot has sent yet will bring, W/m2; 0 where no shots are.
Rgb find_ambient(const Solution& solution);

// What a picture is taken of: make_film(make_scenery(solution), view, settings) (film.h). Refers to the
// solution.
Scenery make_scenery(const Solution& solution);

// Irradiance of each element after the passes so far, W/m2.
std::vector<Rgb> element_irradiance(const Solution& solution);

// Where the power went, after the passes so far.
PowerLedger find_power_ledger(const Solution& solution);

// 64-bit hash of all element radiosities: equal runs have equal hashes.
uint64_t find_solution_hash(const Solution& solution);

// Bytes that the tables hold now.
uint64_t count_bytes(const Solution& solution);

}  // namespace patchlight
