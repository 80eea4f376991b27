// Faces that emit, or cells that shoot, and how much of a point's sky they fill.
#pragma once

#include "engine/light/sky_pieces.h"
#include "engine/mesh/cell.h"
#include "engine/trace/tracer.h"

#include <span>
#include <vector>

namespace patchlight {

inline constexpr float kGauss[2] = {0.21132487f, 0.78867513f};  // Gauss's points of [0, 1] for two

// A planar piece of a face that sends light: the whole face, or a cell of it.
struct Emitter {
  uint32_t face;
  CellFrame cell;  // its place on the face
  uint64_t key;    // of the samples on it
  Vec3 centre, normal;
  std::array<Vec3, 4> corners;
  uint32_t corner_count;
  float area, diameter;
  Vec2 twist;  // of the bilinear map in the basis of its edges: the Jacobian is 1 + v x + u y
  // Points of a rule that is exact to the third degree, and their areas.
  std::array<Vec3, 4> gauss;
  std::array<float, 4> gauss_area;
};

Emitter make_emitter(const FaceTable& faces, const FaceFrameTable& frames, const CellName& name);

// What a ray to a piece of a lamp needs, side by side. The piece's point (s, t) of the unit square, or of the
// triangle below its diagonal: origin + s edge_u + t edge_v + s t twist.
struct PieceFrame {
  Vec3 origin, edge_u, edge_v, twist, normal;
  Vec3 jacobian;   // times (1, s, t): the area at (s, t) over that of a flat map
  float strength;  // area times emission (lengths squared times W/m2, luminance)
  float triangle;  // 1 or 0
};

constexpr size_t kGroupPiecesMax = 64;  // as many as fit a 64-bit mask

// Emitters in groups of pieces that a receiver looks at as one: the facets of a bulb, the lamps of a ceiling,
// cells of the sky, the sun. Pieces of a group are side by side and sorted by place. Groups of the sky come
// last: their pieces are rows of `sky`.
struct EmitterGroups {
  std::vector<Emitter> pieces;
  std::vector<Rgb> emission;          // a row a piece, W/m2
  std::vector<uint32_t> piece_first;  // CSR: group -> its pieces, at most kGroupPiecesMax of them
  // A row a group of lamps, falling: what pieces as bright as these emit at most (W/m2, luminance).
  std::vector<float> brightest;
  // The pieces once more, as columns for loops over lanes.
  std::vector<float> x, y, z;                       // lengths: centres
  std::vector<float> normal_x, normal_y, normal_z;  // times area and luminance over pi
  std::vector<float> diameter_squared;              // lengths squared
  std::vector<PieceFrame> frames;
  // The pieces of each face by their cells: CSR, face -> rows of pieces; and a row a piece: its cell, its
  // group.
  std::vector<uint32_t> face_first, of_face, cell, group_of;
  // A row a piece, those of the sky included: itself and those of its group next to it.
  std::vector<uint64_t> beside;
  SkyPieces sky;
  uint32_t sky_group_count = 0;
  size_t lamp_group_count() const { return size() - sky_group_count; }
  bool is_sky(size_t group) const { return group >= lamp_group_count(); }
  // The row of `sky` of the first piece of a group of the sky.
  uint32_t sky_first(size_t group) const { return piece_first[group] - static_cast<uint32_t>(pieces.size()); }
  bool is_sky_cells(size_t group) const { return is_sky(group) && !is_sun(group); }  // not the sun
  bool is_sun(size_t group) const { return is_sky(group) && sky.is_sun(sky_first(group)); }
  size_t size() const { return piece_first.empty() ? 0 : piece_first.size() - 1; }
  uint32_t piece_count(size_t group) const { return piece_first[group + 1] - piece_first[group]; }
  uint64_t all_pieces(size_t group) const { return ~uint64_t{0} >> (kGroupPiecesMax - piece_count(group)); }
};
// The piece of a lamp's face that holds a cell of level kLevelMax; kNone: there is none.
uint32_t find_piece(const EmitterGroups& groups, uint32_t face, uint32_t cell);

// All faces that emit. Those that look wide from the surfaces that reflect are cut into cells.
EmitterGroups make_emitter_groups(const FaceTable& faces, const FaceFrameTable& frames, const Sky& sky = {},
                                  SkyDetail detail = SkyDetail::kCoarse);

// What each piece of a group of lamps would bring to a point if nothing were in its way, from its centre
// (W/m2, luminance): written to strength[0 .. piece_count). Returns the sum.
float find_strengths(std::span<float, kGroupPiecesMax> strength, const EmitterGroups& groups, size_t group,
                     Vec3 point, Vec3 normal);

// Turns rays from where they start to points of the pieces `piece`, one a ray, and ends them just before
// these. u, v: samples of the unit square, uniform. sent: what a point of the piece sends along the ray, over
// the density of the sample: cosine, times length of the way, times strength; 0 from behind.
void aim_at_pieces(RayPacket& rays, std::span<float, kPacketSize> sent, const EmitterGroups& groups,
                   std::span<const uint32_t, kPacketSize> piece, std::span<const float, kPacketSize> u,
                   std::span<const float, kPacketSize> v);

// The unoccluded form factor from a point to the emitter.
float find_point_factor(Vec3 point, Vec3 normal, const Emitter& emitter);

// Can any point of the patch be lit by the emitter at all, blockers aside?
bool can_reach(const std::array<Vec3, 4>& patch, Vec3 normal, const Emitter& emitter);

}  // namespace patchlight
