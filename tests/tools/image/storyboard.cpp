// A page of snapshots.
#include "tools/image/storyboard.h"

#include <doctest/doctest.h>

#include <algorithm>

using namespace patchlight;

namespace {

// Panels of even colours: the lit ones red, those below blue, a little brighter from one to the next.
Storyboard make_storyboard(size_t count, uint32_t width, uint32_t height) {
  Storyboard storyboard{.title = "Room", .note = "12 patches", .panels = {}, .scales = {{}}};
  for (size_t k = 0; k < count; ++k) {
    const float shade = 0.2f + 0.05f * static_cast<float>(k);
    storyboard.panels.push_back({"pass 1", "reflects 3 W", make_picture(width, height, Rgb(shade, 0, 0)),
                                 "added by pass 1", "+3 W", make_picture(width, height, Rgb(0, 0, shade))});
  }
  return storyboard;
}

// The box around all pixels of a colour.
Box find_box(const Picture& picture, Rgb color) {
  uint32_t left = picture.width, top = picture.height, right = 0, bottom = 0;
  for (uint32_t y = 0; y < picture.height; ++y)
    for (uint32_t x = 0; x < picture.width; ++x)
      if (picture.pixels[size_t{y} * picture.width + x] == color) {
        left = std::min(left, x), right = std::max(right, x + 1);
        top = std::min(top, y), bottom = std::max(bottom, y + 1);
      }
  return {left, top, right - left, bottom - top};
}

}  // namespace

TEST_CASE("panels stand side by side, what was added below each, none covered by letters") {
  const Picture page = compose_storyboard(make_storyboard(3, 200, 150));
  uint32_t right_before = 0;
  for (size_t k = 0; k < 3; ++k) {
    const float shade = 0.2f + 0.05f * static_cast<float>(k);
    const Box lit = find_box(page, Rgb(shade, 0, 0)), added = find_box(page, Rgb(0, 0, shade));
    CHECK(lit.width == 200);
    CHECK(lit.height == 150);
    CHECK(added.width == 200);
    CHECK(added.height == 150);
    CHECK(lit.x == added.x);
    CHECK(added.y > lit.y + 150);
    CHECK(lit.x > right_before);
    right_before = lit.x + 200;
    for (uint32_t y = lit.y; y < lit.y + 150; ++y)
      for (uint32_t x = lit.x; x < lit.x + 200; ++x)
        REQUIRE(page.pixels[size_t{y} * page.width + x] == Rgb(shade, 0, 0));
  }
  // White paper around.
  for (uint32_t y = 0; y < page.height; ++y) CHECK(page.pixels[size_t{y} * page.width] == Rgb(1));
}

TEST_CASE("a page is a slide wide at most, and more than four panels go into further rows") {
  CHECK(find_panel_width(3, 960) == (1920 - 2 * 32 - 2 * 20) / 3);
  CHECK(find_panel_width(3, 64) == 64);
  CHECK(find_panel_width(1, 4000) <= 1920);
  for (const size_t count : {1, 4, 5, 16}) {
    const uint32_t width = find_panel_width(count, 4000);
    const Picture page = compose_storyboard(make_storyboard(count, width, 90));
    CHECK(page.width <= 1920);
    CHECK(page.height > 180 * ((count + 3) / 4));
  }
}
