// What is said of the values that pictures show. Whole runs are in program/pictures.cpp.
#include "tools/render/pictures.h"

#include <doctest/doctest.h>

#include <limits>

using namespace patchlight;

TEST_CASE("values that are negative or no numbers are counted and told, and all others are not") {
  Talk talk;
  talk.json = true;  // What is said is kept.
  const float no_number = std::numeric_limits<float>::quiet_NaN(),
              infinite = std::numeric_limits<float>::infinity();
  check_values(std::vector<Rgb>{Rgb(0), Rgb(1, 2, 3), Rgb(1e20f)}, 2, "room.yaml", talk);
  CHECK(talk.said.empty());
  check_values(std::vector<Rgb>{Rgb(0), Rgb(1, no_number, 1), Rgb(1, 1, -1e-9f), Rgb(infinite), Rgb(2)}, 2,
               "room.yaml", talk);
  REQUIRE(talk.said.size() == 1);
  CHECK(talk.said[0].slug == "bad-radiosity");
  CHECK((talk.said[0].severity == Severity::kWarning));
  CHECK(talk.said[0].message.find("after pass 2, 3 of 5 values") != std::string::npos);
}
