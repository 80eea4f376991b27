// Pictures of a whole run: what their labels say. Whole runs are in program/pictures.cpp.
#include "tools/series.h"

#include <doctest/doctest.h>

using namespace patchlight;

TEST_CASE("powers are written with a unit that fits them") {
  CHECK(format_watts(0) == "0 W");
  CHECK(format_watts(217.4) == "217 W");
  CHECK(format_watts(1234) == "1.23 kW");
  CHECK(format_watts(2.4e6) == "2.4 MW");
  CHECK(format_watts(0.127) == "127 mW");
}
