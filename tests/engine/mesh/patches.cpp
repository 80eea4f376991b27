#include "engine/mesh/patches.h"

#include "tests/scenes.h"

#include <doctest/doctest.h>

#include <algorithm>

using namespace patchlight;

namespace {

FaceTable make_room() {
  FaceTable faces;
  add_box_inward(faces, Vec3(0), Vec3(1), make_box_surfaces(make_surface(0, 0.5f)));
  fit_scene(faces);
  return faces;
}

// A floor of 8 x 8 patches, and light on them that steps up by `step` in its right half.
struct Floor {
  std::shared_ptr<const Surfaces> surfaces;
  PatchTable patches;
  std::vector<float> indirect, total, error;
};
Floor make_floor(float step, float noise) {
  FaceTable faces;
  add_quad(faces, {0, 0, 0}, {0, 0, 1}, {1, 0, 1}, {1, 0, 0}, make_surface(0, 1));
  Floor f;
  f.surfaces = make_surfaces(faces);
  f.patches = make_leaves(faces, f.surfaces->frames, [](uint32_t) { return 3u; });
  for (uint32_t row = 0; row < f.patches.size(); ++row) {
    const Vec3 centre = cell_centre(f.surfaces->frames, 0, f.patches.cell[row], 3);
    f.indirect.push_back(1 + (centre.x > 0.5f ? step : 0));
    f.total.push_back(f.indirect.back() + 1);
    f.error.push_back(noise);
  }
  return f;
}
std::vector<uint8_t> mark(const Floor& f, uint64_t budget, float size_factor) {
  const std::vector<float> reach(f.patches.size(), f.surfaces->reach[0]);
  return mark_uneven(f.patches, {f.indirect, f.total, f.error, reach}, *f.surfaces, {budget, size_factor});
}

}  // namespace

TEST_CASE("patches: finer in corners, balanced, within the budget") {
  FaceTable faces = make_room();
  const auto surfaces = make_surfaces(faces);
  for (const uint64_t budget : {6ull, 1000ull, 100000ull}) {
    uint64_t ray_count = 0;
    const PatchTable patches = make_patches(*surfaces, {budget}, ray_count);
    CHECK(patches.size() <= budget);
    CHECK(patches.size() >= faces.size());
    for (uint32_t row = 0; row < patches.size(); ++row)
      for (uint32_t edge = 0; edge < 4; ++edge) {
        const uint32_t other = find_coarse_neighbour(patches, surfaces->frames, surfaces->links, row, edge);
        if (other != kNone) CHECK(patches.level[row] - patches.level[other] <= 1);
      }
    if (budget < 100000) continue;
    CHECK(ray_count > 0);
    const uint32_t corner = find_leaf(patches, 0, 0),
                   middle = find_leaf(patches, 0, find_cell(false, {0.5f, 0.5f}));
    CHECK(patches.level[corner] > patches.level[middle]);
  }
}

TEST_CASE("patches: no budget is passed for balance") {
  FaceTable faces = make_room();
  add_box_outward(faces, {0.1f, 0, 0.1f}, {0.15f, 0.1f, 0.2f}, make_surface(0, 0.5f));
  const auto surfaces = make_surfaces(faces);
  for (uint64_t budget = faces.size(); budget < 4000; budget += 97) {
    uint64_t ray_count = 0;
    CHECK(make_patches(*surfaces, {budget}, ray_count).size() <= budget);
  }
}

TEST_CASE("patches: a size factor of a half makes them about four times as many") {
  const FaceTable faces = make_room();
  const auto surfaces = make_surfaces(faces);
  uint64_t ray_count = 0;
  const auto count = [&](float factor) {
    return static_cast<double>(make_patches(*surfaces, {1000000, factor}, ray_count).size());
  };
  // Sizes are powers of two: each patch may be up to half as large as it could be, with either factor.
  const double ratio = count(0.5f) / count(1);
  CHECK(ratio > 2);
  CHECK(ratio < 8);
}

TEST_CASE("a probe tells the mean inverse distance to a parallel wall, and who is buried") {
  FaceTable faces = make_room();
  const auto surfaces = make_surfaces(faces);
  const auto probe = [](const Surfaces& all, uint32_t rays) {
    return probe_cell(make_cell_rays(all.faces, {kFloor}, kProbeRays, 1, make_ray_grid(rays)), all);
  };
  const Probe open = probe(*surfaces, 1024);
  CHECK(open.ray_count == 1024);
  CHECK(open.hit_count == 1024);
  CHECK(open.buried_count == 0);
  // In a cube of edge a no hit is farther than sqrt(3) a; with cosine density about the floor a fifth of the
  // rays meets the ceiling at a mean cosine of about 0.9 and the others are nearer on average: 1 / distance
  // lies between 1 / (sqrt(3) a) and, rays near the edges apart, a few times 1 / a.
  const float edge = longest_edge(cell_corners(surfaces->frames, kFloor, 0, 0));
  const float mean = open.inverse_distance_sum / 1024;
  CHECK(mean > 1 / (std::sqrt(3.0f) * edge));
  CHECK(mean < 20 / edge);
  // A floor of its own, with a box about all of it, or about a quarter.
  FaceTable whole;
  add_quad(whole, {0, 0, 0}, {0, 0, 1}, {1, 0, 1}, {1, 0, 0}, {});
  FaceTable quarter = whole;
  add_box_outward(whole, Vec3(-0.5f), Vec3(1.5f, 0.5f, 1.5f), {});
  add_box_outward(quarter, Vec3(-0.5f), Vec3(0.5f), {});
  const Probe buried = probe(*make_surfaces(whole), 64);
  CHECK(buried.ray_count == 64);
  CHECK(buried.buried_count == 64);
  // One origin in each of 8 x 8 strata, and the box ends between two of them.
  CHECK(probe(*make_surfaces(quarter), 64).buried_count == 16);
}

TEST_CASE("uneven light marks the patches on both sides of a step, and nothing else") {
  const Floor f = make_floor(0.5f, 0);
  const std::vector<uint8_t> marks = mark(f, 1000, 1);
  for (uint32_t row = 0; row < marks.size(); ++row) {
    const float x = cell_centre(f.surfaces->frames, 0, f.patches.cell[row], 3).x;
    CHECK(marks[row] == (std::abs(x - 0.5f) < 1 / 8.0f ? 1 : 0));
  }
}

TEST_CASE("even light, steps within the noise and light below a share of the radiosity mark nothing") {
  const auto count = [](const std::vector<uint8_t>& marks) {
    return std::count(marks.begin(), marks.end(), 1);
  };
  CHECK(count(mark(make_floor(0, 0), 1000, 1)) == 0);
  // The noise of a difference is sqrt(2) times that of each side; three of these are allowed.
  CHECK(count(mark(make_floor(0.5f, 0.5f / (3 * 1.4143f)), 1000, 1)) == 0);
  CHECK(count(mark(make_floor(0.5f, 0.4f / (3 * 1.4143f)), 1000, 1)) == 16);
  // 1 % of the radiosity beside the step, 2 + step.
  CHECK(count(mark(make_floor(0.02f, 0), 1000, 1)) == 0);
  CHECK(count(mark(make_floor(0.021f, 0), 1000, 1)) == 16);
  CHECK(count(mark(make_floor(0.02f, 0), 1000, 0.5f)) == 16);
}

TEST_CASE("where the budget ends the largest changes are split, and the budget holds") {
  Floor f = make_floor(0.5f, 0);
  const uint32_t strong = find_leaf(f.patches, 0, find_cell(false, {0.8f, 0.55f}));
  f.indirect[strong] += 3, f.total[strong] += 3;
  // It and its four neighbours see the largest change.
  std::vector<uint8_t> near(f.patches.size(), 0);
  near[strong] = 1;
  for (uint32_t edge = 0; edge < 4; ++edge)
    near[find_neighbours(f.patches, f.surfaces->frames, f.surfaces->links, strong, edge)[0]] = 1;
  uint64_t split_most = 0;
  for (uint64_t budget = 64; budget < 120; ++budget) {
    const std::vector<uint8_t> marks = mark(f, budget, 1);
    const auto split = static_cast<uint64_t>(std::count(marks.begin(), marks.end(), 1));
    CHECK(f.patches.size() + 3 * split <= budget);
    if (split <= 5)
      for (size_t row = 0; row < marks.size(); ++row) CHECK(marks[row] <= near[row]);
    split_most = std::max(split_most, split);
  }
  CHECK(split_most > 5);
}
