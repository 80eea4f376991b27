// The whole language: what the schema is made from, and the reference is held against.
#pragma once

#include "dsl/language/language.h"

#include <span>

namespace patchlight {

// All tables, those of the shapes included, in the order in which they are best read.
std::span<const KeyTable* const> language_tables();

}  // namespace patchlight
