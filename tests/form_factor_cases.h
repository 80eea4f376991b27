// Form factors of polygon pairs with known answers: what all tests of form factors are measured by.
#pragma once

#include "engine/base/vector.h"

#include <string>
#include <vector>

namespace patchlight {

using Corners = std::vector<Vec3>;

struct KnownPair {
  std::string name;
  Corners a, b;
  std::vector<Corners> blockers;  // opaque from both sides
  double factor_ab;               // closed form or adaptive cubature, to 1e-10 or better
};

inline const Corners kSquare = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
inline const Corners kAbove = {{0, 1, 1}, {1, 1, 1}, {1, 0, 1}, {0, 0, 1}};
inline const Corners kWall = {{0, 0, 0}, {0, 1, 0}, {0, 1, 1}, {0, 0, 1}};
inline const Corners kShifted = {{1.5f, 2, 1}, {3, 2, 1}, {3, 0.5f, 1}, {1.5f, 0.5f, 1}};
inline const std::vector<Corners> kBox = {
    {{0.3f, 0.7f, 0.2f}, {0.7f, 0.7f, 0.2f}, {0.7f, 0.3f, 0.2f}, {0.3f, 0.3f, 0.2f}},
    {{0.3f, 0.3f, 0.6f}, {0.7f, 0.3f, 0.6f}, {0.7f, 0.7f, 0.6f}, {0.3f, 0.7f, 0.6f}},
    {{0.3f, 0.3f, 0.6f}, {0.3f, 0.7f, 0.6f}, {0.3f, 0.7f, 0.2f}, {0.3f, 0.3f, 0.2f}},
    {{0.7f, 0.3f, 0.2f}, {0.7f, 0.7f, 0.2f}, {0.7f, 0.7f, 0.6f}, {0.7f, 0.3f, 0.6f}},
    {{0.7f, 0.3f, 0.2f}, {0.7f, 0.3f, 0.6f}, {0.3f, 0.3f, 0.6f}, {0.3f, 0.3f, 0.2f}},
    {{0.3f, 0.7f, 0.2f}, {0.3f, 0.7f, 0.6f}, {0.7f, 0.7f, 0.6f}, {0.7f, 0.7f, 0.2f}}};

// Squares that cover a quarter of the plane half way up: this tile and its three reflections fill the plane,
// so three quarters of the light pass.
inline std::vector<Corners> make_grille() {
  std::vector<Corners> grille;
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < 4; ++j) {
      const float x = 0.25f * static_cast<float>(i), y = 0.25f * static_cast<float>(j), s = 0.125f;
      grille.push_back({{x, y, 0.5f}, {x + s, y, 0.5f}, {x + s, y + s, 0.5f}, {x, y + s, 0.5f}});
    }
  return grille;
}

// Howell: A Catalog of Radiation Heat Transfer Configuration Factors (C-11, C-13, C-14, C-15, C-16), and
// cubature.
inline const std::vector<KnownPair> kFreePairs = {
    {"cube opposite", kSquare, kAbove, {}, 0.199824895698},
    {"perp l1 w2 h3",
     {{0, 0, 0}, {2, 0, 0}, {2, 1, 0}, {0, 1, 0}},
     {{0, 0, 0}, {0, 1, 0}, {0, 1, 3}, {0, 0, 3}},
     {},
     0.161694014333},
    {"inclined 30deg",
     kSquare,
     {{0, 0, 0}, {0, 1, 0}, {0.866025403784f, 1, 0.5f}, {0.866025403784f, 0, 0.5f}},
     {},
     0.619028323091},
    {"parallel offset", kSquare, kShifted, {}, 0.045789782528},
    {"perp vertex contact", kSquare, {{0, 1, 0}, {0, 2, 0}, {0, 2, 1}, {0, 1, 1}}, {}, 0.040592230102},
    {"triangles shared edge 45",
     {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}},
     {{1, 0, 0}, {0, 0, 0}, {0, 1, 1}},
     {},
     0.547488856887},
    {"horizon straddle both",
     {{0, 0, 0}, {2, 0, 0}, {2, 1, 0}, {0, 1, 0}},
     {{1, 1, -1}, {1, 0, -1}, {2.5f, 0, 1}, {2.5f, 1, 1}},
     {},
     0.04183305537},
    {"cube adjacent", kSquare, kWall, {}, 0.200043776075},
    {"parallel gap0.1",
     kSquare,
     {{0, 1, 0.1f}, {1, 1, 0.1f}, {1, 0, 0.1f}, {0, 0, 0.1f}},
     {},
     0.826994522397},
    {"parallel gap10", kSquare, {{0, 1, 10}, {1, 1, 10}, {1, 0, 10}, {0, 0, 10}}, {}, 0.003162056839},
    {"inclined 150deg",
     kSquare,
     {{0, 0, 0}, {0, 1, 0}, {-0.866025403784f, 1, 0.5f}, {-0.866025403784f, 0, 0.5f}},
     {},
     0.021345325412},
    {"parallel offset far",
     kSquare,
     {{5, 4, 0.5f}, {6, 4, 0.5f}, {6, 3, 0.5f}, {5, 3, 0.5f}},
     {},
     7.0559938e-05},
    {"triangles shared edge 90",
     {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}},
     {{0, 0, 0}, {0, 0, 1}, {1, 0, 0}},
     {},
     0.211324865404},
    {"horizon straddle", kSquare, {{2, 0, 1}, {2, 1, 1}, {2, 1, -1}, {2, 0, -1}}, {}, 0.03280882672},
    {"back facing", kSquare, {{0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}}, {}, 0.0},
    {"small under large",
     {{-0.05f, -0.05f, 0}, {0.05f, -0.05f, 0}, {0.05f, 0.05f, 0}, {-0.05f, 0.05f, 0}},
     {{-1, 1, 1}, {1, 1, 1}, {1, -1, 1}, {-1, -1, 1}},
     {},
     0.553761668182},
};

// With blockers: halves and quarters by symmetry, two of View3D's examples, and cubature over clipped
// polygons.
inline const std::vector<KnownPair> kBlockedPairs = {
    {"view3d quarter",
     kSquare,
     kAbove,
     {{{0, 0, 0.5f}, {0.5f, 0, 0.5f}, {0.5f, 0.5f, 0.5f}, {0, 0.5f, 0.5f}}},
     0.149868671774},
    {"slit",
     kSquare,
     kAbove,
     {{{-2, -2, 0.5f}, {0.45f, -2, 0.5f}, {0.45f, 3, 0.5f}, {-2, 3, 0.5f}},
      {{0.55f, -2, 0.5f}, {3, -2, 0.5f}, {3, 3, 0.5f}, {0.55f, 3, 0.5f}}},
     0.032380784516},
    {"two overlapping",
     kSquare,
     kAbove,
     {{{0.1f, 0.1f, 0.3f}, {0.6f, 0.1f, 0.3f}, {0.6f, 0.6f, 0.3f}, {0.1f, 0.6f, 0.3f}},
      {{0.3f, 0.3f, 0.6f}, {0.9f, 0.3f, 0.6f}, {0.9f, 0.9f, 0.6f}, {0.3f, 0.9f, 0.6f}}},
     0.045502972551},
    {"perp free",
     kSquare,
     kWall,
     {{{0.1f, 0.2f, 0.3f}, {0.6f, 0.2f, 0.3f}, {0.6f, 0.7f, 0.3f}, {0.1f, 0.7f, 0.3f}}},
     0.157799950691},
    {"lroom 6 3",
     {{0, 0, 0}, {0, 3, 0}, {0, 3, 3}, {0, 0, 3}},
     {{3, 1, 0}, {3, 1, 3}, {1, 1, 3}, {1, 1, 0}},
     {{{1, 1, 3}, {1, 3, 3}, {1, 3, 0}, {1, 1, 0}}},
     0.027473405714},
    {"half screen",
     kSquare,
     kAbove,
     {{{-2, -2, 0.5f}, {0.5f, -2, 0.5f}, {0.5f, 3, 0.5f}, {-2, 3, 0.5f}}},
     0.099912447849},
    {"partition full",
     kSquare,
     kAbove,
     {{{0.5f, -1, 0}, {0.5f, 2, 0}, {0.5f, 2, 1}, {0.5f, -1, 1}}},
     0.116653691804},
    {"perp",
     kSquare,
     kWall,
     {{{0.4f, 0.2f, 0}, {0.4f, 0.8f, 0}, {0, 0.8f, 0.4f}, {0, 0.2f, 0.4f}}},
     0.159393243087},
    {"lroom 1 6",
     {{0, 0, 0}, {0, 0, 3}, {3, 0, 3}, {3, 0, 0}},
     {{0, 0, 0}, {0, 3, 0}, {0, 3, 3}, {0, 0, 3}},
     {{{3, 1, 0}, {3, 1, 3}, {1, 1, 3}, {1, 1, 0}}, {{1, 1, 3}, {1, 3, 3}, {1, 3, 0}, {1, 1, 0}}},
     0.182355903669},
    {"box", kSquare, kAbove, kBox, 0.107301853899},
    {"grille16", kSquare, kAbove, make_grille(), 0.149868671774},
    {"box wall", kSquare, {{1, 0, 1}, {1, 1, 1}, {1, 1, 0}, {1, 0, 0}}, kBox, 0.173065690214},
    {"near contact",
     kSquare,
     kAbove,
     {{{0.25f, 0.75f, 0.999f}, {0.75f, 0.75f, 0.999f}, {0.75f, 0.25f, 0.999f}, {0.25f, 0.25f, 0.999f}}},
     0.142626256296},
    {"offset rects",
     kSquare,
     kShifted,
     {{{1.2f, -1, 0}, {1.2f, 3, 0}, {1.2f, 3, 0.6f}, {1.2f, -1, 0.6f}}},
     0.007507441318},
};

// A regular polygon of 64 corners around the z axis, counter-clockwise seen from above, or from
// below.
inline Corners make_disc(float height, bool from_above) {
  Corners corners;
  for (int k = 0; k < 64; ++k) {
    const double angle = (from_above ? k : -k) * std::numbers::pi / 32;
    corners.push_back(Vec3(DVec3(std::cos(angle), std::sin(angle), height)));
  }
  return corners;
}

// A kernel that is nearly singular, slender plates, and many edges. Howell C-11, C-14; cubature for the last,
// whose discs would have (3 - sqrt 5) / 2 = 0.38197 (C-41).
inline const std::vector<KnownPair> kHardPairs = {
    {"parallel gap0.01",
     kSquare,
     {{0, 1, 0.01f}, {1, 1, 0.01f}, {1, 0, 0.01f}, {0, 0, 0.01f}},
     {},
     0.980416602926},
    {"perp l1 w0.1 h10",
     {{0, 0, 0}, {0.1f, 0, 0}, {0.1f, 1, 0}, {0, 1, 0}},
     {{0, 0, 0}, {0, 1, 0}, {0, 1, 10}, {0, 0, 10}},
     {},
     0.439387300707},
    {"ngon64 discs", make_disc(0, true), make_disc(1, false), {}, 0.381691438559},
};

}  // namespace patchlight
