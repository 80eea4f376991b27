#include "engine/transport/rows.h"

#include "engine/mesh/buried.h"
#include "engine/mesh/quadtree.h"
#include "engine/transport/receivers.h"
#include "tests/scenes.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <bit>
#include <numeric>

using namespace patchlight;

namespace {

FaceTable make_unit_room() {
  FaceTable faces;
  add_box_inward(faces, Vec3(0), Vec3(1), make_box_surfaces(make_surface(0, 0.5f)));
  return faces;
}

Vec3 get_origin(const RayPacket& r, uint32_t k) { return {r.origin_x[k], r.origin_y[k], r.origin_z[k]}; }
Vec3 get_direction(const RayPacket& r, uint32_t k) {
  return {r.direction_x[k], r.direction_y[k], r.direction_z[k]};
}

// The point of the unit square that Shirley and Chiu's map takes to a point of the disk.
DVec2 disk_to_square(DVec2 p) {
  const double radius = length(p), scale = 4 / std::numbers::pi;
  if (std::abs(p.x) > std::abs(p.y)) {
    const double a = std::copysign(radius, p.x);
    return (DVec2(a, a * scale * std::atan(p.y / p.x)) + 1.0) / 2.0;
  }
  const double b = std::copysign(radius, p.y);
  return (DVec2(b * scale * std::atan(p.x / p.y), b) + 1.0) / 2.0;
}

struct Cast {
  std::shared_ptr<const Surfaces> surfaces;
  PatchTable patches;
  HitTable hits;
};

Cast cast_all(const FaceTable& faces, uint32_t level, uint32_t rays, uint64_t seed) {
  Cast rows{make_surfaces(faces), {}, {}};
  rows.patches = make_leaves(faces, rows.surfaces->frames, [&](uint32_t) { return level; });
  const LeafIndex index = make_leaf_index(rows.patches);
  const ReceiverTable receivers = make_single_receivers(rows.patches, *rows.surfaces);
  const uint64_t count =
      cast_rows(rows.hits, rows.patches.exposed, all_rows(rows.patches.size()),
                {*rows.surfaces, rows.patches, index, receivers, make_ray_grid(rays), seed}, true);
  CHECK(count == uint64_t{rows.hits.ray_count} * rows.patches.size());
  return rows;
}

}  // namespace

TEST_CASE("row grids are whole packets, near the number of rays asked for") {
  for (uint32_t rays = 1; rays <= 5000; ++rays) {
    const RayGrid grid = make_ray_grid(rays);
    REQUIRE(grid.columns % 4 == 0);
    REQUIRE(grid.rows % 4 == 0);
    REQUIRE(grid.packet_count() * kPacketSize == grid.ray_count());
    // Rounded by half a packet's side in each direction at most.
    if (rays >= 16) REQUIRE(grid.ray_count() <= 1.5 * rays);
    if (rays >= 16) REQUIRE(grid.ray_count() >= rays / 1.5);
  }
  CHECK(make_ray_grid(256).ray_count() == 256);
  CHECK(make_ray_grid(0).ray_count() == 16);
}

TEST_CASE("rows: every stratum of the patch and every stratum of the directions is used once") {
  FaceTable faces;
  add_quad(faces, {0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {});
  const FaceFrameTable frames = make_face_frames(faces);
  const Frame frame = make_frame(faces.normal[0]);
  for (const uint32_t rays : {16u, 96u, 256u, 400u, 1000u})
    for (const uint64_t key : {1ull, 0x123456789abcdefull, ~0ull}) {
      const RayGrid grid = make_ray_grid(rays);
      std::vector<uint32_t> origin_count(grid.ray_count(), 0), direction_count(grid.ray_count(), 0);
      HitPacket packet;
      for (uint32_t tile = 0; tile < grid.packet_count(); ++tile) {
        make_ray_packet(packet, {{0}, frame, key, grid}, frames, tile);
        for (uint32_t k = 0; k < kPacketSize; ++k) {
          const Vec3 origin = get_origin(packet.ray, k), direction = get_direction(packet.ray, k);
          REQUIRE(origin.z > 0);
          REQUIRE(origin.z < 1e-5f);
          // Unit length by a polynomial sine, good to 4e-7.
          REQUIRE(std::abs(length(direction) - 1) <= 2e-6f);
          ++origin_count[static_cast<uint32_t>(origin.x * static_cast<float>(grid.rows)) * grid.columns +
                         static_cast<uint32_t>(origin.y * static_cast<float>(grid.columns))];
          const DVec2 p = disk_to_square({dot(direction, frame.tangent), dot(direction, frame.bitangent)});
          // The grid's index, rounded to the nearest cell centre's where the map back is a hair off.
          const auto column = static_cast<uint32_t>(std::clamp(p.x, 0.0, 0.999999) * grid.columns);
          const auto row = static_cast<uint32_t>(std::clamp(p.y, 0.0, 0.999999) * grid.rows);
          ++direction_count[row * grid.columns + column];
        }
      }
      CHECK(*std::max_element(origin_count.begin(), origin_count.end()) == 1);
      CHECK(*std::max_element(direction_count.begin(), direction_count.end()) == 1);
    }
}

TEST_CASE("rows: directions have cosine density") {
  FaceTable faces;
  add_quad(faces, {0, 0, 0}, {0.3f, 0.1f, 0.2f}, {0.2f, 0.5f, 0.7f}, {-0.1f, 0.4f, 0.5f}, {});
  const FaceFrameTable frames = make_face_frames(faces);
  const Frame frame = make_frame(faces.normal[0]);
  const RayGrid grid = make_ray_grid(4096);
  HitPacket packet;
  double height = 0, height_squared = 0;
  DVec2 across(0);
  uint32_t below_half = 0;
  for (uint32_t tile = 0; tile < grid.packet_count(); ++tile) {
    make_ray_packet(packet, {{0}, frame, 77, grid}, frames, tile);
    for (uint32_t k = 0; k < kPacketSize; ++k) {
      const DVec3 d(get_direction(packet.ray, k));
      const double z = dot(d, DVec3(frame.normal));
      REQUIRE(z > 0);
      height += z, height_squared += z * z, below_half += z * z < 0.5;
      across += DVec2(dot(d, DVec3(frame.tangent)), dot(d, DVec3(frame.bitangent)));
    }
  }
  // Density 2 z dz: means 2/3 and 1/2; half of the rays within 45 degrees. Four standard errors of as many
  // random rays (variances 1/18, 1/12, 1/4 and 1/4) are more than those of stratified ones.
  const double n = grid.ray_count();
  CHECK(std::abs(height / n - 2.0 / 3) <= 4 * std::sqrt(1 / 18.0 / n));
  CHECK(std::abs(height_squared / n - 0.5) <= 4 * std::sqrt(1 / 12.0 / n));
  CHECK(std::abs(below_half / n - 0.5) <= 4 * std::sqrt(0.25 / n));
  CHECK(std::abs(across.x / n) <= 4 * std::sqrt(0.25 / n));
  CHECK(std::abs(across.y / n) <= 4 * std::sqrt(0.25 / n));
}

TEST_CASE("rows: in a closed room every ray meets a lit side, on the patch that it says") {
  for (const bool moved : {false, true}) {
    FaceTable faces = make_unit_room();
    add_box_outward(faces, {0.3f, 0.2f, 0.3f}, {0.6f, 0.5f, 0.7f}, make_surface(0, 0.5f));
    if (moved) map_scene(faces, 0.4f, {0.3f, -0.7f, 0.2f});
    const Cast rows = cast_all(faces, 2, 256, 3);
    for (size_t k = 0; k < rows.hits.patch.size(); ++k) {
      REQUIRE(rows.hits.patch[k] < rows.patches.size());
      REQUIRE(cell_ancestor(rows.hits.cell[k], 2) == rows.patches.cell[rows.hits.patch[k]]);
    }
    for (const float share : rows.patches.exposed) REQUIRE(share == 1);
  }
}

TEST_CASE("rows: a room of triangles and bent quads keeps all its rays") {
  FaceTable faces;
  add_sphere(faces, Vec3(0), 0.3f, 8, 11, std::numbers::pi, true, [](uint32_t) { return Surface{}; });
  const Cast rows = cast_all(faces, 1, 256, 5);
  size_t lost = 0;
  for (const uint32_t patch : rows.hits.patch) lost += patch >= rows.patches.size();
  // Where facets meet at less than 180 degrees, an origin half a millionth off its own facet can lie behind
  // the next one: a strip of 5e-7 / tan(angle between facets, at least 16 degrees) of edges 0.1 long.
  CHECK(static_cast<double>(lost) <= 1e-4 * static_cast<double>(rows.hits.patch.size()));
}

TEST_CASE("rows: form factors of the cube, floor to ceiling and floor to wall") {
  const Cast rows = cast_all(make_unit_room(), 3, 256, 1);
  std::array<double, 6> count{};
  const uint32_t floor_rows = rows.patches.face_first[1];
  for (size_t k = 0; k < size_t{floor_rows} * rows.hits.ray_count; ++k)
    ++count[rows.patches.face[rows.hits.patch[k]]];
  const double n = floor_rows * rows.hits.ray_count;
  CHECK(count[kFloor] == 0);
  // Howell C-11 and C-14; four standard errors of random rays.
  CHECK(std::abs(count[kCeiling] / n - 0.199824895698) <= 4 * std::sqrt(0.2 * 0.8 / n));
  for (const uint32_t wall : {kLeft, kRight, kFront, kBack})
    CHECK(std::abs(count[wall] / n - 0.200043776075) <= 4 * std::sqrt(0.2 * 0.8 / n));
}

TEST_CASE("rows: rays that leave the scene stay in the count, back sides stop them") {
  FaceTable faces;
  add_quad(faces, {0, 0, 0}, {0, 0, 1}, {1, 0, 1}, {1, 0, 0}, {});
  add_quad(faces, {0, 1, 0}, {0, 1, 1}, {1, 1, 1}, {1, 1, 0}, {});  // looks up: its back is towards the first
  const Cast rows = cast_all(faces, 2, 256, 1);
  size_t back = 0, nothing = 0;
  const size_t n = size_t{rows.patches.face_first[1]} * rows.hits.ray_count;
  for (size_t k = 0; k < n; ++k) {
    back += rows.hits.patch[k] == kHitBack;
    nothing += rows.hits.patch[k] == kHitNothing;
  }
  CHECK(back + nothing == n);
  CHECK(std::abs(static_cast<double>(back) / static_cast<double>(n) - 0.199824895698) <=
        4 * std::sqrt(0.2 * 0.8 / static_cast<double>(n)));
  // Above the second there is nothing.
  for (size_t k = n; k < rows.hits.patch.size(); ++k) REQUIRE(rows.hits.patch[k] == kHitNothing);
}

TEST_CASE("rows: what lies inside a solid is buried, what lies outside is not") {
  FaceTable faces = make_unit_room();
  // The box stands on the floor: on its grid of eighths it covers patches whole.
  add_box_outward(faces, {0.25f, -0.1f, 0.25f}, {0.75f, 0.5f, 0.5f}, {});
  const Cast rows = cast_all(faces, 3, 256, 1);
  for (uint32_t row = 0; row < rows.patches.face_first[1]; ++row) {
    const Vec3 c = cell_centre(rows.surfaces->frames, 0, rows.patches.cell[row], 3);
    const bool inside = c.x > 0.25f && c.x < 0.75f && c.z > 0.25f && c.z < 0.5f;
    CHECK(rows.patches.exposed[row] == (inside ? 0.0f : 1.0f));
    for (uint32_t k = 0; k < rows.hits.ray_count; ++k)
      CHECK((rows.hits.patch[size_t{row} * rows.hits.ray_count + k] == kHitBuried) == inside);
  }
  // Through the middle of patches: the share of the row's origins, one in each of 16 x 16 strata; those on
  // the box's edge may fall either way.
  FaceTable shifted = make_unit_room();
  add_box_outward(shifted, {0.3f, -0.1f, 0.3f}, {0.7f, 0.5f, 0.7f}, {});
  const Cast partly = cast_all(shifted, 2, 256, 1);
  const uint32_t corner = find_leaf(partly.patches, 0, find_cell(false, {0.3f, 0.3f}));
  CHECK(std::abs(1 - partly.patches.exposed[corner] - 0.2f * 0.2f / (0.25f * 0.25f)) <= 32 / 256.0f);
}

TEST_CASE("rows: points are found buried by what they see in all directions") {
  FaceTable faces = make_unit_room();
  add_box_outward(faces, {0.2f, 0.2f, 0.2f}, {0.4f, 0.4f, 0.4f}, {});
  const auto surfaces = make_surfaces(faces);
  RayPacket rays;
  for (uint32_t k = 0; k < kPacketSize; ++k) {
    const float x = k % 2 ? 0.3f : 0.6f;
    rays.origin_x[k] = x, rays.origin_y[k] = 0.3f, rays.origin_z[k] = 0.3f;
  }
  CHECK(find_buried(*surfaces, make_frame({0, 1, 0}), rays, 0xffff) == 0xaaaa);
  CHECK(find_buried(*surfaces, make_frame({0, 0, -1}), rays, 0x00ff) == 0x00aa);
}

TEST_CASE("rows: one seed gives one set of rows, another seed another") {
  const FaceTable faces = make_unit_room();
  const Cast a = cast_all(faces, 2, 64, 1), b = cast_all(faces, 2, 64, 1), c = cast_all(faces, 2, 64, 2);
  CHECK(a.hits.cell == b.hits.cell);
  CHECK(a.hits.patch == b.hits.patch);
  size_t same = 0;
  for (size_t k = 0; k < a.hits.cell.size(); ++k) same += a.hits.cell[k] == c.hits.cell[k];
  CHECK(same < a.hits.cell.size() / 100);
}

TEST_CASE("rows: cast again they are the rows that were kept, and so are their counts") {
  FaceTable faces = make_unit_room();
  // A window and a pillar: some rays end nowhere, some on backs, some start buried.
  faces.corners[kLeft] = {Vec3(0, 0, 0), Vec3(0, 0, 1), Vec3(0, 0.5f, 1), Vec3(0, 0.5f, 0)};
  add_box_outward(faces, {0.3f, -0.1f, 0.3f}, {0.7f, 0.5f, 0.7f}, make_surface(0, 0.5f));
  const auto surfaces = make_surfaces(faces);
  PatchTable patches = make_leaves(faces, surfaces->frames, [](uint32_t) { return 2u; });
  const ReceiverTable receivers = make_single_receivers(patches, *surfaces);
  const LeafIndex index = make_leaf_index(patches);
  const Casters casters{*surfaces, patches, index, receivers, make_ray_grid(100), 7};
  HitTable kept, counted;
  cast_rows(kept, patches.exposed, all_rows(receivers.size()), casters, true);
  const std::vector<float> exposed = patches.exposed;
  CHECK(cast_rows(counted, patches.exposed, all_rows(receivers.size()), casters, false) ==
        uint64_t{kept.ray_count} * receivers.size());
  CHECK(counted.patch.empty());
  CHECK(counted.nothing == kept.nothing);
  CHECK(counted.back == kept.back);
  CHECK(counted.buried == kept.buried);
  CHECK(patches.exposed == exposed);
  const auto total = [](const std::vector<uint32_t>& column) {
    return std::accumulate(column.begin(), column.end(), 0u);
  };
  CHECK(total(kept.nothing) == std::count(kept.patch.begin(), kept.patch.end(), kHitNothing));
  CHECK(total(kept.back) == std::count(kept.patch.begin(), kept.patch.end(), kHitBack));
  CHECK(total(kept.buried) == std::count(kept.patch.begin(), kept.patch.end(), kHitBuried));
  for (const auto* column : {&kept.nothing, &kept.back, &kept.buried}) CHECK(total(*column) > 0);
  const Rows rows{casters, counted};
  RowScratch scratch;
  for (uint32_t row = 0; row < receivers.size(); ++row) {
    const RowHits hits = find_row(scratch, rows, row);
    const size_t first = size_t{row} * kept.ray_count;
    REQUIRE(std::equal(hits.patch.begin(), hits.patch.end(), kept.patch.begin() + first));
    REQUIRE(std::equal(hits.cell.begin(), hits.cell.end(), kept.cell.begin() + first));
  }
}

TEST_CASE("rows: what is moved and cast anew after a split is what casting the split patches gives") {
  FaceTable faces = make_unit_room();
  add_box_outward(faces, {0.3f, -0.1f, 0.3f}, {0.7f, 0.5f, 0.7f}, make_surface(0, 0.5f));
  const auto surfaces = make_surfaces(faces);
  PatchTable before = make_leaves(faces, surfaces->frames, [](uint32_t) { return 2u; });
  const ReceiverTable receivers_before = make_single_receivers(before, *surfaces);
  std::vector<uint8_t> marks(before.size(), 0);
  for (size_t row = 0; row < marks.size(); row += 5) marks[row] = 1;
  for (const bool keep : {true, false}) {
    const RayGrid grid = make_ray_grid(64);
    const LeafIndex index_before = make_leaf_index(before);
    HitTable hits, anew;
    cast_rows(hits, before.exposed, all_rows(before.size()),
              {*surfaces, before, index_before, receivers_before, grid, 3}, keep);
    std::vector<uint32_t> parent, row_before, fresh;
    PatchTable patches = split_leaves(before, surfaces->frames, marks, parent);
    const ReceiverTable receivers = split_receivers(receivers_before, parent, patches, *surfaces, row_before);
    REQUIRE(receivers.size() == patches.size());
    for (uint32_t row = 0; row < row_before.size(); ++row) {
      CHECK((row_before[row] == kNone) == (marks[parent[row]] == 1));
      if (row_before[row] == kNone) fresh.push_back(row);
    }
    const LeafIndex index = make_leaf_index(patches);
    move_rows(hits, row_before, before, parent);
    const Casters casters{*surfaces, patches, index, receivers, grid, 3};
    cast_rows(hits, patches.exposed, fresh, casters, keep);
    const std::vector<float> exposed = patches.exposed;
    cast_rows(anew, patches.exposed, all_rows(receivers.size()), casters, keep);
    CHECK(is_equal(hits, anew));
    CHECK(exposed == patches.exposed);
  }
}
