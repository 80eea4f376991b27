// Four corners by a rectangle's centre, size and normal, or by a corner and two edges: the keys that quad and
// grid share.
#pragma once

#include "dsl/report/limits.h"
#include "dsl/shapes/shape.h"

#include <array>

namespace patchlight {

constexpr KeyRow kQuadRows[] = {
    {"size", ValueType::kVec2, false, "", kAboveZero, kCoordinateMax, "out-of-range", "",
     "Width and height. Required with center and normal."},
    {"center", ValueType::kVec3, false, "0 0 0", -kAnyNumber, kAnyNumber, "out-of-range", "",
     "Middle of the rectangle."},
    {"normal", ValueType::kVec3, false, "0 1 0", -kAnyNumber, kAnyNumber, "out-of-range", "",
     "Towards the lit side, any length. The width lies along x where it can."},
    {"origin", ValueType::kVec3, false, "", -kAnyNumber, kAnyNumber, "out-of-range", "",
     "A corner; then u and v are required."},
    {"u", ValueType::kVec3, false, "", -kAnyNumber, kAnyNumber, "out-of-range", "",
     "Edge from origin to the second corner."},
    {"v", ValueType::kVec3, false, "", -kAnyNumber, kAnyNumber, "out-of-range", "",
     "Edge from origin to the last corner; the lit side is u x v."},
};

constexpr KeyRule kQuadRules[] = {
    {RuleKind::kOneOf, "size|origin", "", "missing-key",
     "a {} needs its size: [width, height], or origin, u and v"},
    {RuleKind::kExcludes, "center|size|normal", "origin|u|v", "ambiguous-shape",
     "a {} has either center, size, normal or origin, u, v"},
    {RuleKind::kNeeds, "origin|u|v", "origin|u|v", "missing-key", "a {} by edges needs origin, u and v"},
};

// The corners of a map that has these keys; false after an error.
bool read_quad(const Context& context, const MapValues& map, std::array<DVec3, 4>& corners);

}  // namespace patchlight
