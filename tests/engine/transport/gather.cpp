#include "engine/transport/gather.h"

#include "engine/transport/receivers.h"
#include "engine/transport/sources.h"
#include "tests/scenes.h"

#include <doctest/doctest.h>

using namespace patchlight;

namespace {

// A room with a bright spot on its floor: one small square of it, flush with the floor, sends most of the
// light.
struct Room {
  std::shared_ptr<const Surfaces> surfaces;
  PatchTable patches, elements;
  std::vector<uint32_t> first;
  HitTable hits;
  std::vector<Rgb> sent;
  uint64_t seed;
  ReceiverTable receivers = {};
  LeafIndex index = {};
};

Rows get_rows(const Room& room) {
  return {{*room.surfaces, room.patches, room.index, room.receivers, make_ray_grid(256), room.seed},
          room.hits};
}

Room make_room(std::shared_ptr<const Surfaces> surfaces, uint64_t seed) {
  Room room{std::move(surfaces), {}, {}, {}, {}, {}, seed};
  const FaceTable& faces = room.surfaces->faces;
  const FaceFrameTable& frames = room.surfaces->frames;
  room.patches = make_leaves(faces, frames, [](uint32_t) { return 3u; });
  room.elements = make_leaves(faces, frames, [](uint32_t) { return 5u; });
  room.receivers = make_single_receivers(room.patches, *room.surfaces);
  room.index = make_leaf_index(room.patches);
  cast_rows(room.hits, room.patches.exposed, all_rows(room.patches.size()), get_rows(room).by, true);
  room.first = find_union_ranges(room.patches, room.elements);
  room.sent.resize(room.elements.size());
  for (uint32_t row = 0; row < room.elements.size(); ++row) {
    const Vec3 c = cell_centre(room.surfaces->frames, room.elements.face[row], room.elements.cell[row], 5);
    const bool spot =
        room.elements.face[row] == kFloor && std::abs(c.x - 0.3f) < 0.1f && std::abs(c.z - 0.4f) < 0.1f;
    room.sent[row] = spot ? Rgb(100, 50, 25) : Rgb(1, 0.5f, 0.25f);
  }
  return room;
}

FaceTable make_box(bool with_pillar) {
  FaceTable faces;
  add_box_inward(faces, Vec3(0), Vec3(1), make_box_surfaces(make_surface(0, 0.5f)));
  if (with_pillar) add_box_outward(faces, {0.6f, 0.1f, 0.6f}, {0.8f, 0.7f, 0.8f}, make_surface(0, 0.5f));
  return faces;
}

std::vector<Rgb> gather(const Room& room, const std::vector<Rgb>& sent, uint32_t source_count) {
  const SourceTable sources =
      source_count ? make_sources(room.elements, *room.surfaces, sent, source_count) : SourceTable{};
  std::vector<Rgb> irradiance(room.patches.size());
  gather_elements(irradiance, {}, get_rows(room), {room.elements, room.first}, sent, sources);
  return irradiance;
}

}  // namespace

TEST_CASE("gather: where all send alike, every patch of a closed room receives exactly that") {
  const FaceTable faces = make_box(true);
  const auto surfaces = make_surfaces(faces);
  const Room room = make_room(surfaces, 1);
  const std::vector<Rgb> patch_sent(room.patches.size(), Rgb(3, 1, 0.25f));
  std::vector<Rgb> irradiance(room.patches.size()), difference(room.patches.size());
  gather_patches(irradiance, difference, get_rows(room), patch_sent);
  // Sums of 256 equal floats.
  for (const Rgb& value : irradiance) CHECK(distance(value, Rgb(3, 1, 0.25f)) <= 1e-4f);
  for (const Rgb& value : difference) CHECK(largest(abs(value)) <= 1e-4f);
  const std::vector<Rgb> element_sent(room.elements.size(), Rgb(3, 1, 0.25f));
  for (const uint32_t source_count : {0u, 400u})
    for (const Rgb& value : gather(room, element_sent, source_count))
      CHECK(distance(value, Rgb(3, 1, 0.25f)) <= 1e-4f);
}

TEST_CASE("gather: rays aimed at bright places change the noise and not the mean") {
  const FaceTable faces = make_box(true);
  const auto surfaces = make_surfaces(faces);
  // The sum of received power over all patches but those of the floor, of whose own plane the spot is; by the
  // seeds' own scatter.
  constexpr uint32_t kSeeds = 8;
  double sum[2] = {0, 0}, squares[2] = {0, 0};
  for (uint32_t seed = 1; seed <= kSeeds; ++seed) {
    const Room room = make_room(surfaces, seed);
    for (int aimed = 0; aimed < 2; ++aimed) {
      const auto irradiance = gather(room, room.sent, aimed ? 400 : 0);
      double power = 0;
      for (uint32_t row = room.patches.face_first[1]; row < room.patches.size(); ++row)
        power += double{room.patches.area[row]} * irradiance[row].g;
      sum[aimed] += power, squares[aimed] += power * power;
    }
  }
  const auto variance = [&](int k) { return (squares[k] - sum[k] * sum[k] / kSeeds) / (kSeeds - 1); };
  // Four standard errors of the difference of two means of eight, and the rounding of the sums.
  const double error = 4 * std::sqrt((variance(0) + variance(1)) / kSeeds) + 1e-5 * sum[0] / kSeeds;
  CHECK(std::abs(sum[0] - sum[1]) / kSeeds <= error);
}

TEST_CASE("gather: aimed rays leave less noise in every wall than the rows alone") {
  const FaceTable faces = make_box(false);
  const auto surfaces = make_surfaces(faces);
  const Room a = make_room(surfaces, 1), b = make_room(surfaces, 2);
  double noise[2] = {0, 0};
  for (int aimed = 0; aimed < 2; ++aimed) {
    const auto first = gather(a, a.sent, aimed ? 400 : 0), second = gather(b, b.sent, aimed ? 400 : 0);
    for (size_t row = 0; row < first.size(); ++row) noise[aimed] += std::pow(first[row].g - second[row].g, 2);
  }
  CHECK(noise[1] < 0.5 * noise[0]);
}

TEST_CASE("gather: rays that meet nothing or a back side bring nothing, buried ones do not count") {
  HitTable hits;
  hits.ray_count = 16;
  hits.patch.assign(3 * 16, 0);
  hits.cell.assign(3 * 16, 0);
  for (uint32_t k = 0; k < 16; ++k) {
    hits.patch[k] = k < 4 ? kHitNothing : k < 8 ? kHitBack : 2;
    hits.patch[16 + k] = k % 2 ? kHitBuried : 1;
    hits.patch[32 + k] = kHitBuried;
  }
  hits.nothing = {4, 0, 0}, hits.back = {4, 0, 0}, hits.buried = {0, 8, 16};
  const std::vector<Rgb> sent = {Rgb(100), Rgb(7), Rgb(1, 2, 3)};
  std::vector<Rgb> irradiance(3), difference(3);
  ReceiverTable receivers;
  receivers.first = {0, 1, 2, 3};
  receivers.patch = receivers.receiver_of = {0, 1, 2};
  receivers.centre.resize(3);
  const auto surfaces = make_surfaces({});
  const PatchTable patches;
  const LeafIndex index;
  const Rows rows{{*surfaces, patches, index, receivers, {}}, hits};
  gather_patches(irradiance, difference, rows, sent);
  CHECK(irradiance[0] == Rgb(0.5f, 1, 1.5f));
  CHECK(irradiance[1] == Rgb(7));
  CHECK(irradiance[2] == Rgb(0));
  CHECK(difference[2] == Rgb(0));
  std::vector<Rgb> again(3);
  gather_patches(again, {}, rows, sent);
  CHECK(again == irradiance);
}

TEST_CASE("gather: the stated difference is about the standard error of the row") {
  const FaceTable faces = make_box(false);
  const auto surfaces = make_surfaces(faces);
  const Room a = make_room(surfaces, 1), b = make_room(surfaces, 2);
  // Patches send by their place, so that rows are noisy.
  std::vector<Rgb> sent(a.patches.size());
  for (uint32_t row = 0; row < sent.size(); ++row) sent[row] = Rgb(row % 4 == 0 ? 1.0f : 0.0f);
  std::vector<Rgb> first(sent.size()), second(sent.size()), difference(sent.size());
  gather_patches(second, {}, get_rows(b), sent);
  gather_patches(first, difference, get_rows(a), sent);
  double squares = 0, stated = 0;
  for (size_t row = 0; row < sent.size(); ++row) {
    squares += std::pow(first[row].g - second[row].g, 2) / 2;
    stated += std::pow(difference[row].g, 2);
  }
  // 384 rows: within a factor of two, and stratification may make the whole better than its halves tell.
  CHECK(squares <= 2 * stated);
  CHECK(squares >= stated / 8);
}

TEST_CASE("gather: rows count emission, but not those of polygons that aim at it") {
  FaceTable faces = make_box(false);
  faces.emission[kCeiling] = Rgb(2), faces.emission[kLeft] = Rgb(1);
  const auto surfaces = make_surfaces(faces);
  const Room room = make_room(surfaces, 1);
  std::vector<float> by_rows(faces.size(), 2);
  std::vector<Rgb> all(room.patches.size()), others(all);
  gather_emission(all, {}, get_rows(room), by_rows);
  by_rows[faces.polygon[0]] = 0;
  gather_emission(others, {}, get_rows(room), by_rows);
  double floor_all = 0;
  const uint32_t count = room.patches.face_first[1];
  for (uint32_t row = 0; row < count; ++row) floor_all += double{all[row].g} / count;
  // Howell C-11, C-14; rays of the whole floor.
  const double error = 4 * 2 * std::sqrt(0.2 * 0.8 / (256.0 * count));
  CHECK(std::abs(floor_all - (2 * 0.199824895698 + 0.200043776075)) <= error);
  for (uint32_t row = 0; row < count; ++row) CHECK(others[row] == Rgb(0));
  for (size_t row = count; row < others.size(); ++row) CHECK(others[row] == all[row]);
}

TEST_CASE("sources: bright nodes that do not overlap, made of whole elements") {
  const FaceTable faces = make_box(true);
  const auto surfaces = make_surfaces(faces);
  const Room room = make_room(surfaces, 1);
  for (const uint32_t count : {10u, 100u, 400u}) {
    const SourceTable sources = make_sources(room.elements, *room.surfaces, room.sent, count);
    REQUIRE(sources.size() > 0);
    CHECK(sources.size() <= count + faces.size() + 3);
    std::vector<uint8_t> covered(room.elements.size(), 0);
    for (size_t s = 0; s < sources.size(); ++s) {
      double area = 0;
      for (uint32_t row = sources.element_first[s]; row < sources.element_last[s]; ++row) {
        CHECK(covered[row] == 0);
        covered[row] = 1;
        CHECK(room.elements.face[row] == sources.face[s]);
        CHECK(cell_ancestor(room.elements.cell[row], sources.level[s]) == sources.cell[s]);
        area += room.elements.area[row];
      }
      CHECK(sources.area[s] == doctest::Approx(area).epsilon(1e-5));
      CHECK(sources.face[s] == kFloor);
    }
    // All of the spot is aimed at.
    if (count == 400)
      for (uint32_t row = 0; row < room.elements.size(); ++row)
        if (room.sent[row].r > 50) CHECK(covered[row] == 1);
  }
}

TEST_CASE("sources: none where nothing is sent, or everything alike") {
  const FaceTable faces = make_box(false);
  const auto surfaces = make_surfaces(faces);
  const Room room = make_room(surfaces, 1);
  CHECK(make_sources(room.elements, *room.surfaces, std::vector<Rgb>(room.elements.size(), Rgb(0)), 400)
            .size() == 0);
  CHECK(make_sources(room.elements, *room.surfaces, std::vector<Rgb>(room.elements.size(), Rgb(2)), 400)
            .size() == 0);
}

TEST_CASE("beside a bright spot that it touches a patch meets no sample that outweighs all others") {
  // The spot lies in the corner of the floor at x = 0: the patches of the left wall that stand on it.
  const FaceTable faces = make_box(false);
  const auto surfaces = make_surfaces(faces);
  constexpr uint64_t kSeeds = 40;
  std::vector<std::vector<double>> found;  // a row a seed
  for (uint64_t seed = 1; seed <= kSeeds; ++seed) {
    Room room = make_room(surfaces, seed);
    for (uint32_t row = 0; row < room.elements.size(); ++row) {
      const Vec3 c = cell_centre(room.surfaces->frames, room.elements.face[row], room.elements.cell[row], 5);
      const bool spot = room.elements.face[row] == kFloor && c.x < 0.125f && c.z > 0.25f && c.z < 0.75f;
      room.sent[row] = spot ? Rgb(100) : Rgb(0);
    }
    const SourceTable sources = make_sources(room.elements, *room.surfaces, room.sent, 40);
    std::vector<Rgb> irradiance(room.patches.size());
    gather_elements(irradiance, {}, get_rows(room), {room.elements, room.first}, room.sent, sources);
    std::vector<double>& row = found.emplace_back();
    for (uint32_t p = room.patches.face_first[kLeft]; p < room.patches.face_first[kLeft + 1]; ++p) {
      const Vec3 c = cell_centre(room.surfaces->frames, room.patches.face[p], room.patches.cell[p], 3);
      if (c.y < 0.125f && c.z > 0.25f && c.z < 0.75f) row.push_back(double{irradiance[p].g});
    }
  }
  REQUIRE(found.front().size() == 4);
  for (size_t p = 0; p < 4; ++p) {
    double mean = 0;
    for (const auto& row : found) mean += row[p] / kSeeds;
    // The row alone, 256 rays of which a third or more reach the spot, errs by less than
    // sqrt((1 - 1/3) / (256 / 3)) = 9 %; strata and aimed rays can only better it. Four times that is met
    // once in ten thousand draws.
    for (const auto& row : found) CHECK(std::abs(row[p] / mean - 1) <= 0.36);
  }
}
