// Lamps by their power.
#include "dsl/scene/power.h"

#include "tests/dsl/support.h"
#include "tests/scenes.h"

#include <doctest/doctest.h>

namespace patchlight::test {
namespace {

// Of all faces, W.
DRgb emitted_power(const Scene& scene) {
  DRgb sum(0);
  for (size_t f = 0; f < scene.faces.size(); ++f)
    sum +=
        face_area(scene, f) * scene.metres_per_unit * scene.metres_per_unit * DRgb(scene.faces.emission[f]);
  return sum;
}

Loaded load_lamp(const std::string& lamp, const std::string& power = "20") {
  const std::string room = "  - {room: {at: [-9, -9, -9], size: [18, 18, 18]}, material: w}\n";
  Loaded loaded = load("patchlight: 1\nunits: ft\nmaterials: {w: {reflectance: 0.5}, l: {power: " + power +
                       "}}\nobjects:\n" + room + "  - {id: x, material: l, " + lamp + "}\n");
  for (const Diagnostic& error : loaded.errors) MESSAGE(error.message);
  REQUIRE(loaded.errors.empty());
  CHECK(count_slug(loaded.warnings, "no-emitter") == (power == "0" ? 1 : 0));
  return loaded;
}

TEST_CASE("an object gives off the power of its material, whatever its shape, sides, unit and scale") {
  // Emissions are floats.
  const auto about = [](double watts) { return doctest::Approx(watts).epsilon(1e-6); };
  for (const char* lamp : {"quad: {size: [1, 2]}", "quad: {size: [1, 2]}, two_sided: true",
                           "sphere: {radius: 0.3}", "box: {size: [1, 2, 3]}, scale: [2, 1, -0.5]",
                           "disk: {radius: 1}", "grid: {size: [1, 1], cells: [3, 4]}"})
    CHECK(emitted_power(load_lamp(lamp).scene).g == about(20));
  const Loaded colour = load_lamp("quad: {size: [3, 2]}", "[1, 20, 300]");
  CHECK(emitted_power(colour.scene).r == about(1));
  CHECK(emitted_power(colour.scene).b == about(300));
  CHECK(emitted_power(load_lamp("quad: {size: [3, 2]}", "0").scene).g == 0);
}

TEST_CASE("each object of a group and each copy of a repeat has it") {
  const auto about = [](double watts) { return doctest::Approx(watts).epsilon(1e-6); };
  const std::string two = "group: [{quad: {size: [1, 1]}}, {box: {size: [1, 1, 1], at: [0, 2, 0]}}]";
  CHECK(emitted_power(load_lamp(two).scene).g == about(40));
  CHECK(emitted_power(load_lamp("repeat: {count: [2, 3, 1], step: [2, 2, 2], of: {" + two + "}}").scene).g ==
        about(240));
}

TEST_CASE(
    "one wall of a room shares nothing with the others, and the ledger tells the power that was asked for") {
  const Loaded room = load(
      "patchlight: 1\nmaterials: {w: {reflectance: 0.5}, l: {power: 12, reflectance: 0.3}}\nobjects:\n"
      "  - {room: {size: [2, 3, 4], walls: {ceiling: l}}, material: w}\n");
  REQUIRE(room.errors.empty());
  const PowerLedger ledger = find_power_ledger(solve_scene(room.scene.faces, {}, 1));
  // In engine lengths; areas are floats.
  const double scale = room.scene.metres_per_length() * room.scene.metres_per_length();
  CHECK(ledger.emitted.g * scale == doctest::Approx(12).epsilon(1e-5));
}

TEST_CASE("a power that makes too large an emission is an error at the object") {
  const Loaded loaded = load(
      "patchlight: 1\nmaterials: {w: {reflectance: 0.5}, l: {power: 1e20}}\nobjects:\n"
      "  - {quad: {size: [1, 1]}, material: w}\n  - {quad: {center: [0, 1, 0], size: [0.1, 0.1]}, material: "
      "l}\n");
  REQUIRE(loaded.errors.size() == 1);
  CHECK(loaded.errors[0].slug == "emission-range");
  CHECK(loaded.errors[0].line == 5);
}

}  // namespace
}  // namespace patchlight::test
