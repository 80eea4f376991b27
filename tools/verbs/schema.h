// The language's tables of keys to a JSON Schema (draft-07).
#pragma once

#include <string>

namespace patchlight {

// The text of scenes/patchlight.schema.json. What a schema cannot say (names that must exist, geometry,
// limits on sums) is left to `patchlight check`.
std::string format_schema();

}  // namespace patchlight
