// The list of shapes, in the order in which the language tells of them. A new one is its file and its name
// here.
#include "dsl/shapes/shapes.h"

namespace patchlight {

extern const ShapeRow kPolygonShape, kQuadShape, kBoxShape, kRoomShape, kGridShape, kDiskShape,
    kCylinderShape, kPrismShape, kSphereShape, kMeshShape, kGroupShape, kRepeatShape;

std::span<const ShapeRow> shape_rows() {
  static const ShapeRow rows[] = {
      kPolygonShape,  kQuadShape,  kBoxShape,    kRoomShape, kGridShape,  kDiskShape,
      kCylinderShape, kPrismShape, kSphereShape, kMeshShape, kGroupShape, kRepeatShape,
  };
  return rows;
}

}  // namespace patchlight
