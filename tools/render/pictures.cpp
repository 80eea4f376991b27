// A solution under way -> the pixels of its pictures.
#include "tools/render/pictures.h"

#include "tools/export/lit_mesh.h"
#include "tools/image/exposure.h"
#include "tools/image/false_colors.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace patchlight {
namespace {

uint64_t count_film_bytes(const FilmTable& film) {
  return film.pixel_first.size() * sizeof(uint64_t) + film.value.size() * sizeof(uint32_t) +
         film.weight.size() * sizeof(float) + film.line_cover.size() * sizeof(float) +
         film.sky_share.size() * (2 * sizeof(float) + sizeof(Rgb));
}

void make_films(PictureState& pictures, const Task& task, const Solution& solution) {
  for (const Camera& camera : task.plan.cameras) {
    const FilmSettings settings{
        .smooth = is_smooth(task), .mesh_lines = task.plan.mesh, .seed = task.scene.solver.seed};
    pictures.films.push_back(make_film(make_scenery(solution), make_view(camera), settings));
    pictures.ray_count += pictures.films.back().ray_count;
    pictures.bytes += count_film_bytes(pictures.films.back());
    if (!task.plan.has_layers()) continue;
    pictures.centres.push_back(find_centres(*solution.surfaces, solution.mesh.elements, make_view(camera)));
    const size_t pixel_count = pictures.centres.back().element.size();
    pictures.ray_count += pixel_count;
    pictures.bytes += pixel_count * (sizeof(uint32_t) + sizeof(float));
  }
}

// The mean over each element's corners of what is known at vertices.
std::vector<Rgb> average_corners(const Solution& solution, std::span<const Rgb> vertex_values) {
  const FaceTable& faces = solution.surfaces->faces;
  const Mesh& mesh = solution.mesh;
  std::vector<Rgb> values(mesh.elements.size());
  for (size_t row = 0; row < values.size(); ++row) {
    const int corner_count = faces.corner_count[mesh.elements.face[row]];
    for (int k = 0; k < corner_count; ++k)
      values[row] += vertex_values[mesh.element_vertices.leaf_vertex[row][k]];
    values[row] /= static_cast<float>(corner_count);
  }
  return values;
}

// One exposure for all pictures of the run, from the forecast of the refinement rounds and not from a pass.
double pick_exposure(const Task& task, const PictureState& pictures, const Solution& solution,
                     std::span<const Rgb> forecast) {
  if (task.scene.output.exposure_ev) return *task.scene.output.exposure_ev;
  std::vector<float> brightness;
  for (const FilmTable& film : pictures.films)
    collect_brightness(brightness, film, forecast, solution, task.scene.faces, is_smooth(task));
  return pick_exposure_ev(brightness);
}

// The same for false colours, and for what storyboards show as added.
void fix_scales(PictureState& pictures, const Task& task, const Solution& solution,
                std::span<const Rgb> forecast) {
  const Look& look = task.plan.look;
  std::vector<float> values;
  float brightest = 0;
  for (const FilmTable& film : pictures.films) {
    collect_brightness(values, film, forecast, solution, task.scene.faces, is_smooth(task));
    for (const Rgb& pixel : expose(film, forecast)) brightest = std::max(brightest, luminance(pixel));
    for (const Rgb& sky : film.sky) brightest = std::max(brightest, luminance(sky));
  }
  const ColorScale radiosity = pick_radiosity_scale(values, brightest, look.scale);
  pictures.added_scale = make_added_scale(radiosity, look.scale);
  if (look.false_color != nullptr)
    pictures.scale = look.false_color->make_scale(radiosity, look.scale, solution.mesh.elements);
}

}  // namespace

bool is_smooth(const Task& task) {
  const FalseColor* color = task.plan.look.false_color;
  return task.scene.output.shading == Shading::kSmooth && !(color != nullptr && color->of_patches);
}

View make_view(const Camera& camera) {
  return {.eye = Vec3(camera.eye),
          .target = Vec3(camera.target),
          .up = Vec3(camera.up),
          .fov_degrees = static_cast<float>(camera.fov_degrees),
          .width = camera.width,
          .height = camera.height,
          .projection = camera.projection};
}

bool shows_sky(const Plan& plan) { return plan.look.light != Light::kIndirect; }

std::vector<Rgb> find_radiosity(const Task& task, const Solution& solution) {
  return is_smooth(task) ? vertex_radiosity(solution, find_shown_ambient(task.scene, solution))
                         : solution.mesh.elements.radiosity;
}

PictureState start_pictures(const Task& task, const Solution& solution) {
  PictureState pictures;
  if (makes_films(task.plan, task.scene)) make_films(pictures, task, solution);
  if (task.plan.is_exposed()) {
    std::vector<Rgb> forecast = vertex_radiosity_forecast(solution);
    if (!is_smooth(task)) forecast = average_corners(solution, forecast);
    pictures.exposure_ev = pick_exposure(task, pictures, solution, forecast);
    if (task.plan.look.false_color != nullptr || task.plan.storyboard)
      fix_scales(pictures, task, solution, forecast);
  }
  keep_light(pictures.light, task, solution);
  return pictures;
}

void keep_light(LightHistory& light, const Task& task, const Solution& solution) {
  const Plan& plan = task.plan;
  if (!plan.has_pictures()) return;
  if (plan.shows_passes()) {
    light.before = std::move(light.now);
    light.now = find_radiosity(task, solution);
  }
  if (solution.log.passes.size() == 1 && plan.solver->goes_by_bounces &&
      (plan.look.light != Light::kAll || plan.has_layers()))
    light.first = find_radiosity(task, solution);
}

void check_values(std::span<const Rgb> radiosity, size_t pass_count, const std::string& scene_file,
                  Talk& talk) {
  const auto count = std::count_if(radiosity.begin(), radiosity.end(), [](const Rgb& value) {
    return !(value.r >= 0 && value.g >= 0 && value.b >= 0 && std::isfinite(value.r + value.g + value.b));
  });
  if (count == 0) return;
  say_warning(talk, "bad-radiosity",
              fmt::format("after pass {}, {} of {} values that pictures show are negative or no numbers",
                          pass_count, count, radiosity.size()),
              scene_file);
}

std::vector<Rgb> show_values(const Task& task, const PictureState& pictures, const Solution& solution,
                             std::span<const Rgb> lit) {
  const Look& look = task.plan.look;
  if (look.false_color != nullptr)
    return look.false_color->find_colors(pictures.scale, {solution, lit, pictures.light});
  return expose_values(lit, *pictures.exposure_ev, look.tone);
}

Picture show_film(const Task& task, const PictureState& pictures, size_t camera, std::span<const Rgb> shown) {
  const FilmTable& film = pictures.films[camera];
  Picture picture{film.width, film.height, expose(film, shown)};
  const FalseColor* color = task.plan.look.false_color;
  const bool colored = color != nullptr, with_sky = shows_sky(task.plan) && (!colored || color->of_light);
  if (with_sky && colored) {
    const SkyValues sky = find_sky_values(film);
    add_sky(picture.pixels, film,
            {color_luminances(pictures.scale, sky.plain), color_luminances(pictures.scale, sky.with_sun)});
  } else if (with_sky) {
    show_sky(picture.pixels, film, *pictures.exposure_ev, task.plan.look.tone);
  }
  if (colored) fill_nothing(picture.pixels, film, kNothingColor, with_sky);
  if (task.plan.mesh) draw_mesh_lines(picture.pixels, film.line_cover);
  if (colored) draw_legend(picture, pictures.scale);
  return picture;
}

void add_layers(Picture& picture, const Task& task, const PictureState& pictures, size_t camera,
                std::span<const Rgb> radiosity) {
  constexpr const char* kEndings[3] = {".R", ".G", ".B"};
  for (const Light light : {Light::kDirect, Light::kIndirect}) {
    if (!task.plan.solver->goes_by_bounces) break;
    const FilmTable& film = pictures.films[camera];
    std::vector<Rgb> pixels = expose(film, pick_light(pictures.light, radiosity, light));
    if (light == Light::kDirect) add_sky(pixels, film, find_sky_values(film));
    for (int k = 0; k < 3; ++k) {
      Channel& channel = picture.channels.emplace_back();
      channel.name = kLightNames[static_cast<size_t>(light)] + kEndings[k];
      for (const Rgb& pixel : pixels) channel.values.push_back(pixel[k]);
    }
  }
  const CentreTable& centres = pictures.centres[camera];
  Channel depth{"Z", centres.depth, {}}, patch{"id", {}, centres.element};
  for (float& z : depth.values) z *= static_cast<float>(task.scene.units_per_length);
  // 1 is the first row of the table of patches; kNone + 1 is 0.
  for (uint32_t& id : patch.numbers) ++id;
  picture.channels.push_back(std::move(depth));
  picture.channels.push_back(std::move(patch));
}

}  // namespace patchlight
