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
