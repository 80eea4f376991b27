// A promise of the README over all shipped scenes: the same bits, whether form factors are kept or computed
// again.
#include "child.h"
#include "tools/base/json.h"

#include <doctest/doctest.h>

#include <filesystem>

using namespace patchlight;
using namespace patchlight::testing;

namespace {

// As small as the scene allows: some start with many patches.
std::string find_hash(const std::string& scene, const std::string& form_factors) {
  const Folder folder;
  ChildResult result;
  for (const char* budget : {"3000", "20000"}) {
    result = run_child({"render", scene, "-o", folder / "out", "--quiet", "--size", "8x8", "--rays", "16",
                        "--max-patches", budget, "--passes", "3", "--form-factors", form_factors, "--report",
                        folder / "report.json"});
    if (result.exit_code == 0)
      return Json::parse(read_bytes(folder / "report.json"))["solution_hash"].get<std::string>();
  }
  FAIL(scene, ": ", result.err);
  return {};
}

}  // namespace

TEST_CASE("every shipped scene has the same bits with form factors cached and recomputed") {
  size_t count = 0;
  for (const auto& entry :
       std::filesystem::directory_iterator(std::string(PATCHLIGHT_SOURCE_DIR) + "/scenes")) {
    if (entry.path().extension() != ".yaml") continue;
    CAPTURE(entry.path().string());
    CHECK(find_hash(entry.path().string(), "cached") == find_hash(entry.path().string(), "recompute"));
    ++count;
  }
  CHECK(count > 20);
}

TEST_CASE("a shared row whose members are split has the same bits cached and recomputed") {
  // A sliver of four small faces shares rows; the lamp beside it splits them.
  const Folder folder;
  const std::string path = folder / "sliver.yaml";
  write_bytes(path, R"(patchlight: 1
materials: {w: {reflectance: 0.7}, sun: {emission: 500000}}
objects:
  - {id: sliver, polygon: [[3.79, 0.455, 2.32], [3.79, 0.455, 2.427], [3.79, 1.685, 2.427], [3.79, 1.685, 2.32]], material: w}
  - {id: floor, quad: {center: [3, 0, 3.5], size: [6, 7]}, material: w}
  - {id: sun, quad: {center: [3, 2.9, 3.5], size: [0.3, 0.3], normal: [0, -1, 0]}, material: sun}
camera: {eye: [6, 3, 6], target: [3, 0, 3]}
)");
  CHECK(find_hash(path, "cached") == find_hash(path, "recompute"));
}
