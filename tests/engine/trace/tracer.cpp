#include "engine/trace/tracer.h"

#include "engine/base/sampling.h"
#include "tests/scenes.h"

#include <doctest/doctest.h>

#include <limits>

using namespace patchlight;

namespace {

void set_ray(RayPacket& rays, uint32_t k, Vec3 origin, Vec3 direction, float far_distance) {
  rays.origin_x[k] = origin.x, rays.origin_y[k] = origin.y, rays.origin_z[k] = origin.z;
  rays.direction_x[k] = direction.x, rays.direction_y[k] = direction.y, rays.direction_z[k] = direction.z;
  rays.near_distance[k] = 0, rays.far_distance[k] = far_distance;
}

constexpr float kFar = std::numeric_limits<float>::infinity();

Vec3 make_direction(uint64_t key, uint32_t index) {
  const Vec2 p = make_jitter(key, index);
  const float height = 2 * p.x - 1, round = 2 * kPi * p.y,
              wide = std::sqrt(std::max(1 - height * height, 0.0f));
  return {wide * std::cos(round), height, wide * std::sin(round)};
}

}  // namespace

TEST_CASE("tracer: the nearest face, its distance, and nothing where nothing is") {
  FaceTable faces;
  add_quad(faces, {0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {});
  add_triangle(faces, {0, 0, -1}, {1, 0, -1}, {0, 1, -1}, {});
  const Tracer tracer = make_tracer(faces);
  HitPacket packet;
  for (uint32_t k = 0; k < kPacketSize; ++k) set_ray(packet.ray, k, {5, 5, 5}, {1, 0, 0}, kFar);
  set_ray(packet.ray, 0, {0.25f, 0.25f, 2}, {0, 0, -1}, kFar);
  set_ray(packet.ray, 1, {0.25f, 0.25f, -3}, {0, 0, 1}, kFar);
  set_ray(packet.ray, 2, {0.25f, 0.25f, -0.5f}, {0, 0, -2}, kFar);
  set_ray(packet.ray, 3, {0.9f, 0.9f, -3}, {0, 0, 1}, kFar);
  set_ray(packet.ray, 4, {0.25f, 0.25f, 2}, {0, 0, -1}, 1.5f);
  set_ray(packet.ray, 5, {0.25f, 0.25f, 2}, {0, 0, -1}, kFar);
  find_hits(tracer, packet, 0xffff & ~(1u << 5));
  CHECK(packet.face[0] == 0);
  CHECK(packet.ray.far_distance[0] == doctest::Approx(2).epsilon(1e-6));
  CHECK(packet.face[1] == 1);
  CHECK(packet.face[2] == 1);
  // Distances are in units of the direction's length.
  CHECK(packet.ray.far_distance[2] == doctest::Approx(0.25).epsilon(1e-6));
  CHECK(packet.face[3] == 0);
  CHECK(packet.face[4] == kNone);
  CHECK(packet.face[5] == kNone);
  CHECK(packet.face[6] == kNone);
}

TEST_CASE("tracer: which rays are blocked before their end") {
  FaceTable faces;
  add_quad(faces, {0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {});
  const Tracer tracer = make_tracer(faces);
  RayPacket rays;
  for (uint32_t k = 0; k < kPacketSize; ++k)
    set_ray(rays, k, {0.5f, 0.5f, 1}, {0, 0, -1}, k < 8 ? 2.0f : 0.5f);
  set_ray(rays, 3, {0.5f, 0.5f, 1}, {0, 0, 1}, 2);
  set_ray(rays, 4, {0.5f, 0.5f, -1}, {0, 0, 1}, 2);  // from the back, too
  CHECK(find_blocked(tracer, rays, 0xffff & ~1u) == (0xffu & ~1u & ~(1u << 3)));
}

TEST_CASE("tracer: of two faces back to back the ray's side decides") {
  FaceTable faces;
  add_quad(faces, {9, 9, 9}, {9, 8, 9}, {8, 8, 9}, {8, 9, 9}, {});
  const std::array quad = {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(1, 1, 0), Vec3(0, 1, 0)};
  const std::array triangle = {Vec3(0, 0, 1), Vec3(1, 0, 1), Vec3(0, 1, 1)};
  add_two_sided(faces, quad, {}, {});
  add_two_sided(faces, triangle, {}, {});
  const Tracer tracer = make_tracer(faces);
  HitPacket packet;
  for (uint32_t k = 0; k < kPacketSize; ++k)
    set_ray(packet.ray, k, {0.2f, 0.2f, k % 2 ? -1.0f : 2.0f}, {0, 0, k % 2 ? 1.0f : -1.0f}, kFar);
  set_ray(packet.ray, 2, {0.2f, 0.2f, 0.5f}, {0, 0, -1}, kFar);
  set_ray(packet.ray, 3, {0.2f, 0.2f, 0.5f}, {0, 0, 1}, kFar);
  find_hits(tracer, packet, 0xffff);
  CHECK(packet.face[0] == 3);  // the triangle's front looks up
  CHECK(packet.face[1] == 2);  // the quad's back looks down
  CHECK(packet.face[2] == 1);
  CHECK(packet.face[3] == 4);
  for (uint32_t k = 0; k < kPacketSize; ++k) {
    const Vec3 direction(packet.ray.direction_x[k], packet.ray.direction_y[k], packet.ray.direction_z[k]);
    CHECK(dot(direction, faces.normal[packet.face[k]]) < 0);
  }
}

TEST_CASE("tracer: edges shared by faces do not leak, nor do corners") {
  FaceTable faces;
  add_sphere(faces, Vec3(0.1f, 0.2f, 0.3f), 0.5f, 9, 13, std::numbers::pi, true,
             [](uint32_t) { return Surface{}; });
  const Tracer tracer = make_tracer(faces);
  const Vec3 inside(0.15f, 0.18f, 0.33f);
  HitPacket packet;
  uint32_t missed = 0;
  const auto cast = [&] {
    find_hits(tracer, packet, 0xffff);
    for (uint32_t k = 0; k < kPacketSize; ++k) {
      const Vec3 d(packet.ray.direction_x[k], packet.ray.direction_y[k], packet.ray.direction_z[k]);
      missed += packet.face[k] == kNone || dot(d, faces.normal[packet.face[k]]) >= 0;
    }
  };
  // At every corner and along every edge.
  uint32_t count = 0;
  for (uint32_t f = 0; f < faces.size(); ++f)
    for (uint32_t edge = 0; edge < faces.corner_count[f]; ++edge)
      for (uint32_t step = 0; step < kPacketSize; ++step) {
        const Vec3 a = faces.corners[f][edge], b = faces.corners[f][(edge + 1) % faces.corner_count[f]];
        set_ray(packet.ray, step, inside, a + static_cast<float>(step) / kPacketSize * (b - a) - inside,
                kFar);
        if (step == kPacketSize - 1) cast(), count += kPacketSize;
      }
  // And all about.
  for (uint32_t k = 0; k < 4096; ++k) {
    for (uint32_t lane = 0; lane < kPacketSize; ++lane)
      set_ray(packet.ray, lane, inside, make_direction(1, kPacketSize * k + lane), kFar);
    cast(), count += kPacketSize;
  }
  CHECK(count > 60000);
  CHECK(missed == 0);
}

TEST_CASE("tracer: a scene without faces blocks nothing") {
  const Tracer tracer = make_tracer({});
  HitPacket packet;
  for (uint32_t k = 0; k < kPacketSize; ++k) set_ray(packet.ray, k, Vec3(0), {0, 0, 1}, kFar);
  find_hits(tracer, packet, 0xffff);
  for (uint32_t k = 0; k < kPacketSize; ++k) CHECK(packet.face[k] == kNone);
}

TEST_CASE("tracer: the version names Embree") { CHECK(std::string(tracer_version()).find("Embree") == 0); }
