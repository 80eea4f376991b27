// Forecasts against solves: within a factor of two or so, and growing with what is asked.
#include "engine/solve/forecast.h"

#include "engine/solve/sizes.h"
#include "tests/scenes.h"

#include <doctest/doctest.h>

#include <cmath>

using namespace patchlight;

namespace {

FaceTable make_lit_room() {
  FaceTable faces;
  add_box_inward(faces, Vec3(0), Vec3(1), make_box_surfaces(make_surface(0, 0.6f)));
  add_quad(faces, {0.4f, 0.98f, 0.4f}, {0.6f, 0.98f, 0.4f}, {0.6f, 0.98f, 0.6f}, {0.4f, 0.98f, 0.6f},
           make_surface(10, 0.3f));
  add_box_outward(faces, {0.2f, -0.01f, 0.3f}, {0.5f, 0.45f, 0.6f}, make_surface(0, 0.6f));
  fit_scene(faces);
  return faces;
}

FaceTable make_furnace() {
  FaceTable faces;
  add_box_inward(faces, Vec3(0), Vec3(1), make_box_surfaces(make_surface(1, 0.5f)));
  fit_scene(faces);
  return faces;
}

bool within_factor(double a, double b, double factor) { return a <= factor * b && b <= factor * a; }

}  // namespace

TEST_CASE("a forecast is near what a solve makes, casts and holds") {
  for (const bool furnace : {false, true}) {
    CAPTURE(furnace);
    const FaceTable faces = furnace ? make_furnace() : make_lit_room();
    SolverSettings settings;
    settings.rays = 16;
    settings.pass_count_max = 2;
    settings.until = 0;
    const Solution run = solve_scene(faces, settings, 2);
    const Solution& s = run;
    const Forecast forecast = forecast_solve(faces, settings, count_starting_patches(faces, settings));
    CAPTURE(forecast.elements);
    CAPTURE(s.mesh.elements.size());
    CAPTURE(forecast.patches);
    CAPTURE(s.mesh.patches.size());
    // As far off as it was for any scene that it was fitted to.
    CHECK(within_factor(forecast.elements, static_cast<double>(s.mesh.elements.size()), 2.5));
    CHECK(within_factor(forecast.patches, static_cast<double>(s.mesh.patches.size()), 2.5));
    CAPTURE(forecast.rays);
    const uint64_t rays = s.log.direct_ray_count + s.log.transport_ray_count;
    CAPTURE(rays);
    CHECK(within_factor(forecast.rays, static_cast<double>(rays), 2.5));
    // At its largest it holds more than at its end.
    CHECK(forecast.bytes > static_cast<double>(count_bytes(s)) / 1.5);
    CHECK(forecast.bytes < static_cast<double>(count_bytes(s)) * 4);
  }
}

TEST_CASE("more rays, patches, passes or faces take longer; rows that are not kept take no memory") {
  const FaceTable faces = make_lit_room();
  const Forecast usual = forecast_solve(faces, {}, count_starting_patches(faces, {}));
  CHECK(usual.seconds > 0);
  const auto with = [&](auto&& change) {
    SolverSettings settings;
    change(settings);
    return forecast_solve(faces, settings, count_starting_patches(faces, settings));
  };
  CHECK(with([](SolverSettings& s) { s.rays = 1024; }).seconds > 2 * usual.seconds);
  CHECK(with([](SolverSettings& s) { s.pass_count_max = 1000; }).seconds > usual.seconds);
  const Forecast fine = with([](SolverSettings& s) { s.patch_size = 0.003f, s.patch_count_max = 2'000'000; });
  CHECK(fine.seconds > 2 * usual.seconds);
  CHECK(fine.bytes > 2 * usual.bytes);
  const Forecast coarse = with([](SolverSettings& s) { s.patch_count_max = 1000; });
  CHECK(coarse.elements <= 1000);
  CHECK(coarse.patches <= 1000);
  const Forecast again = with([](SolverSettings& s) { s.keep_rows = false; });
  CHECK(again.seconds > usual.seconds);
  CHECK(again.bytes < usual.bytes / 2);
  FaceTable more = make_lit_room();
  for (int k = 0; k < 200; ++k) {
    const float low = static_cast<float>(k) * 1e-3f;
    add_box_outward(more, Vec3(low), Vec3(low + 1e-4f), make_surface(0, 0.5f));
  }
  CHECK(forecast_solve(more, {}, count_starting_patches(more, {})).seconds > usual.seconds);
  CHECK(forecast_film_seconds(more, 1000) > forecast_film_seconds(faces, 1000));
}

TEST_CASE("the largest settings have a forecast") {
  SolverSettings settings;
  settings.rays = 1'000'000;
  settings.patch_count_max = 1'000'000'000;
  settings.pass_count_max = 1'000'000;
  settings.patch_size = 1e-30f;
  settings.keep_rows = false;
  const Forecast forecast =
      forecast_solve(make_lit_room(), settings, count_starting_patches(make_lit_room(), settings));
  CHECK(std::isfinite(forecast.seconds));
  CHECK(forecast.seconds > 1e8);
  CHECK(std::isfinite(forecast.bytes));
}
