// The verb view: solve as render does, then look out from a patch: all directions before it in a circle.
#include "tools/verbs/view.h"

#include "dsl/report/diagnostics.h"
#include "engine/base/parallel.h"
#include "engine/base/sampling.h"
#include "engine/film/film.h"
#include "tools/base/files.h"
#include "tools/base/flag_values.h"
#include "tools/base/format.h"
#include "tools/base/start.h"
#include "tools/base/stop.h"
#include "tools/export/exporters.h"
#include "tools/image/exposure.h"
#include "tools/image/lettering.h"
#include "tools/render/solve.h"
#include "tools/verbs/flag_groups.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

namespace patchlight {
namespace {

constexpr const char* kHelp =
    R"(Shows what a patch sees: all directions before it in a circle, the normal in the middle, 90 degrees off it at the rim.

Examples:
  patchlight view room.yaml --from hall.floor@0.5,0.5
  patchlight view room.yaml --from 'pillars[0].2@0.5,0.8' --pass 0 --label    before any light is sent
  patchlight view room.yaml --from 'pillars[0].2@0.5,0.8' --pass 1 --label    and once direct light is there

u,v: 0..1 along the polygon's first edge and across, in the rectangle around it. Back sides are black.
)";

const Rgb kRing{0.21f};

// "hall.floor@0.5,0.8" over `view`: what follows the last @ are u and v, 0..1.
ViewOptions parse_place(const std::string& text, ViewOptions view) {
  const size_t at = text.rfind('@');
  const std::vector<std::string> uv =
      at == std::string::npos ? std::vector<std::string>{} : split_list(text.substr(at + 1));
  if (at == 0 || uv.size() != 2)
    fail_usage(
        fmt::format("--from: found '{}', expected a polygon's id and a point of it, such as "
                    "hall.floor@0.5,0.8",
                    escape_text(text)));
  view.polygon = text.substr(0, at);
  view.u = parse_number("--from", uv[0], 0, 1);
  view.v = parse_number("--from", uv[1], 0, 1);
  return view;
}

// The row of a polygon's id.
uint32_t find_polygon(const Scene& scene, const std::string& id) {
  const std::vector<std::string>& ids = scene.polygons.id;
  const auto row = std::find(ids.begin(), ids.end(), id);
  if (row != ids.end()) return static_cast<uint32_t>(row - ids.begin());
  // An object of several polygons: name one of them.
  const auto part = std::find_if(ids.begin(), ids.end(), [&](const std::string& other) {
    return other.size() > id.size() && other.starts_with(id) &&
           (other[id.size()] == '.' || other[id.size()] == '[');
  });
  const std::string near = part != ids.end() ? *part : did_you_mean(id, ids);
  throw UserError(
      "usage",
      fmt::format("--from: no polygon '{}'{}", escape_text(id),
                  near.empty()        ? ""
                  : part != ids.end() ? fmt::format("; its parts have names such as '{}'", escape_text(near))
                                      : fmt::format("; did you mean '{}'?", escape_text(near))));
}

bool is_on_face(const FaceFrameTable& frames, uint32_t face, Vec3 point) {
  constexpr float kSlack = 1e-4f;
  const Vec2 uv = find_face_parameters(frames, face, point);
  if (!(uv.x >= -kSlack && uv.y >= -kSlack)) return false;
  return frames.triangle[face] ? uv.x + uv.y <= 1 + kSlack : uv.x <= 1 + kSlack && uv.y <= 1 + kSlack;
}

// What the eye of a patch would see, upright where that has a meaning.
View make_patch_view(const PatchPlace& place, uint32_t size) {
  const Vec3 eye = place.point + ray_offset(place.point) * place.normal;
  const bool lies = std::abs(place.normal.y) > 0.9f;
  return {.eye = eye,
          .target = eye + place.normal,
          .up = lies ? Vec3(0, 0, -1) : Vec3(0, 1, 0),
          .width = size,
          .height = size,
          .projection = find_projection("fisheye")};
}

// Grey around the circle, with a smooth border.
void draw_ring(Picture& picture, const View& view) {
  const Lens lens = make_lens(view);
  for (uint32_t y = 0; y < picture.height; ++y)
    for (uint32_t x = 0; x < picture.width; ++x) {
      const Vec2 at(static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f);
      const float beyond = (length(lens.from_middle(at)) - 1) * lens.radius() + 0.5f;
      Rgb& pixel = picture.pixels[size_t{y} * picture.width + x];
      pixel += std::clamp(beyond, 0.0f, 1.0f) * (kRing - pixel);
    }
}

double pick_exposure(const Scene& scene, const Solution& solution, const FilmTable& film) {
  if (scene.output.exposure_ev) return *scene.output.exposure_ev;
  std::vector<float> brightness;
  collect_brightness(brightness, film, vertex_radiosity_forecast(solution), solution, scene.faces, true);
  return pick_exposure_ev(brightness);
}

// Solves as far as the picture needs; the picture is that of the last pass where the run converges before.
Picture solve(const Scene& scene, const Plan& plan, const ViewOptions& own, const View& view, double& ev,
              Talk& talk) {
  Solution solution;
  solve_mesh(solution, scene, talk);
  const FilmTable film = make_film(make_scenery(solution), view, {.seed = scene.solver.seed});
  ev = pick_exposure(scene, solution, film);
  if (own.pass > 0) take_steps(solution, plan, own.pass, talk);
  const std::vector<Rgb> shown = expose_values(vertex_radiosity(solution), ev, plan.look.tone);
  Picture picture{film.width, film.height, expose(film, shown)};
  show_sky(picture.pixels, film, ev, plan.look.tone);
  return picture;
}

}  // namespace

PatchPlace find_patch_place(const Scene& scene, const ViewOptions& view) {
  const uint32_t polygon = find_polygon(scene, view.polygon);
  const uint32_t first = scene.polygons.face_first[polygon], last = scene.polygons.face_first[polygon + 1];
  const auto fail = [&](const char* why) {
    throw UserError("usage",
                    fmt::format("--from: {:g},{:g} {} '{}'", view.u, view.v, why, escape_text(view.polygon)));
  };
  if (first == last) fail("lies on nothing: there is no area in");
  const Vec3 normal = scene.faces.normal[first];
  const Vec3 across = normalize(cross(normal, scene.polygons.first_edge[polygon]));
  const Vec3 along = cross(across, normal);
  Vec2 low(std::numeric_limits<float>::max()), high(-std::numeric_limits<float>::max());
  for (uint32_t f = first; f < last; ++f)
    for (const Vec3& corner : scene.faces.corners[f]) {
      const Vec2 at(dot(corner, along), dot(corner, across));
      low = min(low, at), high = max(high, at);
    }
  const Vec2 at = low + Vec2(static_cast<float>(view.u), static_cast<float>(view.v)) * (high - low);
  const Vec3 corner = scene.faces.corners[first][0];
  const Vec3 point = at.x * along + at.y * across + dot(corner, normal) * normal;
  const FaceFrameTable frames = make_face_frames(scene.faces);
  for (uint32_t f = first; f < last; ++f)
    if (is_on_face(frames, f, point)) return {point, normal};
  fail("lies outside of");
  return {};
}

void describe_view(Usage& usage, Options& options) {
  usage.help = kHelp;
  ViewOptions& view = options.own.emplace<ViewOptions>();
  add_scene(usage, options);
  add_value(usage, "--from", "ID@U,V", "a polygon and a point of it: 0..1 along its first edge and across",
            [&view](const std::string& text) { view = parse_place(text, view); });
  add_value(usage, "--pass", "N", "after that pass, 0 is emission alone; the last one unless given",
            [&view](const std::string& text) {
              view.pass = static_cast<uint32_t>(parse_count("--pass", text, 0, kPassesFlagMax));
              view.pass_asked = true;
            });
  add_value(usage, "--size", "N", "pixels either way; 720 unless given", [&view](const std::string& text) {
    view.size = static_cast<uint32_t>(parse_count("--size", text, 1, 1'000'000));
  });
  add_switch(usage, "--label", view.label, "write into the picture what it shows");
  add_exposure_flag(usage, options);
  add_tone_flag(usage, options);
  add_out_flag(usage, options);
  add_solver_flags(usage, options);
  add_talk_flags(usage, options);
  usage.checks.push_back([&view] {
    if (view.polygon.empty())
      fail_usage("view: say from where: --from ID@U,V, such as --from hall.floor@0.5,0.5");
  });
}

int view(const Options& asked, Talk& talk) {
  if (!asked.json) check_standard_output();
  ViewOptions own = get_own<ViewOptions>(asked);
  Options options = asked;
  options.size = {own.size, own.size};
  std::vector<Diagnostic> warnings;
  Scene scene = load_scene(options.scene, warnings, options.load);
  say_diagnostics(talk, warnings);
  const Plan plan = make_plan(scene, options);
  const uint32_t pass_count = scene.solver.pass_count_max;
  if (!own.pass_asked) own.pass = pass_count;
  if (own.pass > pass_count)
    throw UserError(
        "snapshot-beyond-passes",
        fmt::format("--pass {}: the run has {} passes at most; raise passes or ask for an earlier one",
                    own.pass, pass_count));
  const View from = make_patch_view(find_patch_place(scene, own), own.size);
  check_limits(scene, plan);
  const WorkersScope scope(start_workers(options, talk));
  const StopSignals signals(*current_workers());
  const OutputFolder folder = open_output_folder(options.out);
  try {
    double ev = 0;
    Picture picture = solve(scene, plan, own, from, ev, talk);
    draw_ring(picture, from);
    if (own.label)
      draw_label(picture,
                 fmt::format("{} @ {:g}, {:g} \xc2\xb7 pass {}", own.polygon, own.u, own.v, own.pass));
    const std::string path = fmt::format("{}/{}-view-{}@{:g},{:g}-pass-{:02}.png", folder.path, plan.stem,
                                         own.polygon, own.u, own.v, own.pass);
    write_file(path, find_exporter("png").encode_picture(picture));
    say_progress_done(talk);
    say(talk, fmt::format("exposure: EV {0:.2f}; --exposure {0:.2f} repeats it", ev));
    if (!options.json) print_result(path + "\n");
  } catch (const Cancelled&) {
    say(talk, "stopped by a signal; there is no picture");
    return 128 + stop_signal();
  }
  return 0;
}

}  // namespace patchlight
