// The one door to stb_image_write: pixels -> files in memory.
#pragma once

#include <cstdint>
#include <span>
#include <string>

namespace patchlight {

// width x height x 3 bytes of sRGB, row by row from the top left.
std::string pack_png(uint32_t width, uint32_t height, std::span<const uint8_t> bytes);
// width x height x 3 finite floats, none negative.
std::string pack_hdr(uint32_t width, uint32_t height, std::span<const float> values);

}  // namespace patchlight
