// The solver `matrix`: all form factors, then the whole linear system at once (Goral, Torrance, Greenberg,
// Battaile: Modeling the Interaction of Light Between Diffuse Surfaces, 1984).
//
// Factors between the elements come from polygon_factors.h: exact where nothing is in between, and by no
// route that the passes take, which makes it a check on them. Time and memory grow with the square of the
// number of elements, and the solve with its cube.
#include "engine/solve/solve_matrix.h"

#include "engine/base/linear_system.h"
#include "engine/solve/solution.h"

#include <algorithm>
#include <stdexcept>

namespace patchlight {
namespace {

// Each element a polygon of its own, so that its factors can be asked for.
FaceTable make_element_faces(const PatchTable& elements, const FaceTable& faces,
                             const FaceFrameTable& frames) {
  FaceTable cells;
  for (uint32_t row = 0; row < elements.size(); ++row) {
    const uint32_t face = elements.face[row];
    for_each_column([&](const char*, const auto& from, auto& to) { to.push_back(from[face]); }, faces, cells);
    cells.corners.back() = cell_corners(frames, face, elements.cell[row], elements.level[row]);
    cells.polygon.back() = row;
    cells.surface.back() = cells.twin.back() = kNone;
    cells.patch_size.back() = cells.patch_size_min.back() = 0;
    cells.level_min.back() = 0;
  }
  return cells;
}

// One channel of the elements' irradiance H, from A H = X (E + rho H) + A S, A the exposed areas, X the
// exchange areas A_i F_ij and S what the sky brings: with r = sqrt(rho / A) and y = sqrt(rho A) H the matrix
// I - r X r is symmetric, and positive definite since rows of X sum to A at most. H = X (E + r y) / A + S
// then mends rounding, too.
struct Channel {
  std::vector<double> emission, sky, root,
      irradiance;  // root: r; 0 for a buried element, which takes part in nothing
};

bool solve_channel(Channel& channel, std::vector<double>& matrix, const FactorTable& factors,
                   std::span<const double> area) {
  const size_t n = area.size();
  matrix.resize(n * n);
  const auto multiply = [&](std::vector<double>& out, std::span<const double> sent) {
    out.resize(n);
    for_rows(n, 16, [&](size_t begin, size_t end) {
      for (size_t i = begin; i < end; ++i) {
        out[i] = 0;
        for (size_t j = 0; j < n; ++j) out[i] += find_exchange(factors, i, j) * sent[j];
      }
    });
  };
  for_rows(n, 16, [&](size_t begin, size_t end) {
    for (size_t j = begin; j < end; ++j)
      for (size_t i = j; i < n; ++i)
        matrix[j * n + i] = (i == j) - channel.root[i] * channel.root[j] * find_exchange(factors, i, j);
  });
  std::vector<double> y, sent = channel.emission;
  multiply(y, sent);
  for (size_t i = 0; i < n; ++i) y[i] = channel.root[i] * (y[i] + area[i] * channel.sky[i]);
  if (!solve_positive_definite(matrix, y)) return false;
  for (size_t i = 0; i < n; ++i) sent[i] += channel.root[i] * y[i];
  multiply(channel.irradiance, sent);
  for (size_t i = 0; i < n; ++i)
    channel.irradiance[i] = area[i] > 0 ? channel.irradiance[i] / area[i] + channel.sky[i] : 0;
  return true;
}

// sky: a row an element, or empty.
Channel make_channel(const PatchTable& elements, std::span<const double> area, const FaceTable& faces,
                     std::span<const Rgb> sky, int k) {
  Channel channel;
  for (size_t row = 0; row < elements.size(); ++row) {
    const uint32_t face = elements.face[row];
    channel.emission.push_back(double{faces.emission[face][k]});
    channel.sky.push_back(sky.empty() ? 0 : double{sky[row][k]});
    channel.root.push_back(area[row] > 0 ? std::sqrt(double{faces.reflectance[face][k]} / area[row]) : 0);
  }
  return channel;
}

}  // namespace

FactorTable find_element_factors(const Solution& s) {
  const FaceTable cells = make_element_faces(s.mesh.elements, s.surfaces->faces, s.surfaces->frames);
  const FactorScene scene = make_factor_scene(cells, cells.size());
  FactorTable factors = make_factor_table(scene, cells.size());
  while (extend_factors(factors, scene, cells, s.surfaces->tracer, {.seed = s.settings.seed})) {
  }
  return factors;
}

const PassReport& solve_matrix(Solution& s) {
  const WorkersScope scope(s.workers);
  Stopwatch watch;
  if (!s.mesh.frozen) freeze(s);
  const FaceTable& faces = s.surfaces->faces;
  const size_t n = s.mesh.elements.size();
  const FactorTable factors = find_element_factors(s);
  const std::vector<Rgb> sky = find_sky_light(s);
  s.log.trace_seconds += watch.lap();
  s.log.factor_count += uint64_t{n} * n;
  s.log.transport_ray_count += factors.ray_count;

  std::vector<double> area(n), matrix;
  for (size_t i = 0; i < n; ++i) area[i] = factors.area[i] * double{s.mesh.elements.exposed[i]};
  Channel before;
  for (int k = 0; k < 3; ++k) {
    Channel channel = make_channel(s.mesh.elements, area, faces, sky, k);
    if (k > 0 && channel.root == before.root && channel.emission == before.emission &&
        channel.sky == before.sky)
      channel.irradiance = before.irradiance;
    else if (!solve_channel(channel, matrix, factors, area))
      throw std::domain_error("the system of equations has no solution");
    for (size_t i = 0; i < n; ++i) s.light.sharp[i][k] = static_cast<float>(channel.irradiance[i]);
    before = std::move(channel);
  }

  PassReport report;
  report.pass = static_cast<uint32_t>(s.log.passes.size()) + 1;
  report.ray_count = factors.ray_count;
  for (size_t row = 0; row < n; ++row) {
    const uint32_t face = s.mesh.elements.face[row];
    s.mesh.elements.radiosity[row] = faces.emission[face] + faces.reflectance[face] * s.light.sharp[row];
    s.mesh.elements.unshot[row] = Rgb(0);
  }
  report_added(report, s,
               [&](size_t row) { return faces.reflectance[s.mesh.elements.face[row]] * s.light.sharp[row]; });
  s.mesh.patches.radiosity = find_patch_means(s, s.mesh.elements.radiosity);
  std::fill(s.mesh.patches.unshot.begin(), s.mesh.patches.unshot.end(), Rgb(0));
  report.seconds = watch.lap();
  s.log.solve_seconds += report.seconds;
  return s.log.passes.emplace_back(report);
}

bool is_solved(const Solution& s) { return !s.log.passes.empty(); }

}  // namespace patchlight
