#include "engine/light/direct.h"

#include "engine/light/lambert.h"
#include "engine/mesh/face_links.h"
#include "engine/transport/emission_by_rows.h"
#include "engine/transport/receivers.h"
#include "engine/transport/rows.h"
#include "engine/transport/sights.h"
#include "tests/scenes.h"

#include <doctest/doctest.h>

#include <bit>
#include <numeric>

using namespace patchlight;

namespace {

// One quad at y = 0 that looks up, in elements of one level, each its own patch and receiver, and whatever
// else is above it.
struct Stage {
  std::shared_ptr<const Surfaces> surfaces;
  Mesh mesh;
  ReceiverTable receivers;
  EmitterGroups groups;
  std::vector<float> emission_by_rows;
  HitTable hits;
  SightTable sights;
  std::vector<Rgb> irradiance;
  std::vector<float> error, noise;
  uint64_t ray_count = 0;  // of find_direct
};

FaceTable make_floor() {
  FaceTable faces;
  add_quad(faces, {0, 0, 0}, {0, 0, 1}, {1, 0, 1}, {1, 0, 0}, {});
  return faces;
}

Stage make_stage(FaceTable faces, uint32_t level, uint64_t seed) {
  Stage stage;
  stage.surfaces = make_surfaces(std::move(faces));
  Mesh& mesh = stage.mesh;
  mesh.patches = make_leaves(stage.surfaces->faces, stage.surfaces->frames,
                             [&](uint32_t face) { return face == 0 ? level : uint32_t{0}; });
  mesh.elements = mesh.patches;
  mesh.element_patch = all_rows(mesh.elements.size());
  mesh.patch_index = make_leaf_index(mesh.patches);
  stage.receivers = make_single_receivers(mesh.patches, *stage.surfaces);
  stage.groups = make_emitter_groups(stage.surfaces->faces, stage.surfaces->frames);
  stage.emission_by_rows =
      find_emission_by_rows(*stage.surfaces, stage.groups, mesh.patches, stage.receivers);
  const Casters by{*stage.surfaces, mesh.patches, mesh.patch_index, stage.receivers, make_ray_grid(64), seed};
  cast_rows(stage.hits, mesh.patches.exposed, all_rows(stage.receivers.size()), by, true);
  uint64_t looks = 0;
  stage.sights = find_sights({by, stage.hits}, stage.groups, stage.emission_by_rows, looks);
  return stage;
}

Stage light_stage(FaceTable faces, uint32_t level, DirectRays rays, uint64_t seed) {
  Stage stage = make_stage(std::move(faces), level, seed);
  stage.irradiance.resize(stage.mesh.elements.size());
  stage.error.resize(stage.mesh.elements.size());
  stage.noise.resize(stage.mesh.elements.size());
  stage.ray_count =
      find_direct({stage.irradiance, stage.error, stage.noise}, all_rows(stage.mesh.elements.size()),
                  {*stage.surfaces, stage.mesh, stage.receivers, stage.groups, stage.sights}, rays, seed);
  return stage;
}

// The groups that a receiver may see.
uint32_t count_sights(const Stage& stage, uint32_t receiver) {
  return stage.sights.first[receiver + 1] - stage.sights.first[receiver];
}

// The mean of the exact point factor over an element, by 16 x 16 midpoints.
double find_exact_mean(const Stage& stage, uint32_t row, std::span<const Vec3> lamp) {
  const CellFrame cell =
      make_cell_frame(false, stage.mesh.elements.cell[row], stage.mesh.elements.level[row]);
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
      // In clear sight: no rays.
      CHECK(stage.ray_count == 0);
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
      const float x = cell_centre(stage.surfaces->frames, 0, stage.mesh.elements.cell[row], 5).x;
      const double exact = find_exact_mean(stage, row, lamp);
      if (x < 0.38f) REQUIRE(stage.irradiance[row] == Rgb(0));
      if (x > 0.62f) inside += stage.irradiance[row].g, exact_inside += exact;
      // The two columns about x = 0.5 see a little less and a little more than half.
      if (std::abs(x - 0.5f) < 0.02f) half += stage.irradiance[row].g, exact_half += exact;
      // Receivers next to the penumbra look, too; those beyond know.
      if (x > 0.43f && x < 0.57f) CHECK(stage.error[row] > 0);
      if (x < 0.33f) CHECK(count_sights(stage, row) == 0);
      if (x > 0.67f) CHECK(stage.error[row] == 0);
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

TEST_CASE(
    "lamps that cannot reach an element are not in its sight: behind, below, or the element's own face") {
  FaceTable faces = make_floor();
  faces.emission[0] = Rgb(1);
  add_quad(faces, {0, -1, 0}, {1, -1, 0}, {1, -1, 1}, {0, -1, 1}, make_surface(1, 0));  // below, looks down
  add_quad(faces, {0, 1, 0}, {0, 1, 0.1f}, {0.1f, 1, 0.1f}, {0.1f, 1, 0},
           make_surface(1, 0));  // above, looks up
  const std::vector<Vec3> lamp = {{0.4f, 1, 0.4f}, {0.5f, 1, 0.4f}, {0.5f, 1, 0.5f}, {0.4f, 1, 0.5f}};
  add_polygon(faces, lamp, make_surface(1, 0));  // lights
  const Stage stage = light_stage(std::move(faces), 2, {16, 64}, 1);
  for (uint32_t row = 0; row < 16; ++row) {
    REQUIRE(count_sights(stage, row) > 0);
    // h^2 / 24 times the curvature at elements of a quarter under a lamp at height 1; its cells are far.
    CHECK(stage.irradiance[row].g == doctest::Approx(find_exact_mean(stage, row, lamp)).epsilon(0.01));
  }
}

TEST_CASE("hundreds of lamps are all looked at: none is left to chance") {
  FaceTable faces = make_floor();
  std::vector<std::vector<Vec3>> lamps;
  for (int k = 0; k < 400; ++k) {
    const float x = static_cast<float>(k % 20) / 20, z = static_cast<float>(k / 20) / 20;
    lamps.push_back({{x, 2, z}, {x + 0.01f, 2, z}, {x + 0.01f, 2, z + 0.01f}, {x, 2, z + 0.01f}});
    add_polygon(faces, lamps.back(), make_surface(1 + 100 * static_cast<float>(k % 3 == 0), 0));
  }
  const Stage stage = light_stage(std::move(faces), 2, {16, 64}, 1);
  for (uint32_t row = 0; row < 16; ++row) {
    double exact = 0;
    for (int k = 0; k < 400; ++k)
      exact += (k % 3 == 0 ? 101 : 1) * find_exact_mean(stage, row, lamps[static_cast<size_t>(k)]);
    CHECK(stage.irradiance[row].g == doctest::Approx(exact).epsilon(2e-3));
  }
  CHECK(stage.ray_count == 0);
}

TEST_CASE("groups hold every emitting face once, in pieces, at most 64 a group") {
  FaceTable faces = make_floor();
  for (int k = 0; k < 300; ++k) {
    const float x = static_cast<float>(k % 20) / 20, z = static_cast<float>(k / 20) / 20;
    add_quad(faces, {x, 2, z}, {x + 0.01f, 2, z}, {x + 0.01f, 2, z + 0.01f}, {x, 2, z + 0.01f},
             make_surface(1, 0));
  }
  add_quad(faces, {-3, 4, -3}, {4, 4, -3}, {4, 4, 4}, {-3, 4, 4}, make_surface(5, 0));  // a sky
  const FaceFrameTable frames = make_face_frames(faces);
  const EmitterGroups groups = make_emitter_groups(faces, frames);
  std::vector<double> area(faces.size(), 0);
  for (const Emitter& piece : groups.pieces) area[piece.face] += double{piece.area};
  CHECK(area[0] == 0);
  for (uint32_t face = 1; face < faces.size(); ++face)
    CHECK(area[face] == doctest::Approx(double{cell_area(frames, face, 0, 0)}).epsilon(1e-5));
  REQUIRE(groups.piece_first.back() == groups.pieces.size());
  for (size_t g = 0; g < groups.size(); ++g) {
    CHECK(groups.piece_count(g) >= 1);
    CHECK(groups.piece_count(g) <= kGroupPiecesMax);
    for (uint32_t k = groups.piece_first[g]; k < groups.piece_first[g + 1]; ++k) {
      CHECK((groups.beside[k] >> (k - groups.piece_first[g]) & 1) == 1);
      CHECK((groups.beside[k] & ~groups.all_pieces(g)) == 0);
    }
  }
}

TEST_CASE("a polygon whose sky is full of lamps leaves them all to its rows; one emitting wall is aimed at") {
  for (const bool all : {true, false}) {
    BoxSurfaces sides = make_box_surfaces(make_surface(all ? 1.0f : 0.0f, 0.5f));
    FaceTable faces;
    add_box_inward(faces, Vec3(0), Vec3(1), sides);
    if (!all) faces.emission[2] = Rgb(1);
    const Stage stage = make_stage(std::move(faces), 2, 1);
    for (const float by_rows : stage.emission_by_rows) CHECK(by_rows == (all ? luminance(Rgb(1)) : 0));
    CHECK((stage.sights.size() == 0) == all);
  }
}

TEST_CASE("what a row has met is in sight of its receiver, though it shows through a small hole only") {
  FaceTable faces = make_floor();
  // A wide panel above a ceiling with a hole of a fiftieth of its width.
  add_quad(faces, {-2, 2, -2}, {3, 2, -2}, {3, 2, 3}, {-2, 2, 3}, make_surface(1, 0));
  const auto add_ceiling = [&](float x0, float x1, float z0, float z1) {
    add_two_sided(faces, std::array{Vec3(x0, 1, z0), Vec3(x1, 1, z0), Vec3(x1, 1, z1), Vec3(x0, 1, z1)}, {},
                  {});
  };
  add_ceiling(-2, 0.45f, -2, 3), add_ceiling(0.55f, 3, -2, 3);
  add_ceiling(0.45f, 0.55f, -2, 0.45f), add_ceiling(0.45f, 0.55f, 0.55f, 3);
  const Stage stage = make_stage(std::move(faces), 4, 1);
  const SightTable& sights = stage.sights;
  uint32_t met = 0;
  for (uint32_t row = 0; row < 256; ++row)
    for (uint32_t k = 0; k < stage.hits.ray_count; ++k) {
      const uint32_t patch = stage.hits.patch[row * stage.hits.ray_count + k];
      if (patch >= kHitBuried || stage.mesh.patches.face[patch] != 1) continue;
      ++met;
      const uint32_t piece = find_piece(stage.groups, 1, stage.hits.cell[row * stage.hits.ray_count + k]);
      REQUIRE(piece != kNone);
      const uint32_t group = stage.groups.group_of[piece];
      uint64_t seen = 0;
      for (uint32_t entry = sights.first[row]; entry < sights.first[row + 1]; ++entry)
        if (sights.group[entry] == group) seen = sights.pieces[entry];
      CHECK((seen >> (piece - stage.groups.piece_first[group]) & 1) == 1);
    }
  CHECK(met > 0);
}

TEST_CASE(
    "a receiver that sees all of a group asks no more; one that sees nothing of it knows no such group") {
  FaceTable faces = make_floor();
  add_quad(faces, {0.4f, 1, 0.4f}, {0.6f, 1, 0.4f}, {0.6f, 1, 0.6f}, {0.4f, 1, 0.6f}, make_surface(1, 0));
  add_two_sided(
      faces, std::array{Vec3(0, 0.3f, 0), Vec3(0.3f, 0.3f, 0), Vec3(0.3f, 0.3f, 0.3f), Vec3(0, 0.3f, 0.3f)},
      {}, {});
  const Stage stage = light_stage(std::move(faces), 5, {16, 64}, 1);
  uint32_t clear = 0, none = 0;
  for (uint32_t row = 0; row < 1024; ++row) {
    const uint32_t first = stage.sights.first[row], count = count_sights(stage, row);
    const bool is_clear = count > 0 && std::all_of(stage.sights.clear.begin() + first,
                                                   stage.sights.clear.begin() + first + count,
                                                   [](uint8_t c) { return c == 1; });
    const PatchTable& elements = stage.mesh.elements;
    const Vec3 centre = cell_centre(stage.surfaces->frames, 0, elements.cell[row], elements.level[row]);
    if (is_clear) {
      ++clear;
      CHECK(stage.error[row] == 0);
    }
    // The screen's umbra on the floor ends before x = z = 0.3 - 0.3 * (0.4 - 0.3) / 0.7 = 0.257.
    if (count == 0) {
      ++none;
      CHECK(stage.irradiance[row] == Rgb(0));
      CHECK(std::max(centre.x, centre.z) < 0.257f);
    }
  }
  CHECK(clear > 700);
  CHECK(none > 0);
  CHECK(clear + none < 1024);
}

TEST_CASE("a small far lamp, a large one, one of the sun's size: Lambert's formula over twelve decades") {
  for (const double distance : {1.0, 25.0, 1e3, 1e5, 1e7, 1e9}) {
    CAPTURE(distance);
    FaceTable faces = make_floor();
    const auto far = static_cast<float>(distance), half = static_cast<float>(distance * 0.00465);
    const std::vector<Vec3> lamp = {
        {-half, far, -half}, {half, far, -half}, {half, far, half}, {-half, far, half}};
    add_polygon(faces, lamp, make_surface(1, 0));
    const Stage stage = light_stage(std::move(faces), 2, {16, 64}, 1);
    for (uint32_t row = 0; row < 16; ++row)
      CHECK(stage.irradiance[row].g == doctest::Approx(find_exact_mean(stage, row, lamp)).epsilon(1e-3));
  }
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
  std::vector<float> error(rows.size()), noise(rows.size());
  find_direct({irradiance, error, noise}, rows,
              {*s.surfaces, s.mesh, s.transport.receivers, s.transport.groups, s.transport.sights},
              {16, settings.rays * 4 / 9}, settings.seed);
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
