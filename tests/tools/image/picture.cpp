// Pictures out of pictures.
#include "tools/image/picture.h"

#include <doctest/doctest.h>

using namespace patchlight;

TEST_CASE("a box is filled where it lies in the picture, and nowhere else") {
  Picture picture = make_picture(4, 3, Rgb(0));
  fill_box(picture, {2, 1, 10, 10}, Rgb(1), 0.5f);
  for (uint32_t y = 0; y < 3; ++y)
    for (uint32_t x = 0; x < 4; ++x) CHECK(picture.pixels[y * 4 + x].g == (x >= 2 && y >= 1 ? 0.5f : 0.0f));
}

TEST_CASE("a picture is placed with its top left where it is told, and cut at the border") {
  Picture picture = make_picture(3, 3, Rgb(0));
  Picture part = make_picture(2, 2, Rgb(0));
  for (size_t k = 0; k < 4; ++k) part.pixels[k] = Rgb(static_cast<float>(k + 1));
  place_picture(picture, part, 2, 1);
  place_picture(picture, part, 3, 0);
  place_picture(picture, part, 0, 2);
  const float expected[9] = {0, 0, 0, 0, 0, 1, 1, 2, 3};
  for (size_t k = 0; k < 9; ++k) CHECK(picture.pixels[k].r == expected[k]);
}

TEST_CASE("a picture made smaller keeps its mean, and its left from its right") {
  Picture picture = make_picture(7, 5, Rgb(0));
  double sum = 0;
  for (size_t k = 0; k < picture.pixels.size(); ++k) {
    picture.pixels[k] = Rgb(static_cast<float>(k % 7) + 0.25f * static_cast<float>(k / 7));
    sum += picture.pixels[k].r;
  }
  const Picture small = shrink_picture(picture, 3, 2);
  double small_sum = 0;
  for (const Rgb& pixel : small.pixels) small_sum += pixel.r;
  CHECK(small_sum / 6 == doctest::Approx(sum / 35).epsilon(1e-6));
  CHECK(small.pixels[0].r < small.pixels[1].r);
  CHECK(small.pixels[0].r < small.pixels[3].r);
  CHECK(shrink_picture(picture, 7, 5).pixels == picture.pixels);
}
