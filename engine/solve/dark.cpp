// Looks of receivers at emitters to the emitters that none saw.
#include "engine/solve/dark.h"

#include "engine/solve/solution.h"

#include <algorithm>
#include <array>
#include <bit>

namespace patchlight {

std::vector<uint8_t> find_reaching(const Solution& s) {
  const FaceTable& faces = s.surfaces->faces;
  const Transport& transport = s.transport;
  std::vector<uint8_t> reaching(faces.size() ? faces.polygon.back() + 1 : 0, 0);
  const auto add = [&](uint32_t face) {
    if (largest(faces.emission[face]) > 0) reaching[faces.polygon[face]] = 1;
  };
  // Receivers that aim know which pieces they may see, and some beside those, which may face the other way;
  // the rows of the others find what emits.
  const EmitterGroups& groups = transport.groups;
  std::array<float, kGroupPiecesMax> strength;
  for (uint32_t r = 0; r < transport.receivers.size(); ++r)
    for (uint32_t k = transport.sights.first[r]; k < transport.sights.first[r + 1]; ++k) {
      const uint32_t group = transport.sights.group[k];
      if (groups.is_sky(group)) continue;
      find_strengths(strength, groups, group, transport.receivers.centre[r], transport.receivers.normal[r]);
      for (uint64_t rest = transport.sights.pieces[k]; rest != 0; rest &= rest - 1) {
        const auto piece = static_cast<uint32_t>(std::countr_zero(rest));
        if (strength[piece] > 0) add(groups.pieces[groups.piece_first[group] + piece].face);
      }
    }
  const Rows rows = get_rows(s);
  RowScratch scratch;
  for (uint32_t r = 0; r < transport.receivers.size(); ++r) {
    const uint32_t patch = transport.receivers.patch[transport.receivers.first[r]];
    const float by_rows = transport.emission_by_rows[faces.polygon[s.mesh.patches.face[patch]]];
    if (by_rows == 0) continue;
    for (const uint32_t hit : find_row(scratch, rows, r).patch)
      if (hit < s.mesh.patches.size() && luminance(faces.emission[s.mesh.patches.face[hit]]) <= by_rows)
        add(s.mesh.patches.face[hit]);
  }
  return reaching;
}

}  // namespace patchlight
