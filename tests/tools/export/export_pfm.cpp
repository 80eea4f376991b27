// PFM files, read as their definition says.
#include "tools/export/exporters.h"

#include <doctest/doctest.h>

#include <cstring>

using namespace patchlight;

TEST_CASE("a PFM file holds every float as it is, rows from the bottom to the top") {
  Picture picture = make_picture(3, 2, Rgb(0));
  for (size_t k = 0; k < picture.pixels.size(); ++k)
    picture.pixels[k] = Rgb(0.1f + static_cast<float>(k), 1e-30f, 1e30f);
  const std::string file = find_exporter("pfm").encode_picture(picture);
  const std::string head = "PF\n3 2\n-1.0\n";
  REQUIRE(file.size() == head.size() + 6 * 3 * sizeof(float));
  CHECK(file.starts_with(head));
  std::vector<float> values(18);
  std::memcpy(values.data(), file.data() + head.size(), 18 * sizeof(float));
  for (size_t y = 0; y < 2; ++y)
    for (size_t x = 0; x < 3; ++x)
      for (int k = 0; k < 3; ++k)
        CHECK(values[((1 - y) * 3 + x) * 3 + static_cast<size_t>(k)] == picture.pixels[y * 3 + x][k]);
}

TEST_CASE("exporters tell what --format knows, and each row makes one kind of file") {
  for (const Exporter& row : exporters()) {
    CAPTURE(row.format);
    const int kinds =
        (row.encode_picture != nullptr) + (row.encode_animation != nullptr) + (row.export_run != nullptr);
    CHECK(kinds == 1);
    CHECK((row.export_run != nullptr || row.bytes_per_patch == 0));
    CHECK((row.encode_picture != nullptr || (!row.layers && row.bytes_per_pixel == 0)));
  }
  for (const std::string& format : exporter_formats()) CHECK(find_exporter(format).format == format);
  CHECK(find_report().always);
}
