// Expectations name polygons of the scene.
#include "dsl/scene/expect.h"

#include "tests/dsl/support.h"

#include <doctest/doctest.h>

namespace patchlight::test {
namespace {

TEST_CASE("an expectation means the polygon of its id, or all parts of the object") {
  const Loaded loaded = load(kBase +
                             "  - {id: hall, room: {size: [4,4,4], at: [-1,-1,-1]}, material: white}\n"
                             "expect:\n  - {object: hall.left, pass: 2, radiosity: [1, 2, 3], tolerance: "
                             "0.1}\n  - {object: hall, radiosity: 1}\n");
  REQUIRE(loaded.errors.empty());
  const auto& list = loaded.scene.expectations;
  REQUIRE(list.size() == 2);
  CHECK(list[0].polygons == std::vector<uint32_t>{4});
  CHECK(list[0].pass == 2);
  CHECK(list[0].radiosity == Rgb(1, 2, 3));
  CHECK(list[0].tolerance == 0.1);
  CHECK(list[0].line == 10);
  CHECK(list[1].polygons.size() == 6);
  CHECK(list[1].radiosity == Rgb(1, 1, 1));
  CHECK(list[1].pass == 16);
  CHECK(list[1].after_last);
  CHECK(!list[0].after_last);
}

}  // namespace
}  // namespace patchlight::test
