// Text in pictures.
#include "tools/image/lettering.h"

#include <doctest/doctest.h>

#include <algorithm>

using namespace patchlight;

namespace {

// The share of ink in the box, white on black.
double find_ink(const Picture& picture, const Box& box) {
  double ink = 0;
  for (uint32_t y = box.y; y < box.y + box.height; ++y)
    for (uint32_t x = box.x; x < box.x + box.width; ++x) ink += picture.pixels[y * picture.width + x].g;
  return ink / (box.width * box.height);
}

}  // namespace

TEST_CASE("a line of text is as long as it measures, and stands on its baseline") {
  Picture picture = make_picture(200, 60, Rgb(0));
  draw_text(picture, 10, 40, "HHHH", {.size = 30});
  const float length = measure_text("HHHH", 30);
  // DejaVu Sans: an H is 1540 of 2048 units wide and, without serifs, 1493 high.
  CHECK(length == doctest::Approx(4 * 30 * 1540 / 2048.0).epsilon(1e-4));
  const auto end = static_cast<uint32_t>(10 + length);
  CHECK(find_ink(picture, {10, 18, end - 10, 22}) > 0.25);
  CHECK(find_ink(picture, {0, 0, 10, 60}) == 0);
  CHECK(find_ink(picture, {end, 0, 200 - end, 60}) == 0);
  CHECK(find_ink(picture, {0, 40, 200, 20}) == 0);
  CHECK(find_ink(picture, {0, 0, 200, 18}) == 0);
}

TEST_CASE("letters have soft edges") {
  Picture picture = make_picture(40, 40, Rgb(0));
  draw_text(picture, 5, 32, "O", {.size = 32});
  const auto is_soft = [](const Rgb& pixel) { return pixel.g > 0.05f && pixel.g < 0.9f; };
  CHECK(std::count_if(picture.pixels.begin(), picture.pixels.end(), is_soft) > 30);
}

TEST_CASE("text may be centred or end at a place, and is cut at the picture's border") {
  const float length = measure_text("patch", 20);
  for (const TextAlign align : {TextAlign::kCentre, TextAlign::kRight}) {
    Picture picture = make_picture(200, 30, Rgb(0));
    draw_text(picture, 150, 20, "patch", {.size = 20, .align = align});
    const float end = align == TextAlign::kRight ? 150 : 150 + length / 2;
    const auto left = static_cast<uint32_t>(end - length), right = static_cast<uint32_t>(end) + 1;
    CHECK(find_ink(picture, {left, 0, right - left, 30}) > 0.05);
    CHECK(find_ink(picture, {0, 0, left, 30}) == 0);
    CHECK(find_ink(picture, {right, 0, 200 - right, 30}) == 0);
  }
  Picture small = make_picture(8, 8, Rgb(0));
  draw_text(small, -20, 5, "everywhere", {.size = 30});
  CHECK(find_ink(small, {0, 0, 8, 8}) > 0);
}

TEST_CASE("what the font lacks and what is not UTF-8 is a question mark") {
  const float mark = measure_text("?", 20);
  for (const char* text : {"\xe6\xbc\xa2", "\xff", "\xe6", "\xc3(", "\xf0\x9f\x98\x80"})
    CHECK(measure_text(text, 20) >= mark);
  CHECK(measure_text("\xe6\xbc\xa2", 20) == mark);
  // And it has what units and products need.
  for (const char* text : {"\xc2\xb2", "\xc2\xb7", "\xc3\x97", "\xc2\xb0", "\xe2\x88\x92"}) {
    Picture sign = make_picture(24, 24, Rgb(0)), question = sign;
    draw_text(sign, 2, 20, text, {.size = 20});
    draw_text(question, 2, 20, "?", {.size = 20});
    CHECK(find_ink(sign, {0, 0, 24, 24}) > 0);
    CHECK(sign.pixels != question.pixels);
  }
}
