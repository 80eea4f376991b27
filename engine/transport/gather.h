// One bounce: what each patch receives, from the rays of its row and from rays aimed at bright places.
#pragma once

#include "engine/transport/rows.h"

#include <span>

namespace patchlight {

// Irradiance of each patch (W/m2, mean over the exposed area of its receiver) from the emission that the row
// meets and that is not aimed at. irradiance: a row a patch, overwritten.
void gather_emission(std::span<Rgb> irradiance, const Rows& rows, std::span<const uint8_t> aiming);

// Irradiance of each patch from what `sent` (a row a patch, W/m2) says the patches send. difference: half the
// difference of two independent halves of each row's rays, an estimate of the standard error; empty: not
// wanted.
void gather_patches(std::span<Rgb> irradiance, std::span<Rgb> difference, const Rows& rows,
                    std::span<const Rgb> sent);

struct Elements {
  const PatchTable& table;
  std::span<const uint32_t> first;  // CSR: patch -> its elements
};

// Irradiance of each patch from what the elements send (a row an element, W/m2): its row's rays and a
// quarter as many aimed at the sources, joined by multiple importance sampling with the power heuristic
// (Veach, Guibas: Optimally Combining Sampling Techniques for Monte Carlo Rendering, 1995). Nothing is
// counted twice, and rows carry what no source covers. Returns the number of rays.
uint64_t gather_elements(std::span<Rgb> irradiance, const Rows& rows, const Elements& elements,
                         std::span<const Rgb> sent, const SourceTable& sources);

}  // namespace patchlight
