// Form-factor rows by ray casting: from each patch a fixed set of rays with cosine density, and where they
// end.
//
// The share of a row's rays that end on patch j estimates F_ij; rays that leave the scene stay in the count,
// so a row is never scaled to sum to 1 (Malley: A Shading Method for Computer Generated Images, 1988).
#pragma once

#include "quadtree.h"
#include "sampling.h"
#include "tracer.h"

namespace patchlight {

// What the samples of a row are for: rows of different purposes are unrelated.
enum RowPurpose : uint32_t {
  kRowProbe = 1,
  kRowHits,
  kRowDirect,
  kRowAimed,
  kRowAimedProbe,
  kRowEmission,
  kRowShare,
  kRowLeaks
};

// Directions of a row: columns x rows strata of the unit square, 4 x 4 of which go into one packet. Origins
// take the strata of the other axis, permuted by a lattice: stratum k goes with k * step modulo their number.
struct RowGrid {
  uint32_t columns = 4, rows = 4;  // both multiples of 4
  uint32_t column_step = 1, row_step = 1;
  uint32_t packet_count() const { return columns * rows / 16; }
  uint32_t ray_count() const { return columns * rows; }
};
RowGrid make_row_grid(uint32_t rays);

// Rays `packet` (of grid.packet_count()) of the row of a cell: origins spread over the cell, just off its
// face.
void make_row_packet(HitPacket& rays, const FaceFrameTable& frames, const Frame& frame, uint32_t face,
                     uint32_t cell, uint32_t level, uint64_t row_key, RowGrid grid, uint32_t packet);

// Of the rays' origins (points just off the face with this frame), those that lie inside a solid: from there
// only back sides are seen, along the normal and in six directions about it.
uint32_t find_buried(const Tracer& tracer, const FaceTable& faces, const Frame& frame, const RayPacket& rays,
                     uint32_t active);

// Where a ray of a receiver starts, and the normal there: a point of the unit square, uniform in the area.
struct Origin {
  Vec3 point, normal;
};
Origin find_origin(const ReceiverTable& receivers, uint32_t receiver, const PatchTable& patches,
                   const FaceTable& faces, const FaceFrameTable& frames, Vec2 sample);

struct RowSettings {
  uint32_t rays = 256;  // rays a row; more: less noise, more time
  uint64_t seed = 1;
  bool keep = true;  // false: only the counts of each row are kept, and rows are cast again when asked for
};

// Casts the rows of the receivers `which`; others are not touched. Returns the number of rays cast and writes
// the exposed share of their patches.
uint64_t cast_rows(HitTable& hits, PatchTable& patches, std::span<const uint32_t> which,
                   const LeafIndex& index, const ReceiverTable& receivers, const FaceTable& faces,
                   const FaceFrameTable& frames, const Tracer& tracer, const RowSettings& settings);

// After patches were split: row k of the result is row row_before[k] of what was (kNone: still to be cast),
// and hits name the patches as they are now. before: the patches as they were; parent: a row a patch as they
// are now, the one before.
void move_rows(HitTable& hits, std::span<const uint32_t> row_before, const PatchTable& before,
               std::span<const uint32_t> parent);

// The rows of all receivers, kept or not: what a gather reads.
struct Rows {
  const HitTable& hits;
  const LeafIndex& index;  // of the patches
  const ReceiverTable& receivers;
  const PatchTable& patches;
  const FaceTable& faces;
  const FaceFrameTable& frames;
  const Tracer& tracer;
  RowGrid grid;
  uint64_t seed;
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
RowHits find_row(RowScratch& scratch, const Rows& rows, size_t receiver);

}  // namespace patchlight
