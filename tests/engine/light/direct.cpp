#include "engine/light/direct.h"

#include "engine/light/lambert.h"
#include "engine/light/light_lists.h"
#include "engine/mesh/face_links.h"
#include "engine/transport/receivers.h"
#include "engine/transport/rows.h"
#include "tests/scenes.h"

#include <doctest/doctest.h>

#include <bit>
#include <numeric>

using namespace patchlight;

namespace {

// One quad at y = 0 that looks up, in elements of one level, each its own patch, and whatever else is above
// it.
struct Stage {
  std::shared_ptr<const Surfaces> surfaces;
  PatchTable elements;
  LightListTable lists;
  std::vector<Rgb> irradiance;
  std::vector<float> error;
  LampViewTable views;
  uint64_t ray_count = 0;
};

FaceTable make_floor() {
  FaceTable faces;
  add_quad(faces, {0, 0, 0}, {0, 0, 1}, {1, 0, 1}, {1, 0, 0}, {});
  return faces;
}

// With a receiver, and so a list of lamps, for each of them.
LightListTable list_all(const Surfaces& surfaces, const PatchTable& patches) {
  return make_light_lists(surfaces, patches, make_single_receivers(patches, surfaces));
}

Stage light_stage(FaceTable faces, uint32_t level, DirectRays rays, uint64_t seed) {
  Stage stage;
  stage.surfaces = make_surfaces(std::move(faces));
  stage.elements = make_leaves(stage.surfaces->faces, stage.surfaces->frames,
                               [&](uint32_t face) { return face == 0 ? level : uint32_t{0}; });
  stage.lists = list_all(*stage.surfaces, stage.elements);
  stage.irradiance.resize(stage.elements.size());
  stage.error.resize(stage.elements.size());
  stage.views.seen.assign(stage.elements.size(), 0);
  stage.views.hidden.assign(stage.elements.size(), 0);
  stage.views.settled.assign(stage.elements.size(), 0);
  stage.ray_count = find_direct({stage.irradiance, stage.error, stage.views}, all_rows(stage.elements.size()),
                                {*stage.surfaces, stage.elements, stage.lists}, rays, seed);
  return stage;
}

// The mean of the exact point factor over an element, by 16 x 16 midpoints.
double find_exact_mean(const Stage& stage, uint32_t row, std::span<const Vec3> lamp) {
  const CellFrame cell = make_cell_frame(false, stage.elements.cell[row], stage.elements.level[row]);
  double sum = 0;
  for (int k = 0; k < 256; ++k) {
    const Vec2 p((static_cast<float>(k % 16) + 0.5f) / 16, (static_cast<float>(k / 16) + 0.5f) / 16);
    const Vec3 point = face_point(stage.surfaces->frames, 0, cell_sample(false, cell, p));
    sum += find_point_form_factor(DVec3(point), {0, 1, 0}, lamp);
  }
  return sum / 256;
}

}  // namespace

TEST_CASE(
    "direct light without blockers is Lambert's formula, for a lamp near and far, quads and triangles") {
  for (const float height : {0.15f, 0.5f, 2.0f, 30.0f})
    for (const bool triangle : {false, true}) {
      CAPTURE(height);
      FaceTable faces = make_floor();
      const std::vector<Vec3> lamp =
          triangle
              ? std::vector<Vec3>{{0.2f, height, 0.3f}, {0.8f, height, 0.2f}, {0.4f, height, 0.9f}}
              : std::vector<Vec3>{
                    {0.3f, height, 0.3f}, {0.7f, height, 0.2f}, {0.8f, height, 0.9f}, {0.2f, height, 0.8f}};
      add_polygon(faces, lamp, {Rgb(2, 1, 0.5f), Rgb(0)});
      const Stage stage = light_stage(std::move(faces), 4, {16, 64}, 1);
      double found = 0, expected = 0, largest_factor = 0, worst = 0;
      for (uint32_t row = 0; row < 256; ++row) {
        const double exact = find_exact_mean(stage, row, lamp);
        found += stage.irradiance[row].g, expected += exact;
        largest_factor = std::max(largest_factor, exact);
        worst = std::max(worst, std::abs(stage.irradiance[row].g - exact));
        CHECK(stage.irradiance[row].r == doctest::Approx(2 * stage.irradiance[row].g).epsilon(1e-5));
        CHECK(stage.error[row] == 0);
      }
      // A far lamp may be taken for a point (1e-3 of it); otherwise the midpoint rule on elements of 1/16,
      // under a lamp 0.15 or more above: h^2 / 24 times a curvature of at most 4 / height^2 of the peak at
      // one point, and a quarter of that where four points are taken, as they must be this near.
      const double bound = 1e-3 + std::min(1.0, 1.0 / 256 / 24 * 4 / (height * height) / 2);
      CHECK(worst <= bound * largest_factor);
      CHECK(std::abs(found / expected - 1) <= bound);
      // All settled at sight: one packet an element, whose rays all arrive.
      CHECK(stage.ray_count <= 256 * 16);
      for (uint32_t row = 0; row < 256; ++row) CHECK(stage.views.hidden[row] == 0);
    }
}

TEST_CASE("direct light behind a half screen is half of the closed form in the middle, none in the umbra") {
  FaceTable faces = make_floor();
  const std::vector<Vec3> lamp = {{0.4f, 1, 0.4f}, {0.6f, 1, 0.4f}, {0.6f, 1, 0.6f}, {0.4f, 1, 0.6f}};
  add_polygon(faces, lamp, make_surface(1, 0));
  // Half way up, over x < 0.5: the shadow's edge on the floor is a penumbra from x = 0.4 to x = 0.6.
  add_two_sided(faces,
                std::array{Vec3(-2, 0.5f, -2), Vec3(0.5f, 0.5f, -2), Vec3(0.5f, 0.5f, 3), Vec3(-2, 0.5f, 3)},
                {}, {});
  const uint32_t seeds = 8;
  double inside = 0, exact_inside = 0, half = 0, exact_half = 0;
  for (uint64_t seed = 1; seed <= seeds; ++seed) {
    const Stage stage = light_stage(faces, 5, {64, 256}, seed);
    for (uint32_t row = 0; row < 1024; ++row) {
      const float x = cell_centre(stage.surfaces->frames, 0, stage.elements.cell[row], 5).x;
      const double exact = find_exact_mean(stage, row, lamp);
      if (x < 0.38f) REQUIRE(stage.irradiance[row] == Rgb(0));
      if (x > 0.62f) inside += stage.irradiance[row].g, exact_inside += exact;
      // The two columns about x = 0.5 see a little less and a little more than half.
      if (std::abs(x - 0.5f) < 0.02f) half += stage.irradiance[row].g, exact_half += exact;
      CHECK((stage.error[row] > 0) == (stage.views.seen[row] == 0 && stage.views.hidden[row] == 0));
      if (x < 0.38f) CHECK(stage.views.hidden[row] == 1);
      if (x > 0.62f) CHECK(stage.views.seen[row] == 1);
    }
  }
  CHECK(inside == doctest::Approx(exact_inside).epsilon(1e-3));
  // 64 elements and 8 seeds of 256 pairs each, worth at least as many random ones: four standard errors of a
  // half.
  const double error = 4 * 0.5 / std::sqrt(64.0 * seeds * 256);
  CHECK(std::abs(half / exact_half - 0.5) <= error);
}

TEST_CASE("the stated error of direct light covers what other seeds find") {
  FaceTable faces = make_floor();
  add_quad(faces, {0.4f, 1, 0.4f}, {0.6f, 1, 0.4f}, {0.6f, 1, 0.6f}, {0.4f, 1, 0.6f}, make_surface(1, 0));
  add_two_sided(faces,
                std::array{Vec3(-2, 0.5f, -2), Vec3(0.5f, 0.5f, -2), Vec3(0.5f, 0.5f, 3), Vec3(-2, 0.5f, 3)},
                {}, {});
  const Stage a = light_stage(faces, 4, {16, 64}, 1), b = light_stage(faces, 4, {16, 64}, 2);
  double squares = 0, stated = 0;
  for (uint32_t row = 0; row < 256; ++row) {
    squares += std::pow(a.irradiance[row].g - b.irradiance[row].g, 2);
    stated += std::pow(a.error[row], 2) + std::pow(b.error[row], 2);
  }
  CHECK(stated > 0);
  // About 64 independent differences: their mean square within a factor of four of the stated one, either
  // way.
  CHECK(squares <= 4 * stated);
  CHECK(squares >= stated / 16);
}

TEST_CASE("lamps that cannot reach an element are not aimed at: behind, below, or the element's own face") {
  FaceTable faces = make_floor();
  faces.emission[0] = Rgb(1);
  add_quad(faces, {0, -1, 0}, {1, -1, 0}, {1, -1, 1}, {0, -1, 1}, make_surface(1, 0));  // below, looks down
  add_quad(faces, {0, 1, 0}, {0, 1, 0.1f}, {0.1f, 1, 0.1f}, {0.1f, 1, 0},
           make_surface(1, 0));  // above, looks up
  add_quad(faces, {0.4f, 1, 0.4f}, {0.5f, 1, 0.4f}, {0.5f, 1, 0.5f}, {0.4f, 1, 0.5f},
           make_surface(1, 0));  // lights
  const auto surfaces = make_surfaces(faces);
  const PatchTable patches = make_leaves(faces, surfaces->frames, [](uint32_t) { return 2u; });
  const LightListTable lists = list_all(*surfaces, patches);
  REQUIRE(lists.list_first.size() == faces.size() + 1);
  CHECK(lists.list_first[1] - lists.list_first[0] == 1);
  CHECK(is_aimed(lists, 0, 3));
  CHECK(!is_aimed(lists, 0, 0));
  CHECK(!is_aimed(lists, 0, 2));
}

TEST_CASE("a polygon lists at the strongest 64 of many lamps, in order") {
  FaceTable faces = make_floor();
  for (int k = 0; k < 100; ++k) {
    const float x = static_cast<float>(k % 10) / 10, z = static_cast<float>(k / 10) / 10;
    add_quad(faces, {x, 2, z}, {x + 0.01f, 2, z}, {x + 0.01f, 2, z + 0.01f}, {x, 2, z + 0.01f},
             make_surface(1 + 100 * static_cast<float>(k % 3 == 0), 0));
  }
  const auto surfaces = make_surfaces(faces);
  const PatchTable patches = make_leaves(faces, surfaces->frames, [](uint32_t) { return 0u; });
  const LightListTable lists = list_all(*surfaces, patches);
  REQUIRE(lists.list_first[1] == kAimedLampsMax);
  CHECK(std::is_sorted(lists.lamp.begin(), lists.lamp.begin() + kAimedLampsMax));
  for (uint32_t lamp = 1; lamp <= 100; ++lamp)
    if ((lamp - 1) % 3 == 0) CHECK(is_aimed(lists, 0, lamp));
}

TEST_CASE("a polygon whose sky is full of lamps leaves them all to its rows") {
  FaceTable faces;
  add_box_inward(faces, Vec3(0), Vec3(1), make_box_surfaces(make_surface(1, 0.5f)));
  const auto surfaces = make_surfaces(faces);
  const PatchTable patches = make_leaves(faces, surfaces->frames, [](uint32_t) { return 2u; });
  CHECK(list_all(*surfaces, patches).lamp.empty());
}

TEST_CASE("settled lamps cast no rays and change nothing") {
  FaceTable faces = make_floor();
  add_quad(faces, {0.4f, 1, 0.4f}, {0.6f, 1, 0.4f}, {0.6f, 1, 0.6f}, {0.4f, 1, 0.6f}, make_surface(1, 0));
  add_two_sided(
      faces, std::array{Vec3(0, 0.3f, 0), Vec3(0.3f, 0.3f, 0), Vec3(0.3f, 0.3f, 0.3f), Vec3(0, 0.3f, 0.3f)},
      {}, {});
  Stage stage = light_stage(faces, 5, {16, 64}, 1);
  for (uint32_t row = 0; row < 1024; ++row)
    stage.views.settled[row] =
        find_settled(stage.views, stage.elements, stage.surfaces->frames, stage.surfaces->links, row);
  const auto settled_count = std::count(stage.views.settled.begin(), stage.views.settled.begin() + 1024, 1);
  CHECK(settled_count > 700);
  CHECK(settled_count < 1024);
  std::vector<Rgb> irradiance(stage.elements.size());
  std::vector<float> error(stage.elements.size());
  const uint64_t rays = find_direct({irradiance, error, stage.views}, all_rows(stage.elements.size()),
                                    {*stage.surfaces, stage.elements, stage.lists}, {16, 64}, 1);
  CHECK(irradiance == stage.irradiance);
  CHECK(error == stage.error);
  CHECK(rays == stage.ray_count - 16 * static_cast<uint64_t>(settled_count));
}

TEST_CASE("a lamp is settled only where all neighbours agree") {
  FaceTable faces = make_floor();
  const FaceFrameTable frames = make_face_frames(faces);
  const FaceLinkTable links = make_face_links(faces);
  const PatchTable elements = make_leaves(faces, frames, [](uint32_t) { return 1u; });
  // Element 0 lies beside 1 and 2; 3 is across the corner and has no say.
  LampViewTable views{{0b11, 0b11, 0b11, 0}, {0, 0, 0, 0b11}, {0, 0, 0, 0}};
  CHECK(find_settled(views, elements, frames, links, 0) == 0b11);
  views.seen[1] = 0b01;  // does not see the second lamp whole
  CHECK(find_settled(views, elements, frames, links, 0) == 0b01);
  views.seen[0] = 0b10, views.hidden[0] = 0b01;  // the first lamp: hidden here, seen there
  CHECK(find_settled(views, elements, frames, links, 0) == 0);
}

TEST_CASE("the inherited state of a refined scene is what a full computation of its elements gives") {
  FaceTable faces;
  add_box_inward(faces, Vec3(0), Vec3(1), make_box_surfaces(make_surface(0, 0.6f)));
  add_quad(faces, {0.3f, 0.99f, 0.4f}, {0.5f, 0.99f, 0.4f}, {0.5f, 0.99f, 0.6f}, {0.3f, 0.99f, 0.6f},
           make_surface(20, 0));
  add_box_outward(faces, {0.55f, -0.01f, 0.3f}, {0.8f, 0.5f, 0.6f}, make_surface(0, 0.4f));
  fit_scene(faces);
  const SolverSettings settings;
  const Solution s = solve_scene(faces, settings, 0);
  CHECK(s.log.rounds.size() > 2);
  std::vector<uint32_t> rows(s.mesh.elements.size());
  std::iota(rows.begin(), rows.end(), 0u);
  std::vector<Rgb> irradiance(rows.size());
  std::vector<float> error(rows.size());
  LampViewTable views;
  views.seen.assign(rows.size(), 0), views.hidden.assign(rows.size(), 0),
      views.settled.assign(rows.size(), 0);
  find_direct({irradiance, error, views}, rows, {*s.surfaces, s.mesh.elements, s.transport.light_lists},
              {16, settings.rays / 4}, settings.seed);
  size_t different = 0;
  double power = 0, difference = 0;
  for (uint32_t row = 0; row < rows.size(); ++row) {
    different += irradiance[row] != s.light.direct[row];
    power += double{s.mesh.elements.area[row]} * irradiance[row].g;
    difference += double{s.mesh.elements.area[row]} * std::abs(irradiance[row].g - s.light.direct[row].g);
  }
  // Sixteen rays and four neighbours' sixteen may agree and miss a shadow's very edge, in few places of
  // little area.
  CHECK(static_cast<double>(different) <= 0.01 * static_cast<double>(rows.size()));
  CHECK(difference <= 1e-3 * power);
}

TEST_CASE("the exposed share of elements: all, none, or as many of sixteen points as lie free") {
  FaceTable faces;
  add_box_inward(faces, Vec3(0), Vec3(1), make_box_surfaces({}));
  add_box_outward(faces, {0.3f, -0.1f, 0.3f}, {0.7f, 0.5f, 0.7f}, {});
  const auto surfaces = make_surfaces(faces);
  const FaceFrameTable& frames = surfaces->frames;
  Mesh mesh;
  mesh.patches = make_leaves(faces, frames, [](uint32_t face) { return face == 0 ? 2u : 0u; });
  mesh.patch_index = make_leaf_index(mesh.patches);
  const ReceiverTable receivers = make_single_receivers(mesh.patches, *surfaces);
  HitTable hits;
  cast_rows(hits, mesh.patches.exposed, all_rows(mesh.patches.size()),
            {*surfaces, mesh.patches, mesh.patch_index, receivers, make_ray_grid(256)}, true);
  mesh.elements = make_leaves(faces, frames, [](uint32_t face) { return face == 0 ? 4u : 0u; });
  const auto first = find_union_ranges(mesh.patches, mesh.elements);
  mesh.element_patch.resize(mesh.elements.size());
  for (uint32_t p = 0; p < mesh.patches.size(); ++p)
    for (uint32_t row = first[p]; row < first[p + 1]; ++row) mesh.element_patch[row] = p;
  find_exposed(mesh, all_rows(mesh.elements.size()), *surfaces, 1);
  const PatchTable& elements = mesh.elements;
  double exposed = 0;
  for (uint32_t row = 0; row < 256; ++row) {
    const Vec3 c = cell_centre(frames, 0, elements.cell[row], 4);
    const float h = 0.5f / 16;
    const auto share = [&](float x) {
      return (std::clamp(x + h, 0.3f, 0.7f) - std::clamp(x - h, 0.3f, 0.7f)) / (2 * h);
    };
    const float buried = share(c.x) * share(c.z);
    // Of 4 x 4 strata, those that an edge crosses may go either way: 4, or 7 at a corner.
    CHECK(std::abs(1 - elements.exposed[row] - buried) <= (buried == 0 || buried == 1 ? 0 : 7 / 16.0f));
    exposed += elements.exposed[row] / 256;
  }
  // The buried area is 0.16: about 26 elements are crossed by its edge, each uncertain by an eighth.
  CHECK(std::abs(1 - exposed - 0.16) <= 4 * std::sqrt(26.0) / 8 / 256);
}
