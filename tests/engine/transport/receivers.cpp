#include "engine/transport/receivers.h"

#include "engine/base/parallel.h"
#include "engine/mesh/patches.h"
#include "engine/solve/solve.h"
#include "engine/transport/rows.h"
#include "tests/scenes.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

using namespace patchlight;

namespace {

// A sheet of n x n pairs of two-sided triangles over the square from `corner` along u and v, each a polygon
// of its own, as models have them.
void add_sheet(FaceTable& faces, Vec3 corner, Vec3 u, Vec3 v, uint32_t n, const Surface& surface) {
  const auto at = [&](uint32_t i, uint32_t j) {
    return corner + static_cast<float>(i) / static_cast<float>(n) * u +
           static_cast<float>(j) / static_cast<float>(n) * v;
  };
  for (uint32_t i = 0; i < n; ++i)
    for (uint32_t j = 0; j < n; ++j) {
      add_two_sided(faces, std::array{at(i, j), at(i + 1, j), at(i + 1, j + 1)}, surface, surface);
      add_two_sided(faces, std::array{at(i, j), at(i + 1, j + 1), at(i, j + 1)}, surface, surface);
    }
}

// A room of unit edges with a lamp in its ceiling and a thin closed box of sheets in its middle: each of the
// box's sides is seen from both sides, the inner ones face dark air.
struct Furnished {
  FaceTable faces;
  uint32_t box_first;  // face
};
Furnished make_furnished(bool small_triangles) {
  Furnished f;
  add_box_inward(f.faces, Vec3(0), Vec3(1), make_box_surfaces(make_surface(0, 0.6f)));
  add_quad(f.faces, {0.4f, 0.99f, 0.4f}, {0.6f, 0.99f, 0.4f}, {0.6f, 0.99f, 0.6f}, {0.4f, 0.99f, 0.6f},
           make_surface(10, 0));
  f.box_first = static_cast<uint32_t>(f.faces.size());
  const Vec3 low(0.3f, 0.4f, 0.3f), size(0.4f, 0.02f, 0.4f);
  const Vec3 x(size.x, 0, 0), y(0, size.y, 0), z(0, 0, size.z), high = low + size;
  const uint32_t n = small_triangles ? 40 : 1;
  const auto add = [&](Vec3 corner, Vec3 u, Vec3 v) {
    add_sheet(f.faces, corner, u, v, n, make_surface(0, 0.6f));
  };
  add(low, x, z), add(low + y, x, z);
  add(low, x, y), add(low, z, y), add(high, -x, -y), add(high, -z, -y);
  fit_scene(f.faces);
  return f;
}

struct Shared {
  std::shared_ptr<const Surfaces> surfaces;
  PatchTable patches;
  ReceiverTable receivers;
};
Shared share(const FaceTable& faces, uint64_t seed = 1) {
  uint64_t rays = 0;
  Shared s{make_surfaces(faces), {}, {}};
  s.patches = make_patches(*s.surfaces, {1u << 20, 1, seed}, rays);
  s.receivers = make_receivers(s.patches, *s.surfaces, seed, rays);
  return s;
}

}  // namespace

TEST_CASE("receivers: every patch has one, and shares add up") {
  const Furnished scene = make_furnished(true);
  const Shared s = share(scene.faces);
  const ReceiverTable& r = s.receivers;
  REQUIRE(r.first.size() == r.size() + 1);
  REQUIRE(r.first.back() == s.patches.size());
  std::vector<uint32_t> times(s.patches.size(), 0);
  for (uint32_t row = 0; row < r.size(); ++row) {
    REQUIRE(r.first[row] < r.first[row + 1]);
    double area = 0, until = 0;
    for (uint32_t k = r.first[row]; k < r.first[row + 1]; ++k) area += s.patches.area[r.patch[k]];
    for (uint32_t k = r.first[row]; k < r.first[row + 1]; ++k) {
      ++times[r.patch[k]];
      CHECK(r.receiver_of[r.patch[k]] == row);
      until += s.patches.area[r.patch[k]] / area;
      CHECK(std::abs(r.area_until[k] - until) <= 1e-5);
    }
    CHECK(r.area_until[r.first[row + 1] - 1] == 1);
    CHECK(std::abs(length(r.normal[row]) - 1) <= 1e-5f);
  }
  CHECK(std::all_of(times.begin(), times.end(), [](uint32_t count) { return count == 1; }));
}

TEST_CASE("receivers: small triangles share rows, faces of a room keep their own") {
  const Furnished scene = make_furnished(true);
  const Shared s = share(scene.faces);
  size_t box_rows = 0, triangles = scene.faces.size() - scene.box_first;
  CHECK(triangles == 38400);
  for (uint32_t row = 0; row < s.receivers.size(); ++row) {
    const uint32_t first = s.receivers.first[row], count = s.receivers.first[row + 1] - first;
    if (s.patches.face[s.receivers.patch[first]] < scene.box_first)
      CHECK(count == 1);
    else
      ++box_rows;
  }
  // Where the gap's height asks for the finest, a receiver spans 0.01 of the square root of the area: 0.03 of
  // an edge here, or about 170 a sheet and side, twice as many where sixteen rays take the gap for deeper or
  // flatter than it is.
  CHECK(box_rows < triangles / 8);
}

TEST_CASE("receivers: what faces a dark gap never shares with what faces the room") {
  const Furnished scene = make_furnished(true);
  const Shared s = share(scene.faces);
  // A normal that points away from the box's middle looks into the room.
  Vec3 middle(0);
  for (uint32_t f = scene.box_first; f < scene.faces.size(); ++f)
    middle +=
        cell_centre(s.surfaces->frames, f, 0, 0) / static_cast<float>(scene.faces.size() - scene.box_first);
  const auto looks_out = [&](uint32_t patch) {
    const uint32_t face = s.patches.face[patch];
    return dot(scene.faces.normal[face], cell_centre(s.surfaces->frames, face, 0, 0) - middle) > 0;
  };
  size_t mixed = 0;
  for (uint32_t row = 0; row < s.receivers.size(); ++row)
    for (uint32_t k = s.receivers.first[row]; k < s.receivers.first[row + 1]; ++k) {
      const uint32_t patch = s.receivers.patch[k], first = s.receivers.patch[s.receivers.first[row]];
      if (s.patches.face[patch] < scene.box_first || s.patches.face[first] < scene.box_first) continue;
      mixed += looks_out(patch) != looks_out(first);
    }
  // The gap is 50 times lower than the room. Near the narrow sides' ends sixteen rays may mistake one for the
  // other.
  CHECK(mixed <= s.patches.size() / 500);
}

TEST_CASE("receivers: rays start evenly over the area, by the normal of the patch that they leave") {
  FaceTable faces;
  add_box_inward(faces, Vec3(0), Vec3(1), make_box_surfaces(make_surface(1, 0.5f)));
  fit_scene(faces);
  const auto surfaces = make_surfaces(faces);
  const PatchTable patches =
      make_leaves(faces, surfaces->frames, [](uint32_t face) { return face == 0 ? 1u : 0u; });
  // One receiver of all nine leaves: four quarters of a side and five whole sides.
  ReceiverTable one;
  one.first = {0, static_cast<uint32_t>(patches.size())};
  float until = 0;
  for (uint32_t patch = 0; patch < patches.size(); ++patch) {
    one.patch.push_back(patch);
    one.area_until.push_back(until += patch < 4 ? 1 / 24.0f : 1 / 6.0f);
  }
  one.area_until.back() = 1;
  one.centre.assign(1, Vec3(0)), one.normal.assign(1, Vec3(1, 0, 0));
  const LeafIndex index;
  const Casters casters{*surfaces, patches, index, one, {}};
  constexpr uint32_t kSide = 240;
  std::vector<uint32_t> count(6, 0);
  for (uint32_t i = 0; i < kSide; ++i)
    for (uint32_t j = 0; j < 4; ++j) {
      const Origin origin = find_origin(
          casters, 0, {(static_cast<float>(i) + 0.5f) / kSide, (static_cast<float>(j) + 0.5f) / 4});
      for (uint32_t f = 0; f < 6; ++f)
        if (origin.normal == faces.normal[f]) {
          ++count[f];
          CHECK(std::abs(dot(origin.point - surfaces->frames.origin[f], faces.normal[f])) <= 1e-5f);
        }
    }
  for (uint32_t f = 0; f < 6; ++f)
    CHECK(std::abs(static_cast<int>(count[f]) - static_cast<int>(kSide * 4 / 6)) <= 4);
}

TEST_CASE("receivers: the light on a box of small triangles is that on a box of large ones") {
  // The means over the box's outer top and the room's floor, after all passes: rows are noisy, so that the
  // two agree within the noise of some 600 rows of 256 rays on the top (about 0.5 %), three times.
  double top[2], floor[2];
  for (const bool small : {false, true}) {
    const Furnished scene = make_furnished(small);
    const Solution run = solve_scene(scene.faces, {}, 20);
    const auto irradiance = element_irradiance(run);
    double power = 0, area = 0;
    const uint32_t sheet = small ? 6400 : 4;  // faces; the second sheet is the upper side
    for (uint32_t f = scene.box_first + sheet; f < scene.box_first + 2 * sheet; ++f) {
      if (scene.faces.normal[f].y <= 0) continue;
      const uint32_t polygon = scene.faces.polygon[f];
      power += polygon_power(run, scene.faces, polygon, polygon + 1, irradiance).g;
      area += face_area(scene.faces, f);
    }
    top[small] = power / area;
    floor[small] =
        polygon_power(run, scene.faces, kFloor, kFloor + 1, irradiance).g / face_area(scene.faces, kFloor);
  }
  CHECK(std::abs(top[1] / top[0] - 1) <= 0.015);
  CHECK(std::abs(floor[1] / floor[0] - 1) <= 0.015);
}

TEST_CASE("receivers: the same at every number of threads") {
  const Furnished scene = make_furnished(true);
  std::set<uint64_t> hashes;
  for (const size_t threads : {1u, 2u, 3u}) {
    const WorkersScope scope(std::make_shared<Workers>(threads));
    hashes.insert(find_solution_hash(solve_scene(scene.faces, {}, 3)));
  }
  CHECK(hashes.size() == 1);
}
