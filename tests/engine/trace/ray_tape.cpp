// A tape counts every packet, keeps an even sample of them, and its replay asks the same questions.
#include "engine/trace/ray_tape.h"

#include "tests/scenes.h"

#include <doctest/doctest.h>

#include <limits>

using namespace patchlight;

TEST_CASE("ray_tape: a long tape is an even sample, in whole runs") {
  TapeTrack track;
  RayPacket packet{};
  constexpr uint64_t kCount = 5 * kTapePacketsMax + 3;
  for (uint64_t k = 0; k < kCount; ++k) {
    packet.origin_x[0] = static_cast<float>(k);
    keep_packet(track, packet, 0b101);
  }
  CHECK(track.packet_count == kCount);
  CHECK(track.ray_count == 2 * kCount);
  CHECK(track.packets.size() <= kTapePacketsMax);
  CHECK(track.packets.size() > kTapePacketsMax / 2);
  CHECK(count_kept_rays(track) == 2 * track.packets.size());
  for (size_t k = 0; k < track.packets.size(); ++k)
    REQUIRE(track.packets[k].origin_x[0] ==
            static_cast<float>(k / kTapeRun * track.stride * kTapeRun + k % kTapeRun));
}

TEST_CASE("ray_tape: bare Embree answers as the engine's own functions do, as often as it is asked") {
  FaceTable faces;
  add_quad(faces, {0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {});
  const Tracer tracer = make_tracer(faces);
  HitPacket rays;
  for (uint32_t k = 0; k < kPacketSize; ++k) {
    rays.ray.origin_x[k] = k % 2 ? 0.5f : 2.5f, rays.ray.origin_y[k] = 0.5f, rays.ray.origin_z[k] = 1;
    rays.ray.direction_x[k] = rays.ray.direction_y[k] = 0, rays.ray.direction_z[k] = -1;
    rays.ray.near_distance[k] = 0, rays.ray.far_distance[k] = std::numeric_limits<float>::infinity();
  }
  RayPacket shadow = rays.ray;
  RayTape tape;
  observe_rays(tracer, &tape);
  CHECK(find_blocked(tracer, shadow, 0xff) == 0xaa);
  find_hits(tracer, rays, 0xff);
  observe_rays(tracer, nullptr);
  find_hits(tracer, rays, 0xff);
  CHECK(tape.visibility.ray_count == 8);
  CHECK(tape.nearest.ray_count == 8);

  Replay blocked = make_replay(tape.visibility), nearest = make_replay(tape.nearest);
  REQUIRE(blocked.packets.size() == 1);
  REQUIRE(nearest.packets.size() == 1);
  for (const RayOrder order : {RayOrder::kCoherent, RayOrder::kIncoherent, RayOrder::kCoherent}) {
    replay_blocked(tracer, blocked, order);
    replay_nearest(tracer, nearest, order);
    for (uint32_t k = 0; k < kPacketSize; ++k) {
      const bool hit = k < 8 && k % 2 == 1;
      CHECK((blocked.packets[0].ray.far_distance[k] < 0) == hit);
      CHECK((nearest.packets[0].ray.far_distance[k] == 1) == hit);
    }
    replay_find_hits(tracer, nearest);
    for (uint32_t k = 0; k < 8; ++k) CHECK(nearest.packets[0].face[k] == (k % 2 == 1 ? 0 : kNone));
  }
}
