// The light after each pass -> the parts of it that pictures show.
#pragma once

#include "engine/base/vector.h"
#include "tools/base/look.h"

#include <span>
#include <vector>

namespace patchlight {

// Radiosity at the values of the films (vertices or elements), W/m2, as far as pictures need it.
struct LightHistory {
  std::vector<Rgb> first;        // after pass 1
  std::vector<Rgb> before, now;  // after the last pass but one, and after the last one
};

// That part of `now`, the light after the current pass. The parts add up to all of it: nowhere is direct
// light more than there is light, and where no pass 1 is known all light is direct.
std::vector<Rgb> pick_light(const LightHistory& history, std::span<const Rgb> now, Light light);

// What the last pass added; emission before pass 1.
std::vector<Rgb> find_added(const LightHistory& history);

}  // namespace patchlight
