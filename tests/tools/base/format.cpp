// Numbers as people read them.
#include "tools/base/format.h"

#include <doctest/doctest.h>

using namespace patchlight;

TEST_CASE("counts and bytes read the same in every locale") {
  CHECK(format_count(999999) == "999999");
  CHECK(format_count(1234567) == "1.23 million");
  CHECK(format_count(4500000000) == "4.5 billion");
  CHECK(format_bytes(84300000) == "84.3 MB");
  CHECK(format_bytes(2500000000) == "2.5 GB");
  CHECK(format_seconds(0.83) == "0.83 s");
  CHECK(format_seconds(90) == "90 s");
  CHECK(format_seconds(180) == "3 minutes");
  CHECK(format_seconds(9000) == "2.5 hours");
  CHECK(format_seconds(1e6) == "11.6 days");
}

TEST_CASE("powers are written with a unit that fits them") {
  CHECK(format_watts(0) == "0 W");
  CHECK(format_watts(217.4) == "217 W");
  CHECK(format_watts(1234) == "1.23 kW");
  CHECK(format_watts(2.4e6) == "2.4 MW");
  CHECK(format_watts(0.127) == "127 mW");
}
