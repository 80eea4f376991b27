// How pictures look: which part of the light they show, by which curve, or what else in false colours.
#pragma once

#include <string>
#include <vector>

namespace patchlight {

// Direct light is emission and what pass 1 added; indirect light is what all later passes added.
enum class Light { kAll, kDirect, kIndirect };
inline const std::vector<std::string> kLightNames = {"all", "direct", "indirect"};

// From exposed radiosity to what a display shows: clipped at white, or with soft highlights.
enum class Tone { kClip, kFilmic };
inline const std::vector<std::string> kToneNames = {"clip", "filmic"};

// Numbers as colours: radiosity; what the last pass added to it; how often a patch's face was halved; why its
// parent was split.
enum class FalseColor { kOff, kRadiosity, kResidual, kLevel, kReason };
inline const std::vector<std::string> kFalseColorNames = {"off", "radiosity", "residual", "level", "reason"};

// How a scale of W/m2 is divided; automatic: by decades where its ends are far apart.
enum class ScaleKind { kAuto, kLog, kLinear };
inline const std::vector<std::string> kScaleNames = {"auto", "log", "linear"};

struct Look {
  Light light = Light::kAll;
  Tone tone = Tone::kClip;
  FalseColor false_color = FalseColor::kOff;
  ScaleKind scale = ScaleKind::kAuto;
};

// Levels and reasons belong to patches; all else is known at their corners, too.
inline bool is_of_patches(FalseColor color) {
  return color == FalseColor::kLevel || color == FalseColor::kReason;
}

}  // namespace patchlight
