// Text into pictures.
#pragma once

#include "tools/image/picture.h"

#include <string_view>

namespace patchlight {

// Where the given x lies on a line of text.
enum class TextAlign { kLeft, kCentre, kRight };

struct Letters {
  float size = 16;  // pixels an em
  Rgb color{1};     // display-linear
  TextAlign align = TextAlign::kLeft;
};

// Pixels that a line of UTF-8 takes. What the font does not have (it has printable ASCII and a few signs) is
// shown as a question mark.
float measure_text(std::string_view text, float size);

// Draws a line of UTF-8, smooth-edged; (x, y) is a point on its baseline, in pixels from the top left. What
// lies outside of the picture is left out.
void draw_text(Picture& picture, float x, float y, std::string_view text, const Letters& letters);

// Draws a line of text on a dark ground at the upper left.
void draw_label(Picture& picture, std::string_view text);

}  // namespace patchlight
