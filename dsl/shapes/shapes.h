// The shapes of the language.
#pragma once

#include "dsl/shapes/shape.h"

#include <span>

namespace patchlight {

std::span<const ShapeRow> shape_rows();

}  // namespace patchlight
