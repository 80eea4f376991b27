// Text into pictures, by stb_truetype, with a font that is built in (fonts/LICENSE). The one door to
// stb_truetype, which trusts its font: it never sees another one.
#include "tools/image/lettering.h"

#include <algorithm>
#include <cstddef>
#include <stdexcept>
#include <vector>

#define STB_TRUETYPE_IMPLEMENTATION
#define STBTT_STATIC
#include <stb_truetype.h>

namespace patchlight {
namespace {

#include "font_bytes.inc"

const stbtt_fontinfo& get_font() {
  static const stbtt_fontinfo font = [] {
    stbtt_fontinfo info;
    if (stbtt_InitFont(&info, kFontBytes, 0) == 0) throw std::runtime_error("the built-in font is damaged");
    return info;
  }();
  return font;
}

// The character that starts at `at`, which moves on to the next one; '?' for what is not UTF-8.
int read_character(std::string_view text, size_t& at) {
  const auto byte = [&](size_t k) { return static_cast<unsigned>(static_cast<unsigned char>(text[k])); };
  const unsigned first = byte(at++);
  if (first < 0x80) return static_cast<int>(first);
  const size_t more = first >= 0xf0 ? 3 : first >= 0xe0 ? 2 : first >= 0xc0 ? 1 : 0;
  unsigned code = first & (0x3fu >> more);
  for (size_t k = 0; k < more; ++k) {
    if (at >= text.size() || (byte(at) & 0xc0u) != 0x80u) return '?';
    code = code << 6 | (byte(at++) & 0x3fu);
  }
  return more > 0 ? static_cast<int>(code) : '?';
}

// Calls place(glyph, pen) for every glyph of the line, pen in pixels from its start; returns its width.
template <class Place>
float place_glyphs(std::string_view text, float size, const Place& place) {
  const stbtt_fontinfo& font = get_font();
  const float scale = stbtt_ScaleForMappingEmToPixels(&font, size);
  float pen = 0;
  int before = 0;
  for (size_t at = 0; at < text.size();) {
    int glyph = stbtt_FindGlyphIndex(&font, read_character(text, at));
    if (glyph == 0) glyph = stbtt_FindGlyphIndex(&font, '?');
    if (before != 0) pen += scale * static_cast<float>(stbtt_GetGlyphKernAdvance(&font, before, glyph));
    place(glyph, pen);
    int advance = 0, bearing = 0;
    stbtt_GetGlyphHMetrics(&font, glyph, &advance, &bearing);
    pen += scale * static_cast<float>(advance);
    before = glyph;
  }
  return pen;
}

// Blends one glyph, its origin at (x, y).
void draw_glyph(Picture& picture, int glyph, float x, float y, const Letters& letters,
                std::vector<unsigned char>& bitmap) {
  const stbtt_fontinfo& font = get_font();
  const float scale = stbtt_ScaleForMappingEmToPixels(&font, letters.size);
  const float whole_x = std::floor(x), whole_y = std::floor(y);
  int left = 0, top = 0, right = 0, bottom = 0;
  stbtt_GetGlyphBitmapBoxSubpixel(&font, glyph, scale, scale, x - whole_x, y - whole_y, &left, &top, &right,
                                  &bottom);
  const int width = right - left, height = bottom - top;
  if (width <= 0 || height <= 0) return;
  bitmap.assign(static_cast<size_t>(width) * static_cast<size_t>(height), 0);
  stbtt_MakeGlyphBitmapSubpixel(&font, bitmap.data(), width, height, width, scale, scale, x - whole_x,
                                y - whole_y, glyph);
  for (int v = 0; v < height; ++v)
    for (int u = 0; u < width; ++u) {
      const auto at_x = static_cast<int64_t>(whole_x) + left + u;
      const auto at_y = static_cast<int64_t>(whole_y) + top + v;
      if (at_x < 0 || at_y < 0 || at_x >= picture.width || at_y >= picture.height) continue;
      Rgb& pixel = picture.pixels[static_cast<size_t>(at_y) * picture.width + static_cast<size_t>(at_x)];
      pixel = mix_seen(pixel, letters.color,
                       static_cast<float>(bitmap[static_cast<size_t>(v * width + u)]) / 255);
    }
}

}  // namespace

float measure_text(std::string_view text, float size) {
  return place_glyphs(text, size, [](int, float) {});
}

void draw_text(Picture& picture, float x, float y, std::string_view text, const Letters& letters) {
  if (letters.align == TextAlign::kCentre) x -= measure_text(text, letters.size) / 2;
  if (letters.align == TextAlign::kRight) x -= measure_text(text, letters.size);
  std::vector<unsigned char> bitmap;
  place_glyphs(text, letters.size,
               [&](int glyph, float pen) { draw_glyph(picture, glyph, x + pen, y, letters, bitmap); });
}

void draw_label(Picture& picture, std::string_view text) {
  const float size = std::clamp(static_cast<float>(picture.height) / 30, 9.0f, 40.0f);
  const auto em = static_cast<uint32_t>(size);
  const auto width = static_cast<uint32_t>(measure_text(text, size)) + em;
  fill_box(picture, {em / 2, em / 2, width, em * 3 / 2}, Rgb(0.01f), 0.92f);
  draw_text(picture, static_cast<float>(em), 1.6f * size, text, {size, Rgb(0.9f)});
}

}  // namespace patchlight
