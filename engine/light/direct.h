// Direct light on elements from the emitters that their receivers see: Lambert's formula times a ratio
// estimate of visibility.
#pragma once

#include "engine/light/emitters.h"
#include "engine/mesh/mesh.h"
#include "engine/mesh/surfaces.h"

#include <span>

namespace patchlight {

// The exposed share of those elements `rows` whose patch is partly buried, from 16 points each; that of the
// patch elsewhere. Returns the number of points.
uint64_t find_exposed(Mesh& mesh, std::span<const uint32_t> rows, const Surfaces& surfaces, uint64_t seed);

struct DirectColumns {
  std::span<Rgb> irradiance;  // a row an element, W/m2: mean over its exposed area
  std::span<float> error;     // a row an element: standard error of its luminance, W/m2
  std::span<float> noise;  // a row an element: half the difference of two halves of its rays, channels' mean
};

// Who looks at which emitters.
struct DirectScene {
  const Surfaces& surfaces;
  const Mesh& mesh;
  const ReceiverTable& receivers;
  const EmitterGroups& groups;
  const SightTable& sights;
};

// Rays for an element and a group of emitters: `unmixed` while they agree, up to `mixed` where some arrive
// and some do not; twice `mixed` for all groups together, shared out by what each leaves in doubt. sure: also
// where they agree: of an emitter of which little is seen, the first rays may have found nothing, and an
// estimate that ends there is too low on average.
struct DirectRays {
  uint32_t unmixed = 16, mixed = 64;
  bool sure = false;
};

// Direct light of the elements `rows`; others are not touched. No rays where a group is in clear sight.
// Returns the number of rays.
uint64_t find_direct(DirectColumns out, std::span<const uint32_t> rows, const DirectScene& scene,
                     DirectRays rays, uint64_t seed);

}  // namespace patchlight
