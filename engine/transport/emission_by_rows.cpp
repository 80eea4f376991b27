// How much of each polygon's sky emitters fill.
#include "engine/transport/emission_by_rows.h"

#include "engine/base/parallel.h"
#include "engine/base/union_find.h"
#include "engine/mesh/cell.h"

#include <algorithm>

namespace patchlight {
namespace {

// Above this mean share of its sky a polygon leaves emitters to its rows: closed rooms in which all emits
// come out exact then.
constexpr double kEmitterSkyMax = 0.8;
// Bright ones that fill no more of it are aimed at all the same: rows would meet them by chance.
constexpr double kSpotSkyMax = 0.1;

}  // namespace

std::vector<float> find_emission_by_rows(const Surfaces& surfaces, const EmitterGroups& groups,
                                         const PatchTable& patches, const ReceiverTable& receivers) {
  const FaceTable& faces = surfaces.faces;
  const size_t count = faces.size() ? faces.polygon.back() + 1 : 0;
  UnionFind sets(count);
  for (size_t r = 0; r < receivers.size(); ++r)
    for (uint32_t k = receivers.first[r] + 1; k < receivers.first[r + 1]; ++k)
      sets.join(faces.polygon[patches.face[receivers.patch[k - 1]]],
                faces.polygon[patches.face[receivers.patch[k]]]);
  std::vector<std::vector<uint32_t>> rows(count);
  for (uint32_t row = 0; row < patches.size(); ++row)
    rows[sets.find(faces.polygon[patches.face[row]])].push_back(row);
  std::vector<float> by_rows(count, 0);
  const size_t probes = std::clamp(65536 / std::max(groups.pieces.size(), size_t{1}), size_t{4}, size_t{64});
  for_rows(count, 4, [&](size_t begin, size_t end) {
    std::vector<double> sky(groups.lamp_group_count());  // of a polygon, times area: a row a group
    for (size_t polygon = begin; polygon < end; ++polygon) {
      std::fill(sky.begin(), sky.end(), 0.0);
      double all = 0, area = 0;
      const size_t step = std::max(rows[polygon].size() / probes, size_t{1});
      for (size_t k = 0; k < rows[polygon].size(); k += step) {
        const uint32_t row = rows[polygon][k], face = patches.face[row];
        const double exposed = patches.area[row] * patches.exposed[row];
        const Vec3 centre = cell_centre(surfaces.frames, face, patches.cell[row], patches.level[row]);
        area += exposed;
        for (size_t g = 0; g < sky.size(); ++g)
          for (uint32_t piece = groups.piece_first[g]; piece < groups.piece_first[g + 1]; ++piece)
            if (groups.pieces[piece].face != face)
              sky[g] += exposed * find_point_factor(centre, faces.normal[face], groups.pieces[piece]);
      }
      for (const double share : sky) all += share;
      if (all <= kEmitterSkyMax * area) continue;
      // Groups as bright as one another stand side by side, the brightest first.
      double alike = 0;
      for (size_t g = 0; g < sky.size(); ++g) {
        alike = g > 0 && groups.brightest[g] == groups.brightest[g - 1] ? alike + sky[g] : sky[g];
        if (alike <= kSpotSkyMax * area) continue;
        by_rows[polygon] = groups.brightest[g];
        break;
      }
    }
  });
  for (uint32_t polygon = 0; polygon < count; ++polygon) by_rows[polygon] = by_rows[sets.find(polygon)];
  return by_rows;
}

}  // namespace patchlight
