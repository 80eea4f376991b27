#include "engine/film/film.h"

#include "engine/light/lambert.h"
#include "tests/scenes.h"

#include <doctest/doctest.h>

using namespace patchlight;

namespace {

FaceTable make_room(bool with_lamp) {
  FaceTable faces;
  BoxSurfaces surfaces = make_box_surfaces(make_surface(0, 0.5f));
  if (!with_lamp) surfaces = make_box_surfaces(make_surface(0.5f, 0.5f));
  add_box_inward(faces, Vec3(0), Vec3(0.4f), surfaces);
  if (with_lamp)
    add_quad(faces, {0.15f, 0.399f, 0.15f}, {0.25f, 0.399f, 0.15f}, {0.25f, 0.399f, 0.25f},
             {0.15f, 0.399f, 0.25f}, make_surface(10, 0));
  return faces;
}

View make_view(Vec3 eye, Vec3 target, uint32_t width, uint32_t height) {
  View view;
  view.eye = eye, view.target = target, view.up = {0, 1, 0};
  view.width = width, view.height = height;
  return view;
}

double weight_sum(const FilmTable& film, size_t pixel) {
  double sum = 0;
  for (uint64_t k = film.pixel_first[pixel]; k < film.pixel_first[pixel + 1]; ++k) sum += film.weight[k];
  return sum;
}

void check_shape(const FilmTable& film, const View& view, size_t value_count) {
  REQUIRE(film.width == view.width);
  REQUIRE(film.height == view.height);
  REQUIRE(film.pixel_first.size() == size_t{view.width} * view.height + 1);
  REQUIRE(film.pixel_first.back() == film.value.size());
  REQUIRE(film.weight.size() == film.value.size());
  for (const uint32_t value : film.value) REQUIRE(value < value_count);
  for (const float weight : film.weight) REQUIRE(weight >= 0);
}

}  // namespace

TEST_CASE("film: in a closed room the weights of every pixel sum to 1") {
  const FaceTable faces = make_room(true);
  const Solution run = solve_scene(faces, {}, 1);
  const View view = make_view({0.1f, 0.1f, 0.35f}, {0.3f, 0.25f, 0.05f}, 40, 30);
  for (const bool smooth : {true, false}) {
    const FilmTable film = make_film(make_scenery(run), view, {smooth, false, 1});
    check_shape(film, view, smooth ? run.mesh.element_vertices.size() : run.mesh.elements.size());
    // Sums of 1024 shares at most, each rounded.
    for (size_t pixel = 0; pixel < 1200; ++pixel) CHECK(std::abs(weight_sum(film, pixel) - 1) <= 1e-5);
    CHECK(film.ray_count >= 1200 * 16);
    CHECK(film.line_cover.empty());
  }
}

TEST_CASE("film: a furnace looks alike everywhere, smooth and flat") {
  const FaceTable faces = make_room(false);
  const Solution run = solve_scene(faces, {}, 30);
  const View view = make_view({0.1f, 0.1f, 0.35f}, {0.3f, 0.25f, 0.05f}, 24, 16);
  const FilmTable smooth = make_film(make_scenery(run), view, {true, false, 1});
  const FilmTable flat = make_film(make_scenery(run), view, {false, false, 1});
  for (const Rgb& pixel : expose(smooth, vertex_radiosity(run)))
    CHECK(pixel.g == doctest::Approx(1).epsilon(1e-3));
  for (const Rgb& pixel : expose(flat, run.mesh.elements.radiosity))
    CHECK(pixel.g == doctest::Approx(1).epsilon(1e-3));
}

TEST_CASE("film: a closed room can be looked into through its back sides, and light does not pass them") {
  const FaceTable faces = make_room(true);
  const Solution run = solve_scene(faces, {}, 2);
  const View view = make_view({0.2f, 0.2f, 2}, {0.2f, 0.2f, 0.2f}, 16, 16);
  const FilmTable film = make_film(make_scenery(run), view, {true, false, 1});
  // The back wall, 2 away and 0.4 wide, is less than the picture: background all round.
  CHECK(weight_sum(film, 8 * 16 + 8) == doctest::Approx(1).epsilon(1e-5));
  CHECK(weight_sum(film, 0) == 0);
  // Not the front wall, whose back is nearest, but what lies behind it.
  const FilmTable flat = make_film(make_scenery(run), view, {false, false, 1});
  for (const uint32_t element : flat.value) CHECK(run.mesh.elements.face[element] != kFront);
}

TEST_CASE("film: a pixel's weights sum to the share of it that shows the scene") {
  FaceTable faces;
  add_quad(faces, {-0.5f, -0.5f, 0}, {0.5f, -0.5f, 0}, {0.5f, 0.5f, 0}, {-0.5f, 0.5f, 0},
           make_surface(1, 0.5f));
  const Solution run = solve_scene(faces, {}, 1);
  View view = make_view({0, 0, 1}, Vec3(0), 9, 9);
  // The picture is 1.125 wide at the square: it covers 8 x 8 of the 9 x 9 pixels.
  view.fov_degrees = static_cast<float>(2 * std::atan(1.125 / 2) * 180 / std::numbers::pi);
  const FilmTable film = make_film(make_scenery(run), view, {true, false, 1});
  double sum = 0;
  for (size_t pixel = 0; pixel < 81; ++pixel) sum += weight_sum(film, pixel);
  // 32 pixels along the border, half or a quarter covered, each in 4 x 4 strata at least, of which a row of
  // four falls either way: four standard errors.
  CHECK(std::abs(sum - 64) <= 4 * std::sqrt(32.0) * 2 / 16);
  CHECK(weight_sum(film, 40) == doctest::Approx(1).epsilon(1e-5));
  const auto picture = expose(film, vertex_radiosity(run));
  CHECK(picture[40].g == doctest::Approx(1).epsilon(1e-5));
}

TEST_CASE("film: x grows to the right and y downwards") {
  FaceTable faces;
  add_quad(faces, {0.1f, 0.1f, 0}, {0.5f, 0.1f, 0}, {0.5f, 0.5f, 0}, {0.1f, 0.5f, 0}, make_surface(1, 0));
  const Solution run = solve_scene(faces, {}, 1);
  const View view = make_view({0, 0, 1}, Vec3(0), 8, 8);
  const FilmTable film = make_film(make_scenery(run), view, {true, false, 1});
  for (size_t pixel = 0; pixel < 64; ++pixel)
    if (weight_sum(film, pixel) > 0) {
      CHECK(pixel % 8 >= 4);
      CHECK(pixel / 8 < 4);
    }
  CHECK(weight_sum(film, 1 * 8 + 6) > 0);
}

TEST_CASE("film: a lamp far smaller than a pixel is not missed") {
  FaceTable faces = make_room(true);
  // Its light on the picture: the share of the pixels that it covers, times what it sends.
  const float h = 0.00125f;
  const Vec3 c(0.22f, 0.17f, 0.001f);
  add_quad(faces, c + Vec3(-h, -h, 0), c + Vec3(h, -h, 0), c + Vec3(h, h, 0), c + Vec3(-h, h, 0),
           make_surface(1e6f, 0));
  const Solution run = solve_scene(faces, {}, 1);
  View view = make_view({0.2f, 0.2f, 0.38f}, {0.2f, 0.2f, 0}, 32, 32);
  const double pixel_width = 2 * std::tan(view.fov_degrees / 360 * std::numbers::pi) / 32;
  const double expected = 1e6 * std::pow(2 * h / 0.379 / pixel_width, 2);
  double mean = 0;
  constexpr uint32_t kSeeds = 16;
  for (uint64_t seed = 1; seed <= kSeeds; ++seed) {
    const FilmTable film = make_film(make_scenery(run), view, {true, false, seed});
    double lamp = 0;
    for (size_t pixel = 0; pixel < 1024; ++pixel)
      for (uint64_t k = film.pixel_first[pixel]; k < film.pixel_first[pixel + 1]; ++k) {
        const uint32_t v = film.value[k];
        const uint32_t row = run.mesh.element_vertices.vertex_leaf[run.mesh.element_vertices.vertex_first[v]];
        if (faces.emission[run.mesh.elements.face[row]].g > 1e5f) lamp += 1e6 * film.weight[k];
      }
    CHECK(lamp > 0);
    mean += lamp / kSeeds;
  }
  // It is 2.9 of the 16 strata of a pixel wide, so that one stratum at least lies in it whole, where the 4
  // strata of other pixels would often miss it. The 16 pictures count some 8 samples each.
  const double samples = expected / 1e6 * 256 * kSeeds;
  CHECK(std::abs(mean / expected - 1) <= 4 / std::sqrt(samples));
}

TEST_CASE("film: lines between elements cover a part of the picture, and only if asked for") {
  FaceTable faces;
  add_quad(faces, {-0.5f, -0.5f, 0}, {0.5f, -0.5f, 0}, {0.5f, 0.5f, 0}, {-0.5f, 0.5f, 0},
           make_surface(1, 0.5f));
  SolverSettings settings;
  settings.patch_size = 0.25f;
  const Solution run = solve_scene(faces, settings, 1);
  View view = make_view({0, 0, 1}, Vec3(0), 64, 64);
  view.fov_degrees = static_cast<float>(2 * std::atan(0.5) * 180 / std::numbers::pi);
  const FilmTable film = make_film(make_scenery(run), view, {true, true, 1});
  REQUIRE(film.line_cover.size() == 64 * 64);
  double cover = 0;
  for (const float c : film.line_cover) {
    CHECK(c >= 0);
    CHECK(c <= 1);
    cover += c / (64.0 * 64.0);
  }
  // Elements of one size: between n x n of them lie n - 1 lines a pixel wide each way.
  const double n = std::sqrt(static_cast<double>(run.mesh.elements.size()));
  const double expected = 2 * (n - 1) / 64 - std::pow((n - 1) / 64, 2);
  CHECK(std::abs(cover - expected) <= 0.1 * expected);
}

TEST_CASE("film: one view and seed give one film, whatever the threads") {
  const FaceTable faces = make_room(true);
  const Solution run = solve_scene(faces, {}, 1);
  const View view = make_view({0.1f, 0.1f, 0.35f}, {0.3f, 0.25f, 0.05f}, 40, 30);
  const FilmTable a = make_film(make_scenery(run), view, {true, false, 1});
  const FilmTable b = make_film(make_scenery(run), view, {true, false, 1});
  CHECK(a.value == b.value);
  CHECK(a.weight == b.weight);
}

TEST_CASE("film: the ray through a pixel's centre tells the element and the depth along the view") {
  FaceTable faces;
  add_quad(faces, {-0.5f, -0.5f, 0}, {0.5f, -0.5f, 0}, {0.5f, 0.5f, 0}, {-0.5f, 0.5f, 0},
           make_surface(1, 0.5f));
  const Solution run = solve_scene(faces, {}, 1);
  View view = make_view({0, 0, 2}, Vec3(0), 9, 5);
  view.fov_degrees = static_cast<float>(2 * std::atan(0.3) * 180 / std::numbers::pi);
  const CentreTable centres = find_centres(*run.surfaces, run.mesh.elements, view);
  REQUIRE(centres.element.size() == 45);
  REQUIRE(centres.depth.size() == 45);
  for (uint32_t pixel = 0; pixel < 45; ++pixel) {
    // The picture is 1.2 high at the square, a pixel 0.24.
    const float x = 0.24f * (static_cast<float>(pixel % 9) - 4),
                y = -0.24f * (static_cast<float>(pixel / 9) - 2);
    if (std::abs(x) > 0.5f) {
      CHECK(centres.element[pixel] == kNone);
      CHECK(std::isinf(centres.depth[pixel]));
      continue;
    }
    // The square is flat across the view: one depth everywhere.
    CHECK(centres.depth[pixel] == doctest::Approx(2).epsilon(1e-5));
    const PatchTable& elements = run.mesh.elements;
    const uint32_t row = centres.element[pixel];
    REQUIRE(row < elements.size());
    const auto corners =
        cell_corners(run.surfaces->frames, elements.face[row], elements.cell[row], elements.level[row]);
    CHECK(x >= corners[0].x - 1e-5f);
    CHECK(x <= corners[2].x + 1e-5f);
    CHECK(y >= corners[0].y - 1e-5f);
    CHECK(y <= corners[2].y + 1e-5f);
  }
}

TEST_CASE("film: a flat one can be made before the mesh is final") {
  const FaceTable faces = make_room(true);
  Solution solution = make_solution(make_surfaces(faces), {});
  const View view = make_view({0.1f, 0.1f, 0.35f}, {0.3f, 0.25f, 0.05f}, 16, 12);
  do {
    const FilmTable film = make_film(make_scenery(solution), view, {false, true, 1});
    check_shape(film, view, solution.mesh.elements.size());
    CHECK(film.line_cover.size() == 16 * 12);
  } while (refine(solution));
}

TEST_CASE("film: a lens finds the place of what it looks at, flat or as a hemisphere") {
  for (const Projection& projection : projections()) {
    View view = make_view({0.1f, 0.2f, 0.3f}, {0.5f, 0.1f, 0.9f}, 80, 60);
    view.projection = &projection;
    const Lens lens = make_lens(view);
    for (const Vec2& at : {Vec2(40, 30), Vec2(25.5f, 31), Vec2(50, 12), Vec2(60, 45.25f)}) {
      REQUIRE(lens.covers(at));
      const Vec3 direction = lens.find_direction(at);
      CHECK(length(direction) == doctest::Approx(1).epsilon(1e-6));
      Vec2 back(0);
      REQUIRE(lens.find_place(view.eye + 3.0f * direction, back));
      CHECK(length(back - at) < 1e-3f);
    }
    Vec2 none(0);
    CHECK(!lens.find_place(view.eye - lens.forward, none));
  }
}

TEST_CASE("film: in a hemisphere, angles from the middle are distances from it") {
  View view = make_view(Vec3(0), {0, 1, 0}, 100, 100);
  view.up = {0, 0, -1};
  view.projection = find_projection("fisheye");
  const Lens lens = make_lens(view);
  // Half way to the right: 45 degrees towards -x, which is on the right of who lies on the back, head to -z.
  const Vec3 direction = lens.find_direction({75, 50});
  CHECK(direction.x == doctest::Approx(-std::sqrt(0.5)).epsilon(1e-5));
  CHECK(direction.y == doctest::Approx(std::sqrt(0.5)).epsilon(1e-5));
  CHECK(lens.covers({99.9f, 50}));
  CHECK(!lens.covers({100.1f, 50}));
  CHECK(!lens.covers({1, 1}));
}

TEST_CASE("film: a hemisphere is full in a closed room, empty outside of its circle, and shows no backs") {
  const FaceTable faces = make_room(true);
  const Solution run = solve_scene(faces, {}, 1);
  View view = make_view({0.2f, 1e-5f, 0.2f}, {0.2f, 1, 0.2f}, 48, 48);
  view.up = {0, 0, -1};
  view.projection = find_projection("fisheye");
  const FilmTable film = make_film(make_scenery(run), view, {true, false, 1});
  check_shape(film, view, run.mesh.element_vertices.size());
  const Lens lens = make_lens(view);
  for (uint32_t pixel = 0; pixel < 48 * 48; ++pixel) {
    const Vec2 at(static_cast<float>(pixel % 48) + 0.5f, static_cast<float>(pixel / 48) + 0.5f);
    const float share = length(lens.from_middle(at));
    if (share < 0.96f) CHECK(weight_sum(film, pixel) == doctest::Approx(1).epsilon(1e-5));
    if (share > 1.04f) CHECK(weight_sum(film, pixel) == 0);
  }
  // Downwards from under the lamp: the floor. From above it: its back, which hides the floor and shows
  // nothing.
  view.eye = {0.2f, 0.3985f, 0.2f}, view.target = {0.2f, 0, 0.2f};
  const FilmTable down = make_film(make_scenery(run), view, {true, false, 1});
  CHECK(weight_sum(down, 24 * 48 + 24) == doctest::Approx(1).epsilon(1e-5));
  view.eye = {0.2f, 0.39995f, 0.2f};
  const FilmTable above = make_film(make_scenery(run), view, {true, false, 1});
  CHECK(weight_sum(above, 24 * 48 + 24) == 0);
}

TEST_CASE("film: the sky is behind everything, and a small sun in it has its size") {
  FaceTable faces;
  add_quad(faces, {0, 0, 0}, {0, 0, 1}, {1, 0, 1}, {1, 0, 0}, make_surface(0, 0.5f));
  Sky sky = make_overcast_sky(Rgb(70));
  sky.sun_direction = normalize(Vec3(0.2f, 1, 0.1f)), sky.sun_radius = 0.004f, sky.sun_emission = Rgb(1e6f);
  const Solution run = solve_scene(faces, {}, 1, sky);
  View view = make_view({0.5f, 0.2f, 0.5f}, {0.7f, 1.2f, 0.6f}, 60, 60);
  const FilmTable film = make_film(make_scenery(run), view, {});
  REQUIRE(film.sky.size() == 3600);
  const Lens lens = make_lens(view);
  double sun = 0;
  for (size_t pixel = 0; pixel < 3600; ++pixel) {
    CHECK(film.sky_share[pixel] == doctest::Approx(1).epsilon(1e-5));
    const Vec3 way = lens.find_direction(Vec2(float(pixel % 60) + 0.5f, float(pixel / 60) + 0.5f));
    // The middle of a pixel's samples is off its centre by a tenth of it at most, where it is 2 degrees wide.
    CHECK(film.sky[pixel].g == doctest::Approx(find_sky_emission(sky, way).g).epsilon(2e-3));
    sun += film.sun_share[pixel];
  }
  // pi tan^2 of the radius, in pixels; each is tan(30 degrees) / 30 wide. 256 samples a pixel tell a share of
  // 0.04 by half.
  const double side = std::tan(std::numbers::pi / 6) / 30;
  CHECK(sun == doctest::Approx(std::numbers::pi * 1.6e-5 / (side * side)).epsilon(0.3));
  // Exposed, a pixel is its share of the sky and of the disc.
  std::vector<Rgb> pixels = expose(film, vertex_radiosity(run));
  add_sky(pixels, film, find_sky_values(film));
  double all = 0, plain = 0;
  for (size_t pixel = 0; pixel < 3600; ++pixel)
    all += double{pixels[pixel].g}, plain += double{film.sky[pixel].g};
  CHECK(all == doctest::Approx(plain + 1e6 * sun).epsilon(1e-4));
  // A floor hides what is below it.
  view.eye = {0.5f, 1.0f, 0.5f}, view.target = {0.5f, 0, 0.5f}, view.up = {0, 0, -1}, view.fov_degrees = 40;
  for (const float share : make_film(make_scenery(run), view, {}).sky_share) CHECK(share == 0);
}

TEST_CASE("film: where there is no sky its columns are empty") {
  const FaceTable faces = make_room(true);
  const Solution run = solve_scene(faces, {}, 0);
  const FilmTable film = make_film(
      make_scenery(run), make_view({0.1f, 0.1f, 0.35f}, {0.3f, 0.25f, 0.05f}, 8, 8), {.smooth = false});
  CHECK(film.sky.empty());
  CHECK(find_sky_values(film).plain.empty());
}
