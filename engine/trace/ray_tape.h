// Rays on tape: what a tracer was asked, and how long Embree alone needs for it.
//
// A benchmark must compare on the same rays. While a tape runs, every packet that goes through find_blocked
// and find_hits is counted, and an even sample of them is kept: runs of neighbouring packets, so that what is
// coherent in the engine is coherent in the replay, and few enough to stay in a core's cache.
#pragma once

#include "engine/trace/tracer.h"

#include <span>
#include <vector>

namespace patchlight {

constexpr size_t kTapePacketsMax = 1024;
constexpr size_t kTapeRun = 8;  // packets

struct TapeTrack {
  std::vector<RayPacket> packets;            // as they were asked; at most kTapePacketsMax
  std::vector<uint32_t> active;              // a row a packet: which of its rays count
  uint64_t packet_count = 0, ray_count = 0;  // of all that went by
  uint64_t stride = 1;                       // one run of so many is kept
};

struct RayTape final : RayObserver {
  TapeTrack visibility;  // find_blocked
  TapeTrack nearest;     // find_hits
  void see_nearest(const RayPacket& packet, uint32_t active) override;
  void see_visibility(const RayPacket& packet, uint32_t active) override;
};

// Counts a packet, and keeps it if it is its turn.
void keep_packet(TapeTrack& track, const RayPacket& packet, uint32_t active);
// Rays of the packets that were kept.
uint64_t count_kept_rays(const TapeTrack& track);

// The kept packets, ready for Embree: nothing but its own call remains to be done.
struct Replay {
  std::vector<HitPacket> packets;
  struct alignas(64) Lanes {
    int valid[16];  // as Embree takes it: -1 counts
  };
  std::vector<Lanes> lanes;
  std::vector<uint32_t> active;
  std::vector<float> far_distance;  // sixteen a packet: Embree overwrites it
};
Replay make_replay(const TapeTrack& track);

// Bare Embree: rtcOccluded16 and rtcIntersect16 over all packets, and putting back what they overwrote.
void replay_blocked(const Tracer& tracer, Replay& replay, RayOrder order);
void replay_nearest(const Tracer& tracer, Replay& replay, RayOrder order);

// The same packets through the engine's own find_blocked and find_hits.
void replay_find_blocked(const Tracer& tracer, Replay& replay, RayOrder order);
void replay_find_hits(const Tracer& tracer, Replay& replay);

}  // namespace patchlight
