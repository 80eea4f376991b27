// Numbers and names as text.
#include "dsl/report/text.h"

#include <doctest/doctest.h>

namespace patchlight::test {
namespace {

TEST_CASE("numbers in messages are whole where they are, and else as short as tells them apart") {
  CHECK(number_text(200000) == "200000");
  CHECK(number_text(-3) == "-3");
  CHECK(number_text(0.1) == "0.1");
  CHECK(number_text(1.0000000001) == "1.0000000001");
  CHECK(number_text(1e20) == "1e+20");
}

TEST_CASE("numbers that are too near to 0 are told from those that are too large") {
  for (const char* text : {"1e-400", "-1e-400", "0.0001e-330", "1e-99999999999999999999"}) {
    CAPTURE(text);
    CHECK(is_tiny(text));
  }
  for (const char* text : {"1e400", "1", "0.1e99999999999999999999"}) {
    CAPTURE(text);
    CHECK(!is_tiny(text));
  }
}

TEST_CASE("names begin with a letter or _ and go on with letters, digits, _ . and -") {
  for (const char* text : {"a", "_", "lamps.white", "A-1"}) {
    CAPTURE(text);
    CHECK(is_name(text));
  }
  for (const char* text : {"", "1a", ".a", "-a", "a b", "\xc3\xa4"}) {
    CAPTURE(text);
    CHECK(!is_name(text));
  }
}

}  // namespace
}  // namespace patchlight::test
