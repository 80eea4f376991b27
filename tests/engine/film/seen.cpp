#include "engine/film/seen.h"

#include "engine/base/sampling.h"
#include "tests/scenes.h"

#include <doctest/doctest.h>

using namespace patchlight;

namespace {

// A room with a lamp, a triangle that leans, and a quad that is no parallelogram before its back wall; its
// front is open.
FaceTable make_hall() {
  FaceTable faces;
  add_quad(faces, {0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, make_surface(0, 0.5f));
  add_quad(faces, {0, 0, 1}, {1, 0, 1}, {1, 0, 0}, {0, 0, 0}, make_surface(0, 0.5f));
  add_triangle(faces, {0.1f, 0.1f, 0.4f}, {0.6f, 0.2f, 0.3f}, {0.3f, 0.6f, 0.2f}, make_surface(0, 0.5f));
  add_quad(faces, {0.5f, 0.5f, 0.3f}, {0.95f, 0.55f, 0.3f}, {0.8f, 0.9f, 0.3f}, {0.55f, 0.75f, 0.3f},
           make_surface(5, 0.5f));
  return faces;
}

}  // namespace

TEST_CASE(
    "seen: every sample finds the element that holds its hit, whichever was guessed, alone or in a packet") {
  const FaceTable faces = make_hall();
  const Solution s = solve_scene(faces, {}, 1);
  View view{.eye = {0.45f, 0.5f, 2.2f}, .target = {0.5f, 0.45f, 0}, .up = {0, 1, 0}};
  view.fov_degrees = 50, view.width = 64, view.height = 48;
  size_t hit_count = 0, mixed_count = 0;
  for (const Projection& projection : projections()) {
    view.projection = &projection;
    const Lens lens = make_lens(view);
    const Prospect prospect{lens, *s.surfaces, s.mesh.elements};
    uint32_t guess = kNone;
    for (uint32_t packet = 0; packet < 64 * 48; ++packet) {
      Vec2 at[kPacketSize];
      for (uint32_t k = 0; k < kPacketSize; ++k)
        at[k] =
            Vec2(static_cast<float>(packet % 64), static_cast<float>(packet / 64)) + make_jitter(packet, k);
      Seen seen, again;
      uint32_t other = packet % static_cast<uint32_t>(s.mesh.elements.size());
      find_seen(seen, guess, at, prospect);
      find_seen(again, other, at, prospect);
      bool mixed = false;
      for (uint32_t k = 0; k < kPacketSize; ++k) {
        REQUIRE(seen.element[k] == again.element[k]);
        mixed |= seen.element[k] != seen.element[0];
        const uint32_t row = seen.element[k];
        if (row == kNone) continue;
        ++hit_count;
        REQUIRE(lens.covers(at[k]));
        const uint32_t face = s.mesh.elements.face[row];
        // Coordinates of about 1, a dozen roundings.
        const Vec3 point = lens.eye + seen.distance[k] * lens.find_direction(at[k]);
        REQUIRE(length(point - face_point(s.surfaces->frames, face, {seen.u[k], seen.v[k]})) < 5e-6f);
        REQUIRE(row == find_leaf(s.mesh.elements, face,
                                 find_cell(s.surfaces->frames.triangle[face], {seen.u[k], seen.v[k]})));
        REQUIRE(dot(lens.find_direction(at[k]), faces.normal[face]) < 0);
      }
      mixed_count += mixed;
    }
  }
  CHECK(hit_count > 10'000);
  CHECK(mixed_count > 100);
}
