// The snapshots of a run side by side: what is there after each, and below what was added since the one
// before.
#pragma once

#include "tools/image/color_scale.h"
#include "tools/image/picture.h"

#include <string>
#include <vector>

namespace patchlight {

struct StoryPanel {
  std::string lit_label, lit_note;  // above the picture, at its left and right
  Picture lit;                      // display-linear
  std::string added_label, added_note;
  Picture added;  // the same size
};

struct Storyboard {
  std::string title, note;  // in the first line, at its left and right
  std::vector<StoryPanel> panels;
  std::vector<ColorScale> scales;  // what the colours mean: a legend each in the last line
};

// Pixels that a picture of a storyboard with so many panels may be wide: four stand side by side at most, on
// a page of 1920 pixels.
uint32_t find_panel_width(size_t panel_count, uint32_t picture_width);

// One picture, dark letters on white. Panels must be of one size.
Picture compose_storyboard(const Storyboard& storyboard);

}  // namespace patchlight
