// The keys of an object, joined from those that all objects share and those of the shapes; and with them the
// whole language.
#pragma once

#include "dsl/language/language.h"

#include <span>

namespace patchlight {

// The shared keys, those that go with one shape, then one for each shape.
const KeyTable& object_keys();

// All tables, those of the shapes included, in the order in which they are best read.
std::span<const KeyTable* const> language_tables();

}  // namespace patchlight
