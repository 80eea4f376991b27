// Direct light on elements from the lamps that their polygon aims at: Lambert's formula times a ratio
// estimate of visibility.
#pragma once

#include "quadtree.h"
#include "tracer.h"

#include <span>

namespace patchlight {

// The exposed share of those elements of `rows` whose patch is partly buried, from 16 points each; 1 or 0
// elsewhere.
uint64_t find_exposed(PatchTable& elements, std::span<const uint32_t> rows,
                      std::span<const uint32_t> element_patch, const PatchTable& patches,
                      const FaceTable& faces, const FaceFrameTable& frames, const Tracer& tracer,
                      uint64_t seed);

struct DirectColumns {
  std::span<Rgb> irradiance;  // a row an element, W/m2: mean over its exposed area
  std::span<float>
      error;  // a row an element: standard error of its luminance, W/m2; 0 where no shadow edge lies
  LampViewTable& views;  // in: what is settled; out: what was seen
};

// Rays for an element and a lamp: `unmixed` while they agree, up to `mixed` where some reach the lamp and
// some do not.
struct DirectRays {
  uint32_t unmixed = 16, mixed = 64;
};

// Direct light of the elements `rows`; others are not touched. No rays where a lamp is settled. Returns the
// number of rays.
uint64_t find_direct(DirectColumns out, std::span<const uint32_t> rows, const PatchTable& elements,
                     const AimTable& aims, const FaceTable& faces, const FaceFrameTable& frames,
                     const Tracer& tracer, DirectRays rays, uint64_t seed);

// Settles lamps for an element that is about to be split: those that it and all its neighbours see whole, or
// not at all.
uint64_t find_settled(const LampViewTable& views, const PatchTable& elements, const FaceFrameTable& frames,
                      const FaceLinkTable& links, uint32_t row);

}  // namespace patchlight
