// Pictures one after another -> a GIF that repeats.
#pragma once

#include "tools/image/palette.h"
#include "tools/image/picture.h"

#include <string>
#include <vector>

namespace patchlight {

struct Animation {
  std::vector<BytePicture> frames;  // of one size
  std::vector<double> seconds;      // a row a frame
};

// Appends a display-linear picture with a label in its corner; it is made smaller where it is wider than 960
// pixels.
void add_frame(Animation& animation, const Picture& picture, const std::string& label, double seconds);

// Bytes that a frame keeps.
uint64_t count_frame_bytes(uint32_t picture_width, uint32_t picture_height);

}  // namespace patchlight
