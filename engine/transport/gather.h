// One bounce: what each patch receives, from the rays of its row and from rays aimed at bright places.
#pragma once

#include "engine/transport/rows.h"

#include <span>

namespace patchlight {

// Irradiance of each patch (W/m2, mean over the exposed area of its receiver) from the emission that the row
// meets and that is not aimed at (emission_by_rows.h). irradiance: a row a patch, overwritten.
//
// noise, here and below: half the difference of what two independent halves of the rays give, a sample of the
// error; a row a patch, overwritten; empty: not wanted.
void gather_emission(std::span<Rgb> irradiance, std::span<Rgb> noise, const Rows& rows,
                     std::span<const float> emission_by_rows);

// Irradiance of each patch from what `sent` (a row a patch, W/m2) says the patches send.
void gather_patches(std::span<Rgb> irradiance, std::span<Rgb> noise, const Rows& rows,
                    std::span<const Rgb> sent);

struct Elements {
  const PatchTable& table;
  std::span<const uint32_t> first;  // CSR: patch -> its elements
};

// Irradiance of each patch from what the elements send (a row an element, W/m2): its row's rays and a
// quarter as many aimed at the sources, joined by multiple importance sampling with the power heuristic
// (Veach, Guibas: Optimally Combining Sampling Techniques for Monte Carlo Rendering, 1995). Nothing is
// counted twice, and rows carry what no source covers. asked: a row a receiver, 0: passed over, its patches
// keep what they have; empty: all are asked for. Returns the number of aimed rays.
uint64_t gather_elements(std::span<Rgb> irradiance, std::span<Rgb> noise, const Rows& rows,
                         const Elements& elements, std::span<const Rgb> sent, const SourceTable& sources,
                         std::span<const uint8_t> asked = {});

}  // namespace patchlight
