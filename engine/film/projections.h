// How all directions before an eye are laid out on a picture: one row a projection.
#pragma once

#include "engine/base/vector.h"

#include <span>
#include <string_view>

namespace patchlight {

struct Lens;
struct View;

struct Projection {
  std::string_view name;
  bool is_flat;      // a point x, y (-1..1, right and up) looks along forward + x right + y up
  bool hides_backs;  // it sees as a patch does: back sides hide what is behind them; others look through them
  // Half the width and height of the picture at distance 1; 1, 1 where that has no meaning.
  Vec2 (*find_half_size)(const View& view);
  bool (*covers)(const Lens& lens, Vec2 at);          // pixels from the top left
  Vec3 (*find_direction)(const Lens& lens, Vec2 at);  // unit, through a point that it covers
  // Where it shows what lies at `p`, right and up in half sizes, in the plane at distance 1.
  Vec2 (*find_place)(const Lens& lens, Vec2 p);
};

// The usual one first.
std::span<const Projection> projections();
// Null where none has that name.
const Projection* find_projection(std::string_view name);

}  // namespace patchlight
