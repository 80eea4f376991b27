// Packets of rays to an even sample of them, and back.
#include "engine/trace/ray_tape.h"

#include <algorithm>
#include <bit>

namespace patchlight {
namespace {

// Every second run goes, and from now on only every second one is taken.
void thin_out(TapeTrack& track) {
  size_t kept = 0;
  for (size_t k = 0; k < track.packets.size(); ++k) {
    if (k / kTapeRun % 2 != 0) continue;
    track.packets[kept] = track.packets[k];
    track.active[kept++] = track.active[k];
  }
  track.packets.resize(kept);
  track.active.resize(kept);
  track.stride *= 2;
}

void put_back(Replay& replay, size_t packet) {
  std::copy_n(&replay.far_distance[packet * kPacketSize], kPacketSize,
              replay.packets[packet].ray.far_distance);
}

}  // namespace

void keep_packet(TapeTrack& track, const RayPacket& packet, uint32_t active) {
  const uint64_t run = track.packet_count++ / kTapeRun;
  track.ray_count += static_cast<uint64_t>(std::popcount(active));
  if (run % track.stride != 0) return;
  if (track.packets.size() == kTapePacketsMax) {
    thin_out(track);
    if (run % track.stride != 0) return;
  }
  track.packets.push_back(packet);
  track.active.push_back(active);
}

void RayTape::see_nearest(const RayPacket& packet, uint32_t active) { keep_packet(nearest, packet, active); }
void RayTape::see_visibility(const RayPacket& packet, uint32_t active) {
  keep_packet(visibility, packet, active);
}

uint64_t count_kept_rays(const TapeTrack& track) {
  uint64_t count = 0;
  for (const uint32_t active : track.active) count += static_cast<uint64_t>(std::popcount(active));
  return count;
}

Replay make_replay(const TapeTrack& track) {
  Replay replay;
  replay.active = track.active;
  replay.packets.resize(track.packets.size());
  replay.lanes.resize(track.packets.size());
  for (size_t p = 0; p < track.packets.size(); ++p) {
    HitPacket& packet = replay.packets[p];
    packet.ray = track.packets[p];
    for (uint32_t k = 0; k < kPacketSize; ++k) {
      packet.ray.time[k] = 0, packet.ray.mask[k] = ~0u, packet.ray.id[k] = k, packet.ray.flags[k] = 0;
      packet.geometry[k] = packet.face[k] = packet.instance[k] = packet.instance_primitive[k] = ~0u;
      replay.lanes[p].valid[k] = (track.active[p] >> k & 1u) ? -1 : 0;
    }
    replay.far_distance.insert(replay.far_distance.end(), packet.ray.far_distance,
                               packet.ray.far_distance + kPacketSize);
  }
  return replay;
}

void replay_blocked(const Tracer& tracer, Replay& replay, RayOrder order) {
  for (size_t p = 0; p < replay.packets.size(); ++p) {
    put_back(replay, p);
    trace_blocked(tracer, replay.lanes[p].valid, replay.packets[p].ray, order);
  }
}

void replay_nearest(const Tracer& tracer, Replay& replay, RayOrder order) {
  for (size_t p = 0; p < replay.packets.size(); ++p) {
    put_back(replay, p);
    // As Embree's documentation asks for: nothing is hit yet.
    std::fill_n(replay.packets[p].geometry, kPacketSize, ~0u);
    trace_nearest(tracer, replay.lanes[p].valid, replay.packets[p], order);
  }
}

void replay_find_blocked(const Tracer& tracer, Replay& replay, RayOrder order) {
  for (size_t p = 0; p < replay.packets.size(); ++p) {
    put_back(replay, p);
    find_blocked(tracer, replay.packets[p].ray, replay.active[p], order);
  }
}

void replay_find_hits(const Tracer& tracer, Replay& replay) {
  for (size_t p = 0; p < replay.packets.size(); ++p) {
    put_back(replay, p);
    find_hits(tracer, replay.packets[p], replay.active[p]);
  }
}

}  // namespace patchlight
