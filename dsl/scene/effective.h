// The settings that hold, each with where it comes from.
#pragma once

#include "dsl/language/values.h"
#include "dsl/scene/scene.h"

namespace patchlight {

// Variables, units, cameras, solver and output of a scene that was read without errors, `map` its keys.
// Origins are "built-in", FILE:LINE:COLUMN (with the expression that stands there), "--set PATH" or "-D
// NAME=VALUE".
SettingTable list_settings(const Context& context, const MapValues& map, const Scene& scene);

}  // namespace patchlight
