// The exact form factor from a point to a polygon, unoccluded.
#pragma once

#include "engine/base/vector.h"

#include <span>

namespace patchlight {

// Fraction of the cosine-weighted hemisphere about `normal` at `point` that a planar polygon (3 or 4 corners,
// counter-clockwise from its lit side) fills with that side; what lies below the horizon is cut off. 0..1,
// absolute error about 1e-12 of the corners as given.
//
// Lambert: Photometria, 1760; as in Baum, Rushmeier, Winget: Improving Radiosity Solutions Through the Use of
// Analytically Determined Form-Factors, 1989, with atan2 in place of acos.
double find_point_form_factor(DVec3 point, DVec3 normal, std::span<const Vec3> corners);

}  // namespace patchlight
