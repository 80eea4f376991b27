// Faces to the edges and corners that they share.
#pragma once

#include "engine/tables.h"

namespace patchlight {

// Which edges and corners of the faces of one polygon coincide. Faces of a polygon must share whole edges or
// nothing (the loader cuts them so); coinciding corners must be equal bit by bit.
FaceLinkTable make_face_links(const FaceTable& faces);

// The same, and the edges that two polygons of one surface share where their normals differ by no more than
// the crease angle, 30 degrees, and their materials are equal: what the eye is to take for one curved
// surface. Of several polygons on an edge the two that go on most straightly are joined. Corners are the same
// all along joined edges.
FaceLinkTable make_smooth_links(const FaceLinkTable& links, const FaceTable& faces);

}  // namespace patchlight
