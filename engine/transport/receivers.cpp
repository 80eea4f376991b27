// Patches to receivers.
#include "engine/transport/receivers.h"

#include "engine/base/parallel.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <span>

namespace patchlight {
namespace {

// A patch may share a receiver if the square root of its face's area is below this share of what the receiver
// may span, which is twice what a patch of a large face may: the light on small things is seen less closely.
constexpr float kSmallFace = 0.5f;
constexpr float kSpanPerDistance = 0.4f, kSpanMin = 0.01f, kSpanMax = 0.06f;
// Sixteen rays find the room in front of a patch to a factor of two or so: steps of eight.
constexpr float kReachStep = 8;
constexpr uint32_t kReachSteps = 16;
constexpr int kNormalSteps = 3;  // along each side of a cube around the directions

struct Candidate {
  uint32_t patch;
  uint32_t kind;  // candidates of different kinds share nothing
  float span;     // lengths: what its receiver may span
  Vec3 centre;
};

uint32_t find_normal_kind(Vec3 n) {
  const Vec3 size = abs(n);
  const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
  const auto step = [&](float t) {
    return std::clamp(static_cast<int>((t / size[axis] + 1) * 0.5f * kNormalSteps), 0, kNormalSteps - 1);
  };
  const int side = 2 * axis + (n[axis] < 0 ? 1 : 0);
  return static_cast<uint32_t>((side * kNormalSteps + step(n[(axis + 1) % 3])) * kNormalSteps +
                               step(n[(axis + 2) % 3]));
}

// What is in front of a patch, from one packet of rays. False if it must have a receiver of its own: large,
// or partly buried.
bool find_candidate(Candidate& candidate, uint32_t patch, const PatchTable& patches, const Surfaces& surfaces,
                    uint64_t seed) {
  const FaceTable& faces = surfaces.faces;
  const auto [face, cell, level] = name_cell(patches, patch);
  const float scale = surfaces.reach[face];
  const Probe probe = probe_cell(
      make_cell_rays(faces, {face, cell, level}, kShareRays, seed, make_ray_grid(kPacketSize)), surfaces);
  const bool buried = probe.buried_count > 0;
  if (buried && probe.buried_count < probe.ray_count) return false;
  const float reach = kPacketSize / std::max(probe.inverse_distance_sum, 1e-6f / scale);
  candidate.patch = patch;
  candidate.span = std::clamp(kSpanPerDistance * reach, kSpanMin * scale, kSpanMax * scale);
  if (cell_area(surfaces.frames, face, 0, 0) > kSmallFace * kSmallFace * candidate.span * candidate.span)
    return false;
  const float steps = std::log2(reach / surfaces.scale) / std::log2(kReachStep) + kReachSteps - 1;
  const auto reach_kind = static_cast<uint32_t>(std::clamp(steps, 0.0f, kReachSteps - 1.0f));
  candidate.kind =
      find_normal_kind(faces.normal[face]) * (kReachSteps + 1) + (buried ? kReachSteps : reach_kind);
  // The inside of a shade and its outside, on the other side of it, face one way.
  const uint32_t twin = faces.twin[face], side = twin == kNone ? 0 : twin > face ? 1 : 2;
  candidate.kind = 3 * candidate.kind + side;
  candidate.centre = cell_centre(surfaces.frames, face, cell, level);
  return true;
}

// Cuts candidates of one kind in halves of space until each part is small enough; ends[k]: where part k ends.
void cut_parts(std::span<Candidate> all, size_t begin, size_t end, const PatchTable& patches,
               std::vector<size_t>& ends) {
  Vec3 low(all[begin].centre), high = low;
  double area = 0, span_sum = 0;
  for (size_t k = begin; k < end; ++k) {
    low = min(low, all[k].centre), high = max(high, all[k].centre);
    area += patches.area[all[k].patch];
    span_sum += all[k].span;
  }
  const Vec3 size = high - low;
  const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
  const double span = span_sum / static_cast<double>(end - begin);
  if (size[axis] == 0 || (size[axis] <= span && area <= span * span)) {
    ends.push_back(end);
    return;
  }
  const float middle = 0.5f * (low[axis] + high[axis]);
  const auto first = all.begin() + static_cast<std::ptrdiff_t>(begin);
  const auto cut = std::stable_partition(first, all.begin() + static_cast<std::ptrdiff_t>(end),
                                         [&](const Candidate& c) { return c.centre[axis] <= middle; });
  const auto at = static_cast<size_t>(cut - all.begin());
  if (at == begin || at == end) {  // as close to each other as floats can be
    ends.push_back(end);
    return;
  }
  cut_parts(all, begin, at, patches, ends);
  cut_parts(all, at, end, patches, ends);
}

void add_receiver(ReceiverTable& receivers, std::span<const uint32_t> members, const PatchTable& patches,
                  const Surfaces& surfaces) {
  const auto row = static_cast<uint32_t>(receivers.size());
  double area = 0;
  DVec3 centre(0), normal(0);
  for (const uint32_t patch : members) {
    const double share = patches.area[patch];
    area += share;
    const auto [face, cell, level] = name_cell(patches, patch);
    centre += share * DVec3(cell_centre(surfaces.frames, face, cell, level));
    normal += share * DVec3(surfaces.faces.normal[face]);
    receivers.receiver_of[patch] = row;
    receivers.patch.push_back(patch);
    receivers.area_until.push_back(static_cast<float>(area));
  }
  for (size_t k = receivers.patch.size() - members.size(); k < receivers.patch.size(); ++k)
    receivers.area_until[k] = static_cast<float>(receivers.area_until[k] / area);
  receivers.area_until.back() = 1;
  receivers.first.push_back(static_cast<uint32_t>(receivers.patch.size()));
  receivers.centre.push_back(Vec3(centre / area));
  receivers.normal.push_back(Vec3(glm::normalize(normal)));
}

ReceiverTable make_empty(const PatchTable& patches) {
  ReceiverTable receivers;
  receivers.first.assign(1, 0);
  receivers.receiver_of.assign(patches.size(), kNone);
  return receivers;
}

}  // namespace

ReceiverTable make_single_receivers(const PatchTable& patches, const Surfaces& surfaces) {
  ReceiverTable receivers = make_empty(patches);
  for (uint32_t patch = 0; patch < patches.size(); ++patch)
    add_receiver(receivers, std::span(&patch, 1), patches, surfaces);
  return receivers;
}

ReceiverTable split_receivers(const ReceiverTable& before, std::span<const uint32_t> parent,
                              const PatchTable& patches, const Surfaces& surfaces,
                              std::vector<uint32_t>& row_before) {
  const auto is_shared = [&](uint32_t row) { return before.first[row + 1] - before.first[row] > 1; };
  ReceiverTable receivers = make_empty(patches);
  row_before.clear();
  const auto is_split = [&](uint32_t patch) {
    return (patch > 0 && parent[patch - 1] == parent[patch]) ||
           (patch + 1 < parent.size() && parent[patch + 1] == parent[patch]);
  };
  for (uint32_t patch = 0; patch < patches.size(); ++patch) {
    const uint32_t row = before.receiver_of[parent[patch]];
    if (is_shared(row)) continue;
    add_receiver(receivers, std::span(&patch, 1), patches, surfaces);
    row_before.push_back(is_split(patch) ? kNone : row);
  }
  std::vector<std::vector<uint32_t>> members(before.size());
  for (uint32_t patch = 0; patch < patches.size(); ++patch)
    if (const uint32_t row = before.receiver_of[parent[patch]]; is_shared(row)) members[row].push_back(patch);
  for (uint32_t row = 0; row < before.size(); ++row) {
    if (members[row].empty()) continue;
    add_receiver(receivers, members[row], patches, surfaces);
    // With other members its rays start elsewhere: a row that was kept would not be the one that is cast
    // again.
    const bool same = members[row].size() == before.first[row + 1] - before.first[row];
    row_before.push_back(same ? row : kNone);
  }
  return receivers;
}

ReceiverTable make_receivers(const PatchTable& patches, const Surfaces& surfaces, uint64_t seed,
                             uint64_t& ray_count) {
  std::vector<Candidate> all(patches.size());
  std::atomic<uint64_t> probed{0};
  for_rows(patches.size(), 256, [&](size_t begin, size_t end) {
    uint64_t rays = 0;
    for (size_t row = begin; row < end; ++row) {
      all[row].patch = kNone;
      const float scale = surfaces.reach[patches.face[row]];
      const float largest_area = kSmallFace * kSmallFace * kSpanMax * kSpanMax * scale * scale;
      if (cell_area(surfaces.frames, patches.face[row], 0, 0) > largest_area) continue;
      rays += kPacketSize;
      if (!find_candidate(all[row], static_cast<uint32_t>(row), patches, surfaces, seed))
        all[row].patch = kNone;
    }
    probed += rays;
  });
  ray_count += probed;
  std::erase_if(all, [](const Candidate& candidate) { return candidate.patch == kNone; });
  std::stable_sort(all.begin(), all.end(),
                   [](const Candidate& a, const Candidate& b) { return a.kind < b.kind; });
  std::vector<size_t> ends;
  for (size_t begin = 0, end = 0; begin < all.size(); begin = end) {
    while (end < all.size() && all[end].kind == all[begin].kind) ++end;
    cut_parts(all, begin, end, patches, ends);
  }
  std::vector<uint8_t> shares(patches.size(), 0);
  for (size_t part = 0, begin = 0; part < ends.size(); begin = ends[part++])
    if (ends[part] - begin > 1)
      for (size_t k = begin; k < ends[part]; ++k) shares[all[k].patch] = 1;
  // Those on their own first, in the order of the patches: neighbours in memory are neighbours in space.
  ReceiverTable receivers = make_empty(patches);
  for (uint32_t patch = 0; patch < patches.size(); ++patch)
    if (!shares[patch]) add_receiver(receivers, std::span(&patch, 1), patches, surfaces);
  std::vector<uint32_t> members;
  for (size_t part = 0, begin = 0; part < ends.size(); begin = ends[part++]) {
    if (ends[part] - begin < 2) continue;
    members.clear();
    for (size_t k = begin; k < ends[part]; ++k) members.push_back(all[k].patch);
    std::sort(members.begin(), members.end());
    add_receiver(receivers, members, patches, surfaces);
  }
  return receivers;
}

}  // namespace patchlight
