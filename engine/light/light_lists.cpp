// Lamps to the lists that polygons aim at.
#include "engine/light/light_lists.h"

#include "engine/base/parallel.h"
#include "engine/base/union_find.h"
#include "engine/light/emitters.h"

#include <cassert>
#include <span>

namespace patchlight {
namespace {

// Above this mean share of its sky a polygon leaves lamps to its rows: closed rooms in which all emits come
// out exact then.
constexpr double kLampSkyMax = 0.8;
// So many lamps, the most powerful ones, may be aimed at: ranking them costs polygons times lamps.
constexpr size_t kLampsRankedMax = 512;
// Patches of a polygon from which its lamps are ranked.
constexpr uint32_t kListProbes = 64;

// A lamp that could light a polygon, and how strongly.
struct Candidate {
  double strength;
  uint32_t face;
};

// Lamps that reach any of the patches `rows` (ascending); sky: the mean share of their sky that they fill,
// both from up to kListProbes patches.
void find_candidates(std::vector<Candidate>& candidates, double& sky, std::span<const Emitter> lamps,
                     std::span<const uint32_t> rows, const PatchTable& patches, const Surfaces& surfaces) {
  const FaceTable& faces = surfaces.faces;
  const FaceFrameTable& frames = surfaces.frames;
  const size_t step = std::max(rows.size() / kListProbes, size_t{1});
  candidates.clear();
  double sky_sum = 0, area_sum = 0;
  for (size_t k = 0; k < rows.size(); k += step) area_sum += patches.area[rows[k]] * patches.exposed[rows[k]];
  for (const Emitter& lamp : lamps) {
    const auto is_reached = [&](size_t k) {
      const uint32_t face = patches.face[rows[k]];
      if (k > 0 && face == patches.face[rows[k - 1]]) return false;  // asked before
      return lamp.face != face && can_reach(cell_corners(frames, face, 0, 0), faces.normal[face], lamp);
    };
    bool reached = false;
    for (size_t k = 0; k < rows.size() && !reached; ++k) reached = is_reached(k);
    if (!reached) continue;
    double seen = 0;
    for (size_t k = 0; k < rows.size(); k += step) {
      const uint32_t row = rows[k], face = patches.face[row];
      const Vec3 centre = cell_centre(frames, face, patches.cell[row], patches.level[row]);
      seen += patches.area[row] * patches.exposed[row] * find_point_factor(centre, faces.normal[face], lamp);
    }
    sky_sum += seen;
    candidates.push_back({seen * luminance(faces.emission[lamp.face]), lamp.face});
  }
  sky = area_sum > 0 ? sky_sum / area_sum : 0;
}

// A list of its own for every polygon, but one for all polygons whose patches share a receiver. Returns the
// number of lists, which are in the order of their first polygons.
uint32_t share_lists(std::vector<uint32_t>& list_of, const FaceTable& faces, const PatchTable& patches,
                     const ReceiverTable& receivers) {
  list_of.resize(faces.size() ? faces.polygon.back() + 1 : 0);
  UnionFind polygons(list_of.size());
  for (size_t r = 0; r < receivers.size(); ++r)
    for (uint32_t k = receivers.first[r] + 1; k < receivers.first[r + 1]; ++k) {
      polygons.join(faces.polygon[patches.face[receivers.patch[k - 1]]],
                    faces.polygon[patches.face[receivers.patch[k]]]);
    }
  uint32_t count = 0;
  for (uint32_t polygon = 0; polygon < list_of.size(); ++polygon) {
    const uint32_t first = polygons.find(polygon);
    list_of[polygon] = first == polygon ? count++ : list_of[first];
  }
  return count;
}

}  // namespace

LightListTable make_light_lists(const Surfaces& surfaces, const PatchTable& patches,
                                const ReceiverTable& receivers) {
  const FaceTable& faces = surfaces.faces;
  assert(std::is_sorted(faces.polygon.begin(), faces.polygon.end()));
  std::vector<Emitter> lamps = make_emitters(faces, surfaces.frames);
  if (lamps.size() > kLampsRankedMax) {
    const auto power = [&](const Emitter& lamp) {
      return double{lamp.area} * luminance(faces.emission[lamp.face]);
    };
    std::nth_element(lamps.begin(), lamps.begin() + kLampsRankedMax, lamps.end(),
                     [&](const Emitter& a, const Emitter& b) {
                       return power(a) != power(b) ? power(a) > power(b) : a.face < b.face;
                     });
    lamps.resize(kLampsRankedMax);
  }
  LightListTable lists;
  const uint32_t list_count = share_lists(lists.list_of, faces, patches, receivers);
  std::vector<std::vector<uint32_t>> rows(list_count), chosen(list_count);
  for (uint32_t row = 0; row < patches.size(); ++row)
    rows[lists.list_of[faces.polygon[patches.face[row]]]].push_back(row);
  for_rows(list_count, 4, [&](size_t begin, size_t end) {
    std::vector<Candidate> candidates;
    for (size_t list = begin; list < end; ++list) {
      double sky = 0;
      find_candidates(candidates, sky, lamps, rows[list], patches, surfaces);
      if (sky > kLampSkyMax) continue;
      if (candidates.size() > kAimedLampsMax) {
        std::nth_element(candidates.begin(), candidates.begin() + kAimedLampsMax, candidates.end(),
                         [](const Candidate& a, const Candidate& b) {
                           return a.strength != b.strength ? a.strength > b.strength : a.face < b.face;
                         });
        candidates.resize(kAimedLampsMax);
      }
      for (const Candidate& candidate : candidates) chosen[list].push_back(candidate.face);
      std::sort(chosen[list].begin(), chosen[list].end());
    }
  });
  lists.list_first.push_back(0);
  for (const auto& list : chosen) {
    lists.lamp.insert(lists.lamp.end(), list.begin(), list.end());
    lists.list_first.push_back(static_cast<uint32_t>(lists.lamp.size()));
  }
  return lists;
}

}  // namespace patchlight
