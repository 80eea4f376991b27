// Triangles on the unit sphere: how much of it they fill, and directions that are even over them.
#pragma once

#include "engine/base/vector.h"

namespace patchlight {

// Below so many steradians the formulas lose digits, and even in the area is even enough.
constexpr double kSmallSolidAngle = 1e-3;

// The solid angle of a triangle whose corners are in these unit directions (Van Oosterom, Strackee: The Solid
// Angle of a Plane Triangle, 1983).
inline double find_solid_angle(DVec3 a, DVec3 b, DVec3 c) {
  return 2 * std::atan2(std::abs(dot(a, cross(b, c))), 1 + dot(a, b) + dot(b, c) + dot(c, a));
}

// The unit part of p across the unit vector a.
inline DVec3 find_unit_across(DVec3 p, DVec3 a) {
  const DVec3 across = p - dot(p, a) * a;
  const double size = length(across);
  return size > 0 ? across / size : DVec3(0);
}

// A unit direction, even in the solid angle of the triangle, from a point (u, v) of the unit square (Arvo:
// Stratified Sampling of Spherical Triangles, 1995).
inline DVec3 sample_spherical_triangle(DVec3 a, DVec3 b, DVec3 c, double solid_angle, double u, double v) {
  const DVec3 to_b = find_unit_across(b, a), to_c = find_unit_across(c, a);
  const double cosine = std::clamp(dot(to_b, to_c), -1.0, 1.0), sine = std::sqrt(1 - cosine * cosine);
  const double angle = std::acos(cosine);  // of the triangle at a
  const double s = std::sin(u * solid_angle - angle), t = std::cos(u * solid_angle - angle);
  const double along = t - cosine, up = s + sine * dot(a, b);
  // The corner c moves towards a until the triangle has the wanted share.
  const double below = (up * s + along * t) * sine;
  const double q = below != 0 ? std::clamp(((up * t - along * s) * cosine - up) / below, -1.0, 1.0) : 1.0;
  const DVec3 moved = q * a + std::sqrt(1 - q * q) * to_c;
  const double z = 1 - v * (1 - dot(moved, b));
  return z * b + std::sqrt(std::max(1 - z * z, 0.0)) * find_unit_across(moved, b);
}

}  // namespace patchlight
