// Which corners of a polygon spoil its plane.
#pragma once

#include "dsl/polygons/flat_polygon.h"

namespace patchlight {

constexpr double kAreaMin = 1e-10;  // less is no area, in units of size squared

// Newell's normal of the points from first to last, but for number `skip`: its length is twice their area in
// units of size squared. Sums are taken relative to `origin`.
DVec3 newell(const std::vector<DVec3>& points, size_t first, size_t last, DVec3 origin, double size,
             size_t skip = ~size_t{0});

// The corner of the outline whose absence leaves the flattest rest; among equals the one farthest from that
// rest.
size_t corner_to_blame(const FlatPolygon& polygon);

// The ring of the corner that is farthest off the plane.
uint32_t ring_off_plane(const FlatPolygon& polygon);

// True when all corners lie on one line.
bool is_on_line(const FlatPolygon& polygon);

}  // namespace patchlight
