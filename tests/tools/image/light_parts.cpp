// The parts of the light that pictures show.
#include "tools/image/light_parts.h"

#include <doctest/doctest.h>

using namespace patchlight;

TEST_CASE("direct and indirect light add up to all of it, and neither is negative") {
  LightHistory history;
  history.first = {Rgb(1, 2, 3), Rgb(0), Rgb(0.5f)};
  // The last value lost a hair to rounding since pass 1.
  const std::vector<Rgb> now = {Rgb(4, 2, 3.5f), Rgb(0.25f), Rgb(0.4999999f)};
  const std::vector<Rgb> direct = pick_light(history, now, Light::kDirect);
  const std::vector<Rgb> indirect = pick_light(history, now, Light::kIndirect);
  const std::vector<Rgb> all = pick_light(history, now, Light::kAll);
  CHECK(all == now);
  for (size_t k = 0; k < now.size(); ++k) CHECK(direct[k] + indirect[k] == now[k]);
  CHECK(direct[0] == Rgb(1, 2, 3));
  CHECK(indirect[0] == Rgb(3, 0, 0.5f));
  CHECK(indirect[2] == Rgb(0));
}

TEST_CASE("before pass 1 all light is direct") {
  const std::vector<Rgb> now = {Rgb(1, 2, 3)};
  CHECK(pick_light({}, now, Light::kDirect) == now);
  CHECK(pick_light({}, now, Light::kIndirect) == std::vector<Rgb>{Rgb(0)});
}

TEST_CASE("what the last pass added is emission at first, and never negative") {
  LightHistory history;
  history.now = {Rgb(0), Rgb(5)};
  CHECK(find_added(history) == history.now);
  history.before = {Rgb(1, 0, 0), Rgb(2)};
  CHECK(find_added(history) == std::vector<Rgb>{Rgb(0), Rgb(3)});
}
