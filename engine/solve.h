// The solver as its callers see it: make the meshes, refine them in rounds, then advance pass by pass.
//
//   Solution solution = make_solution(faces, tracer, settings);
//   while (refine(solution, faces, tracer, settings)) {}           // rounds, until nothing splits
//   freeze(solution, faces, tracer, settings);                     // the mesh is final; pictures can be
//   taken while (solution.passes.size() < wanted) advance(solution, faces, tracer, settings);
//
// The caller owns the loops, the pictures in between and the stopping rule. Nothing here prints.
#pragma once

#include "rows.h"
#include "settings.h"
#include "tracer.h"

#include <cstdint>
#include <vector>

namespace patchlight {

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

// Measured, not made to fit: closure_error = |emitted - absorbed - escaped - unshot| / emitted.
struct PowerLedger {
  DRgb emitted{0}, absorbed{0}, escaped{0}, unshot{0};
  double closure_error = 0;
};

struct Seconds {
  double trace = 0, split = 0, solve = 0;
};

struct Solution {
  FaceFrameTable frames;
  FaceLinkTable links;   // within polygons
  FaceLinkTable joints;  // and across smooth edges between them
  PatchTable patches, elements;
  std::vector<uint32_t> element_first;  // CSR: patch -> its elements, patches + 1
  std::vector<uint32_t> element_patch;  // a row an element
  VertexTable patch_vertices;           // of the patches; of the elements once the mesh is frozen
  VertexTable element_vertices;
  AimTable aims;
  LampViewTable views;               // a row an element
  std::vector<SplitReason> reasons;  // a row an element
  LeafIndex patch_index;
  ReceiverTable receivers;            // of the patches
  HitTable hits;                      // a row of rays a receiver
  std::vector<Rgb> direct;            // a row an element: irradiance from the lamps aimed at, W/m2
  std::vector<float> direct_error;    // a row an element: its standard error, W/m2 (luminance)
  std::vector<Rgb> irradiance;        // a row a patch: all other irradiance of the passes so far, W/m2
  std::vector<Rgb> irradiance_added;  // a row a patch: what the last pass added to it
  std::vector<Rgb> coarse;  // a row a patch: irradiance as the coarse solution forecasts it, all bounces
  std::vector<float> coarse_error;  // a row a patch: its standard error, W/m2 (luminance)
  float mean_radiosity = 0;         // of the coarse solution, reflected light only, W/m2 (largest channel)
  std::vector<uint32_t> fresh;      // elements that the last round made
  uint64_t direct_ray_count = 0;
  uint64_t transport_ray_count = 0;  // probes, rows and the aimed rays of pass 2, or rays of shots
  std::vector<uint32_t> shots;       // shooting: a row a patch, how often it was the shooter; else empty
  double shot_power = 0;             // shooting: what all shots added, as PassReport has it, channels summed
  Rgb ambient{0};  // shooting: irradiance that pictures add everywhere as a guess of what is unshot, W/m2
  uint64_t factor_count = 0;  // form factors that the steps so far took, each estimate of one counted
  bool frozen = false;        // the mesh is final
  std::vector<RoundReport> rounds;
  std::vector<PassReport> passes;
  Seconds seconds;
};

// Starting meshes, the rows of all patches and a coarse solution on them. Faces must be valid (the loader's
// work).
Solution make_solution(const FaceTable& faces, const Tracer& tracer, const SolverSettings& settings);

// One refinement round: splits where neighbours differ; false once nothing splits (then nothing has changed).
bool refine(Solution& solution, const FaceTable& faces, const Tracer& tracer, const SolverSettings& settings);

// The mesh is final from here on: casts more rays where shadow edges lie, shares out the corners of the
// elements and sets B = E, before pass 1.
void freeze(Solution& solution, const FaceTable& faces, const Tracer& tracer, const SolverSettings& settings);

// One pass: adds the next bounce; freezes the mesh if that was not done.
const PassReport& advance(Solution& solution, const FaceTable& faces, const Tracer& tracer,
                          const SolverSettings& settings);

// True once the last pass added less than the share `until` of what pass 1 added: of its largest radiosity,
// and of its power. Beside a small bright spot the first alone would leave a dim room short of its last
// bounces.
bool is_converged(const Solution& solution, const SolverSettings& settings);

// One shot of the solver `shooting`: the patch with the most unshot power sends it to all elements. The same
// arguments; unshot columns hold what was received and not sent on.
const PassReport& advance_shot(Solution& solution, const FaceTable& faces, const Tracer& tracer,
                               const SolverSettings& settings);
// True once less than the share `until` of what all shots brought is left unshot.
bool is_shot(const Solution& solution, const SolverSettings& settings);

// The solver `matrix`: the converged solution on the frozen mesh at once. Throws std::domain_error where
// light never dies, as in a closed room of reflectance 1.
const PassReport& solve_matrix(Solution& solution, const FaceTable& faces, const Tracer& tracer,
                               const SolverSettings& settings);
bool is_solved(const Solution& solution, const SolverSettings& settings);

// Radiosity at the vertices of the elements after the passes so far, W/m2: what the smooth picture shows.
std::vector<Rgb> vertex_radiosity(const Solution& solution, const FaceTable& faces);
// The same as a converged guess before pass 1, from the coarse solution: for choosing an exposure.
std::vector<Rgb> vertex_radiosity_forecast(const Solution& solution, const FaceTable& faces);

// Irradiance of each element after the passes so far, W/m2: its direct light and the patches' surface at its
// centre.
std::vector<Rgb> element_irradiance(const Solution& solution);

// Where the power went, after the passes so far.
PowerLedger find_power_ledger(const Solution& solution, const FaceTable& faces, const Tracer& tracer,
                              const SolverSettings& settings);

// The rows of the patches, for kernels that gather.
Rows get_rows(const Solution& solution, const FaceTable& faces, const Tracer& tracer,
              const SolverSettings& settings);

// 64-bit hash of all element radiosities: equal runs have equal hashes.
uint64_t find_solution_hash(const Solution& solution);

// Elements that the settings ask for before any split; may exceed 2^32. For limits, before any memory is
// taken.
uint64_t count_starting_patches(const FaceTable& faces, const SolverSettings& settings);
// Bytes that a solve with these settings will hold at its peak, an upper estimate.
uint64_t forecast_bytes(const FaceTable& faces, const SolverSettings& settings, uint64_t starting_patches);
// Bytes that the tables hold now.
uint64_t count_bytes(const Solution& solution);

}  // namespace patchlight
