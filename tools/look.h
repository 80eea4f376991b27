// How pictures look: which part of the light they show.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace patchlight {

// Direct light is emission and what pass 1 added; indirect light is what all later passes added.
enum class Light { kAll, kDirect, kIndirect };
inline const std::vector<std::string> kLightNames = {"all", "direct", "indirect"};

struct Look {
  Light light = Light::kAll;
};

}  // namespace patchlight
