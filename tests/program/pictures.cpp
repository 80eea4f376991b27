// Whole runs: the pictures that flags ask for, and what is in them.
#include "child.h"
#include "tools/json.h"

#include <doctest/doctest.h>
#include <tinyexr.h>

#include <array>
#include <cmath>
#include <cstdlib>

using namespace patchlight;
using namespace patchlight::testing;

namespace {

// R, G, B of every pixel.
std::vector<float> read_exr(const std::string& path) {
  const std::string file = read_bytes(path);
  float* pixels = nullptr;
  int width = 0, height = 0;
  const char* error = nullptr;
  REQUIRE(LoadEXRFromMemory(&pixels, &width, &height, reinterpret_cast<const unsigned char*>(file.data()),
                            file.size(), &error) == TINYEXR_SUCCESS);
  std::vector<float> values;
  for (int k = 0; k < width * height; ++k) values.insert(values.end(), pixels + 4 * k, pixels + 4 * k + 3);
  std::free(pixels);
  return values;
}

}  // namespace

TEST_CASE("pictures of direct and of indirect light add up to those of all light") {
  const Folder folder;
  write_bytes(folder / "box.yaml", kBoxScene);
  for (const char* light : {"all", "direct", "indirect"}) {
    const ChildResult result = run_child(render_words(
        folder / "box.yaml", folder / "lit", {"--light", light, "--format", "exr", "--snapshots", "1,16"}));
    INFO(result.err);
    REQUIRE(result.exit_code == 0);
  }
  for (const char* pass : {"01", "16"}) {
    const std::string stem = folder / "lit/box-pass-" + pass;
    const std::vector<float> all = read_exr(stem + ".exr"), direct = read_exr(stem + "-direct.exr"),
                             indirect = read_exr(stem + "-indirect.exr");
    double direct_sum = 0, indirect_sum = 0;
    for (size_t k = 0; k < all.size(); ++k) {
      // Sums of at most 256 samples, each rounded.
      CHECK(std::abs(direct[k] + indirect[k] - all[k]) <= 2e-5f * all[k]);
      CHECK(indirect[k] >= 0);
      direct_sum += direct[k];
      indirect_sum += indirect[k];
    }
    CHECK(direct_sum > 0);
    CHECK((indirect_sum > 0) == (std::string(pass) == "16"));
  }
}
