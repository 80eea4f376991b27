// A solution under way -> the pixels of its pictures.
#include "pictures.h"

#include "exposure.h"
#include "lit_mesh.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace patchlight {
namespace {

uint64_t count_film_bytes(const FilmTable& film) {
  return film.pixel_first.size() * sizeof(uint64_t) + film.value.size() * sizeof(uint32_t) +
         film.weight.size() * sizeof(float) + film.line_cover.size() * sizeof(float);
}

// Films show corners of patches, or one value a patch.
bool is_smooth(const Run& run) {
  return run.scene.output.shading == Shading::kSmooth && !is_of_patches(run.plan.look.false_color);
}

void make_films(Run& run) {
  for (const Camera& camera : run.plan.cameras) {
    const FilmSettings settings{
        .smooth = is_smooth(run), .mesh_lines = run.plan.mesh, .seed = run.scene.solver.seed};
    run.films.push_back(make_film(make_scenery(run.solution), make_view(camera), settings));
    run.report.film_rays += run.films.back().ray_count;
    run.report.film_bytes += count_film_bytes(run.films.back());
    if (!wants(run, PixelKind::kLayers)) continue;
    run.centres.push_back(
        find_centres(*run.solution.surfaces, run.solution.mesh.elements, make_view(camera)));
    const size_t pixel_count = run.centres.back().element.size();
    run.report.film_rays += pixel_count;
    run.report.film_bytes += pixel_count * (sizeof(uint32_t) + sizeof(float));
  }
}

// The mean over each element's corners of what is known at vertices.
std::vector<Rgb> average_corners(const Solution& solution, const FaceTable& faces,
                                 std::span<const Rgb> vertex_values) {
  std::vector<Rgb> values(solution.mesh.elements.size());
  for (size_t row = 0; row < values.size(); ++row) {
    const int corner_count = faces.corner_count[solution.mesh.elements.face[row]];
    for (int k = 0; k < corner_count; ++k)
      values[row] += vertex_values[solution.mesh.element_vertices.leaf_vertex[row][k]];
    values[row] /= static_cast<float>(corner_count);
  }
  return values;
}

// One exposure for all pictures of the run, from the forecast of the refinement rounds and not from a pass.
void fix_exposure(Run& run, std::span<const Rgb> forecast) {
  if (!run.scene.output.exposure_ev) {
    std::vector<float> brightness;
    for (const FilmTable& film : run.films)
      collect_brightness(brightness, film, forecast, run.solution, run.scene.faces, is_smooth(run));
    run.scene.output.exposure_ev = pick_exposure_ev(brightness);
  }
  run.report.exposure_ev = run.scene.output.exposure_ev;
}

// The same for false colours, and for what storyboards show as added.
void fix_scales(Run& run, std::span<const Rgb> forecast) {
  const Look& look = run.plan.look;
  std::vector<float> values;
  float brightest = 0;
  for (const FilmTable& film : run.films) {
    collect_brightness(values, film, forecast, run.solution, run.scene.faces, is_smooth(run));
    for (const Rgb& pixel : expose(film, forecast)) brightest = std::max(brightest, luminance(pixel));
  }
  run.scale = pick_radiosity_scale(values, brightest, look.scale);
  run.series.added_scale = make_residual_scale(run.scale, look.scale);
  if (look.false_color == FalseColor::kResidual) run.scale = run.series.added_scale;
  if (look.false_color == FalseColor::kLevel) run.scale = make_level_scale(run.solution.mesh.elements);
  if (look.false_color == FalseColor::kReason) run.scale = make_reason_scale();
}

// True if pictures show what single passes added.
bool wants_every_pass(const Run& run) { return run.plan.look.false_color == FalseColor::kResidual; }

}  // namespace

View make_view(const Camera& camera) {
  return {.eye = Vec3(camera.eye),
          .target = Vec3(camera.target),
          .up = Vec3(camera.up),
          .fov_degrees = static_cast<float>(camera.fov_degrees),
          .width = camera.width,
          .height = camera.height};
}

bool wants(const Run& run, PixelKind pixels) {
  for (const Exporter* exporter : run.plan.exporters)
    if (exporter->pixels == pixels) return true;
  return pixels == PixelKind::kDisplay && (run.plan.storyboard || run.plan.animate_shots);
}

std::vector<Rgb> find_radiosity(const Run& run) {
  return is_smooth(run) ? vertex_radiosity(run.solution, find_shown_ambient(run.scene, run.solution))
                        : run.solution.mesh.elements.radiosity;
}

void start_pictures(Run& run) {
  Stopwatch watch;
  if (makes_films(run.plan, run.scene)) make_films(run);
  if (run.plan.is_exposed()) {
    std::vector<Rgb> forecast = vertex_radiosity_forecast(run.solution);
    if (!is_smooth(run)) forecast = average_corners(run.solution, run.scene.faces, forecast);
    fix_exposure(run, forecast);
    if (run.plan.look.false_color != FalseColor::kOff || run.plan.storyboard) fix_scales(run, forecast);
  }
  run.report.seconds.render += watch.lap();
  keep_light(run);
}

void keep_light(Run& run) {
  if (!run.plan.has_pictures()) return;
  Stopwatch watch;
  const size_t pass = run.solution.log.passes.size();
  if (wants_every_pass(run)) {
    run.light.before = std::move(run.light.now);
    run.light.now = find_radiosity(run);
  }
  if (pass == 0 && run.plan.storyboard) run.series.told = find_radiosity(run);
  if (pass == 1 && run.plan.goes_by_passes() &&
      (run.plan.look.light != Light::kAll || wants(run, PixelKind::kLayers)))
    run.light.first = find_radiosity(run);
  run.report.seconds.render += watch.lap();
}

void check_values(Run& run, std::span<const Rgb> radiosity) {
  const auto count = std::count_if(radiosity.begin(), radiosity.end(), [](const Rgb& value) {
    return !(value.r >= 0 && value.g >= 0 && value.b >= 0 && std::isfinite(value.r + value.g + value.b));
  });
  if (count == 0) return;
  say_warning(run.talk, "bad-radiosity",
              fmt::format("after pass {}, {} of {} values that pictures show are negative or no numbers",
                          run.solution.log.passes.size(), count, radiosity.size()),
              run.scene.file);
}

std::vector<Rgb> show_values(const Run& run, std::span<const Rgb> lit) {
  switch (run.plan.look.false_color) {
    case FalseColor::kRadiosity:
      return color_values(run.scale, lit);
    case FalseColor::kResidual:
      return color_values(run.scale, find_added(run.light));
    case FalseColor::kLevel:
      return color_levels(run.scale, run.solution.mesh.elements);
    case FalseColor::kReason:
      return color_reasons(run.scale, run.solution.mesh.reasons);
    case FalseColor::kOff:
      break;
  }
  return expose_values(lit, *run.scene.output.exposure_ev, run.plan.look.tone);
}

Picture take_picture(const Run& run, const FilmTable& film, std::span<const Rgb> values, PixelKind pixels) {
  Picture picture{film.width, film.height, expose(film, values)};
  if (pixels != PixelKind::kDisplay) return picture;
  const bool colored = run.plan.look.false_color != FalseColor::kOff;
  if (colored) fill_nothing(picture.pixels, film, kNothingColor);
  if (run.plan.mesh) draw_mesh_lines(picture.pixels, film.line_cover);
  if (colored) draw_legend(picture, run.scale);
  return picture;
}

void add_layers(Picture& picture, const Run& run, size_t camera, std::span<const Rgb> radiosity) {
  constexpr const char* kEndings[3] = {".R", ".G", ".B"};
  for (const Light light : {Light::kDirect, Light::kIndirect}) {
    if (!run.plan.goes_by_passes()) break;
    const std::vector<Rgb> pixels = expose(run.films[camera], pick_light(run.light, radiosity, light));
    for (int k = 0; k < 3; ++k) {
      Channel& channel = picture.channels.emplace_back();
      channel.name = kLightNames[static_cast<size_t>(light)] + kEndings[k];
      for (const Rgb& pixel : pixels) channel.values.push_back(pixel[k]);
    }
  }
  const CentreTable& centres = run.centres[camera];
  Channel depth{"Z", centres.depth, {}}, patch{"id", {}, centres.element};
  for (float& z : depth.values) z *= static_cast<float>(run.scene.units_per_length);
  // 1 is the first row of the table of patches; kNone + 1 is 0.
  for (uint32_t& id : patch.numbers) ++id;
  picture.channels.push_back(std::move(depth));
  picture.channels.push_back(std::move(patch));
}

}  // namespace patchlight
