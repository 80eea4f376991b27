// Direct light on elements from the lamps that their polygon aims at: Lambert's formula times a ratio
// estimate of visibility.
#pragma once

#include "engine/mesh/mesh.h"
#include "engine/mesh/surfaces.h"

#include <span>

namespace patchlight {

// The exposed share of those elements `rows` whose patch is partly buried, from 16 points each; that of the
// patch elsewhere. Returns the number of points.
uint64_t find_exposed(Mesh& mesh, std::span<const uint32_t> rows, const Surfaces& surfaces, uint64_t seed);

struct DirectColumns {
  std::span<Rgb> irradiance;  // a row an element, W/m2: mean over its exposed area
  std::span<float>
      error;  // a row an element: standard error of its luminance, W/m2; 0 where no shadow edge lies
  LampViewTable& views;  // in: what is settled; out: what was seen
};

// Who looks at which lamps.
struct DirectScene {
  const Surfaces& surfaces;
  const PatchTable& elements;
  const LightListTable& lists;
};

// Rays for an element and a lamp: `unmixed` while they agree, up to `mixed` where some reach the lamp and
// some do not.
struct DirectRays {
  uint32_t unmixed = 16, mixed = 64;
};

// Direct light of the elements `rows`; others are not touched. No rays where a lamp is settled. Returns the
// number of rays.
uint64_t find_direct(DirectColumns out, std::span<const uint32_t> rows, const DirectScene& scene,
                     DirectRays rays, uint64_t seed);

// Settles lamps for an element that is about to be split: those that it and all its neighbours see whole, or
// not at all.
uint64_t find_settled(const LampViewTable& views, const PatchTable& elements, const FaceFrameTable& frames,
                      const FaceLinkTable& links, uint32_t row);

}  // namespace patchlight
