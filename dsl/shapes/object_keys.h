// The keys of an object, joined from those that all objects share and those of the shapes.
#pragma once

#include "dsl/language/language.h"

namespace patchlight {

// The shared keys, those that go with one shape, then one for each shape.
const KeyTable& object_keys();

}  // namespace patchlight
