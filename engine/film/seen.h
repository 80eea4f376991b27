// Points of a picture to the elements that are seen there.
#pragma once

#include "engine/film/lens.h"
#include "engine/mesh/surfaces.h"

namespace patchlight {

// Sixteen samples of a picture: the element seen, where on its face, and how far along the ray; kNone:
// nothing.
struct Seen {
  uint32_t element[kPacketSize];
  float u[kPacketSize], v[kPacketSize];
  float distance[kPacketSize];  // lengths
  uint32_t left;                // those that met nothing and left the scene: a bit a sample
};

// What is looked at, and how.
struct Prospect {
  Lens lens;
  const Surfaces& surfaces;
  const PatchTable& elements;
};

// What the rays through the points `at` meet, in pixels from the top left. Looks through back sides, except
// where the projection hides what is behind them. `guess` is an element that may be seen, or kNone; it
// becomes one that is. It changes nothing but the time. Returns the number of rays.
uint64_t find_seen(Seen& seen, uint32_t& guess, const Vec2 (&at)[kPacketSize], const Prospect& prospect);

}  // namespace patchlight
