// Heat: the net flows of textbooks (Howell, Menguc, Daun, Siegel: Thermal Radiation Heat Transfer).
#include "dsl/load.h"
#include "tests/scenes.h"
#include "tools/object_power.h"

#include <doctest/doctest.h>

#include <cmath>

using namespace patchlight;

namespace {

constexpr double kSigma = 5.670374419e-8;  // W/(m2 K4)

ObjectPowerTable solve_heat(const std::string& text) {
  std::vector<Diagnostic> warnings;
  Scene scene = load_scene_text(text, "heat.yaml", warnings);
  scene.solver.patch_count_max = 4000;
  scene.solver.until = 1e-5f;
  const Run run = run_scene(scene.faces, scene.solver, 40);
  return find_object_power(scene, run.solution);
}

}  // namespace

TEST_CASE("two grey balls, one in the other: the net flow is the two-surface formula's") {
  const ObjectPowerTable power = solve_heat(
      "patchlight: 1\nunits: cm\nmaterials:\n  hot: {temperature: 800, emissivity: 0.5}\n"
      "  cold: {temperature: 300, emissivity: 0.6}\nobjects:\n"
      "  - {id: inner, sphere: {radius: 100, sides: 32}, material: hot}\n"
      "  - {id: outer, sphere: {radius: 200, sides: 32, inward: true}, material: cold}\n");
  REQUIRE(power.size() == 2);
  // Areas as they are, of flat parts: 32 sides make them about 1 % smaller than those of round balls.
  const double a1 = power.area[0], a2 = power.area[1];
  CHECK(a1 == doctest::Approx(4 * std::numbers::pi).epsilon(0.012));
  CHECK(a2 / a1 == doctest::Approx(4).epsilon(1e-5));
  const double flow = kSigma * (std::pow(800, 4) - std::pow(300, 4)) /
                      ((1 - 0.5) / (a1 * 0.5) + 1 / a1 + (1 - 0.6) / (a2 * 0.6));
  // The net flow is half of what the inner ball emits: errors of H of about 1 / sqrt(256 rays times 500
  // rows), 0.3 %, count four times at most.
  CHECK(find_net_power(power, 0).g == doctest::Approx(flow).epsilon(0.01));
  CHECK(find_net_power(power, 1).g == doctest::Approx(-flow).epsilon(0.01));
}

TEST_CASE("a grey floor in a black box: emissivity times area times the difference of sigma T^4") {
  const ObjectPowerTable power = solve_heat(
      "patchlight: 1\nmaterials:\n  warm: {temperature: 400, emissivity: 0.7}\n"
      "  black: {temperature: 250, emissivity: 1}\nobjects:\n"
      "  - {id: walls, room: {size: [2, 1, 3], omit: [floor]}, material: black}\n"
      "  - {id: floor, quad: {size: [2, 3], center: [1, 0, 1.5]}, material: warm}\n");
  const double flow = 0.7 * 6 * kSigma * (std::pow(400, 4) - std::pow(250, 4));
  // The floor receives from black walls alone, which fill its sky: its rows are exact.
  CHECK(find_net_power(power, 1).g == doctest::Approx(flow).epsilon(1e-5));
  // The walls lose, all together, what the floor gains; from them it is found by rays, or aimed at.
  CHECK(find_net_power(power, 0).g == doctest::Approx(-flow).epsilon(0.02));
}

TEST_CASE("at one temperature no net heat flows, whatever the emissivities") {
  const ObjectPowerTable power = solve_heat(
      "patchlight: 1\nmaterials:\n  dull: {temperature: 320, emissivity: 0.9}\n"
      "  bright: {temperature: 320, emissivity: 0.2}\nobjects:\n"
      "  - {id: room, room: {size: [2, 1, 3]}, material: dull}\n"
      "  - {id: box, box: {size: [0.5, 0.5, 0.5], at: [0.5, 0.2, 1]}, material: bright}\n");
  // Everything emits, so that rows see all of it and sum to 1. Aimed rays of pass 2, a tenth of all heat
  // here, err by about 1 / sqrt(64 rays times some hundred rows): 1 % of that tenth.
  for (size_t object = 0; object < 2; ++object)
    CHECK(std::abs(find_net_power(power, object).g) <= 1e-3 * power.emitted[object].g);
}
