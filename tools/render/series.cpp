// Rounds, passes and snapshots -> frames and panels -> files.
#include "tools/render/series.h"

#include "tools/base/format.h"
#include "tools/export/exporters.h"
#include "tools/image/exposure.h"
#include "tools/render/pictures.h"

#include <fmt/format.h>

#include <memory>

namespace patchlight {
namespace {

constexpr double kFrameSeconds = 1, kShotSeconds = 0.3, kLastFrameSeconds = 3;
constexpr const char* kDot = " \xc2\xb7 ";

// What all passes after `pass` added, W, as the eye weighs the channels.
double find_watts(const Scene& scene, const Solution& solution, size_t pass) {
  DRgb power(0);
  for (; pass < solution.log.passes.size(); ++pass) power += solution.log.passes[pass].added_power;
  const double metres = scene.metres_per_length();
  return double{luminance(Rgb(power))} * metres * metres;
}

std::string label_step(const Plan& plan, const Solution& solution, bool converged) {
  const Solver& solver = *plan.solver;
  if (solver.takes_one_step) return std::string(solver.step);
  return fmt::format("{} {}{}", solver.step, solution.log.passes.back().pass,
                     converged ? " (converged)" : "");
}

std::string label_added(const Plan& plan, const Solution& solution, uint32_t after) {
  const Solver& solver = *plan.solver;
  const uint32_t last = solution.log.passes.back().pass;
  if (solver.takes_one_step) return "added to emission";
  if (last == after + 1) return fmt::format("added by {} {}", solver.step, last);
  return fmt::format("added by {} {} to {}", name_steps(solver.step), after + 1, last);
}

Picture shrink_panel(const Plan& plan, const Picture& picture) {
  const uint32_t width = find_panel_width(plan.snapshots.size(), picture.width);
  const uint64_t height = uint64_t{picture.height} * width / picture.width;
  return shrink_picture(picture, width, static_cast<uint32_t>(std::max<uint64_t>(height, 1)));
}

// Sends a picture of all that was taken to its file, beside the run.
template <class Encode>
void send_file(OutputFiles& files, const Plan& plan, size_t camera, std::string_view ending, Encode encode) {
  const std::string path =
      fmt::format("{}/{}-{}", files.folder, name_camera(plan, plan.cameras[camera]), ending);
  // Jobs are copied: what they hold need not be.
  const auto job = std::make_shared<Encode>(std::move(encode));
  push_job(files.jobs, [path, job] { write_file(path, (*job)()); });
  files.pictures.push_back(path);
}

// A frame a camera.
void add_step_frames(std::vector<Animation>& animations, const Task& task, const PictureState& pictures,
                     std::span<const Rgb> shown, const std::string& label, double seconds) {
  animations.resize(pictures.films.size());
  for (size_t k = 0; k < pictures.films.size(); ++k)
    add_frame(animations[k], show_film(task, pictures, k, shown), label, seconds);
}

// The last step and what it added.
std::string label_frame(const Task& task, const Solution& solution, bool converged) {
  return fmt::format("{}{}+{}", label_step(task.plan, solution, converged), kDot,
                     format_watts(find_watts(task.scene, solution, solution.log.passes.size() - 1)));
}

}  // namespace

void take_round(Series& series, const Task& task, const Solution& solution) {
  if (!task.plan.animate_rounds) return;
  const std::vector<Rgb>& radiosity = solution.mesh.elements.radiosity;
  std::vector<FilmTable> films;
  std::vector<float> brightness;
  for (const Camera& camera : task.plan.cameras) {
    films.push_back(make_film(make_scenery(solution), make_view(camera),
                              {.smooth = false, .mesh_lines = true, .seed = task.scene.solver.seed}));
    series.ray_count += films.back().ray_count;
    collect_brightness(brightness, films.back(), radiosity, solution, task.scene.faces, false);
  }
  // The exposure of the run is not known yet; the first round is near to it.
  if (!series.round_ev)
    series.round_ev = task.scene.output.exposure_ev.value_or(pick_exposure_ev(brightness));
  const std::vector<Rgb> shown = expose_values(radiosity, *series.round_ev, task.plan.look.tone);
  series.rounds.resize(films.size());
  for (size_t k = 0; k < films.size(); ++k) {
    Picture picture{films[k].width, films[k].height, expose(films[k], shown)};
    show_sky(picture.pixels, films[k], *series.round_ev, task.plan.look.tone);
    draw_mesh_lines(picture.pixels, films[k].line_cover);
    const RoundReport& round = solution.log.rounds.back();
    add_frame(series.rounds[k], picture,
              fmt::format("round {}{}{} patches", round.round, kDot, round.patch_count), kFrameSeconds);
  }
}

void start_storyboard(Series& series, const Task& task, const Solution& solution) {
  if (task.plan.storyboard) series.told = find_radiosity(task, solution);
}

void take_pass(Series& series, const Task& task, const PictureState& pictures, const Solution& solution,
               bool converged) {
  if (!task.plan.animate_passes) return;
  const std::vector<Rgb> lit =
      pick_light(pictures.light, find_radiosity(task, solution), task.plan.look.light);
  add_step_frames(series.passes, task, pictures, show_values(task, pictures, solution, lit),
                  label_frame(task, solution, converged), kFrameSeconds);
}

void take_snapshot(Series& series, const Task& task, const PictureState& pictures, const Solution& solution,
                   const Snapshot& snapshot) {
  const Plan& plan = task.plan;
  if (plan.animate_shots)
    add_step_frames(series.shots, task, pictures, snapshot.shown,
                    label_frame(task, solution, snapshot.converged), kShotSeconds);
  if (!plan.storyboard) return;
  const std::vector<Rgb> added = color_luminances(
      pictures.added_scale, find_added({.first = {}, .before = series.told, .now = snapshot.radiosity}));
  series.storyboards.resize(pictures.films.size());
  for (size_t k = 0; k < pictures.films.size(); ++k) {
    const FilmTable& film = pictures.films[k];
    Picture colored{film.width, film.height, expose(film, added)};
    fill_nothing(colored.pixels, film, kNothingColor);
    Picture lit{film.width, film.height, expose(film, snapshot.shown)};
    if (plan.look.false_color != nullptr)
      fill_nothing(lit.pixels, film, kNothingColor);
    else if (shows_sky(plan))
      show_sky(lit.pixels, film, *pictures.exposure_ev, plan.look.tone);
    series.storyboards[k].panels.push_back(
        {label_step(plan, solution, snapshot.converged),
         fmt::format("reflects {}", format_watts(find_watts(task.scene, solution, 0))),
         shrink_panel(plan, lit), label_added(plan, solution, series.told_pass),
         fmt::format("+{}", format_watts(find_watts(task.scene, solution, series.told_pass))),
         shrink_panel(plan, colored)});
  }
  series.told = snapshot.radiosity;
  series.told_pass = solution.log.passes.back().pass;
}

void write_series(OutputFiles& files, Series& series, const Task& task, const PictureState& pictures,
                  const Solution& solution) {
  const Plan& plan = task.plan;
  for (size_t k = 0; k < series.storyboards.size(); ++k) {
    Storyboard& storyboard = series.storyboards[k];
    storyboard.title = task.scene.title.empty() ? plan.stem : task.scene.title;
    if (plan.cameras_named) storyboard.title += ": " + plan.cameras[k].name;
    storyboard.note = fmt::format("{} patches", solution.mesh.elements.size());
    if (plan.look.false_color == nullptr)
      storyboard.note += fmt::format("{}EV {:.2f}", kDot, *pictures.exposure_ev);
    else
      storyboard.scales.push_back(pictures.scale);
    storyboard.scales.push_back(pictures.added_scale);
    send_file(files, plan, k, "storyboard.png", [picture = compose_storyboard(storyboard)] {
      return find_exporter("png").encode_picture(picture);
    });
  }
  for (auto& [animations, ending] : {std::pair{&series.passes, "passes.gif"},
                                     {&series.rounds, "rounds.gif"},
                                     {&series.shots, "shots.gif"}})
    for (size_t k = 0; k < animations->size(); ++k) {
      (*animations)[k].seconds.back() = kLastFrameSeconds;
      send_file(files, plan, k, ending, [animation = std::move((*animations)[k])] {
        return find_exporter("gif").encode_animation(animation);
      });
    }
  series.storyboards = {};
  series.passes = series.rounds = series.shots = {};
}

}  // namespace patchlight
