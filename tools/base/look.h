// How pictures look: which part of the light they show, by which curve, or what else in false colours.
#pragma once

#include <string>
#include <vector>

namespace patchlight {

struct FalseColor;  // false_colors.h
struct Tone;        // tone.h

// Direct light is emission and what pass 1 added; indirect light is what all later passes added.
enum class Light { kAll, kDirect, kIndirect };
inline const std::vector<std::string> kLightNames = {"all", "direct", "indirect"};

// How a scale of W/m2 is divided; automatic: by decades where its ends are far apart.
enum class ScaleKind { kAuto, kLog, kLinear };
inline const std::vector<std::string> kScaleNames = {"auto", "log", "linear"};

struct Look {
  Light light = Light::kAll;
  const Tone* tone = nullptr;               // none: clipped at white
  const FalseColor* false_color = nullptr;  // none: the light itself
  ScaleKind scale = ScaleKind::kAuto;
};

}  // namespace patchlight
