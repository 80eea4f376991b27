// Form-factor rows by ray casting: from each receiver a fixed set of rays with cosine density, and where they
// end.
//
// The share of a row's rays that end on patch j estimates F_ij; rays that leave the scene stay in the count,
// so a row is never scaled to sum to 1 (Malley: A Shading Method for Computer Generated Images, 1988).
#pragma once

#include "engine/mesh/cell_rays.h"
#include "engine/mesh/quadtree.h"
#include "engine/mesh/surfaces.h"

namespace patchlight {

// Who casts rows, and at what.
struct Casters {
  const Surfaces& surfaces;
  const PatchTable& patches;
  const LeafIndex& index;  // of the patches
  const ReceiverTable& receivers;
  RayGrid grid;
  uint64_t seed = 1;
};

// Where a ray of a receiver starts, and the normal there: a point of the unit square, uniform in the area.
struct Origin {
  Vec3 point, normal;
};
Origin find_origin(const Casters& from, uint32_t receiver, Vec2 sample);

// Casts the rows of the receivers `which`; others are not touched. Returns the number of rays cast and writes
// the exposed share of their patches (a row a patch). keep: false: only the counts of each row are kept, and
// rows are cast again when asked for.
uint64_t cast_rows(HitTable& hits, std::span<float> exposed, std::span<const uint32_t> which,
                   const Casters& from, bool keep);

// After patches were split: row k of the result is row row_before[k] of what was (kNone: still to be cast),
// and hits name the patches as they are now. before: the patches as they were; parent: a row a patch as they
// are now, the one before.
void move_rows(HitTable& hits, std::span<const uint32_t> row_before, const PatchTable& before,
               std::span<const uint32_t> parent);

// The rows of all receivers, kept or not: what a gather reads.
struct Rows {
  Casters by;
  const HitTable& hits;
};

// One row: the columns of HitTable for one receiver.
struct RowHits {
  std::span<const uint32_t> patch, cell;
};
struct RowScratch {
  std::vector<uint32_t> patch, cell;
};
// The row of a receiver: out of the table, or cast once more into `scratch`, with the same rays and so the
// same hits. Valid until the next call with this scratch.
RowHits find_row(RowScratch& scratch, const Rows& rows, uint32_t receiver);

}  // namespace patchlight
