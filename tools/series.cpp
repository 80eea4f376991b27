// Rounds, passes and snapshots -> frames and panels -> files.
#include "series.h"

#include "exporters.h"
#include "exposure.h"
#include "pictures.h"
#include "plots.h"

#include <fmt/format.h>

#include <memory>

namespace patchlight {
namespace {

constexpr double kFrameSeconds = 1, kShotSeconds = 0.3, kLastFrameSeconds = 3;
constexpr const char* kDot = " \xc2\xb7 ";

// What all passes after `pass` added, W, as the eye weighs the channels.
double find_watts(const Run& run, size_t pass) {
  DRgb power(0);
  for (; pass < run.solution.log.passes.size(); ++pass) power += run.solution.log.passes[pass].added_power;
  const double metres = run.scene.metres_per_length();
  return double{luminance(Rgb(power))} * metres * metres;
}

std::string label_step(const Run& run) {
  const std::string_view step = run.plan.solver->step;
  if (run.plan.solver->takes_one_step) return std::string(step);
  return fmt::format("{} {}{}", step, run.solution.log.passes.back().pass,
                     run.report.stopped_reason == "converged" ? " (converged)" : "");
}

std::string label_added(const Run& run, uint32_t after) {
  const std::string_view step = run.plan.solver->step;
  const uint32_t last = run.solution.log.passes.back().pass;
  if (run.plan.solver->takes_one_step) return "added to emission";
  if (last == after + 1) return fmt::format("added by {} {}", step, last);
  return fmt::format("added by {} {} to {}", name_steps(step), after + 1, last);
}

Picture shrink_panel(const Run& run, const Picture& picture) {
  const uint32_t width = find_panel_width(run.plan.snapshots.size(), picture.width);
  const uint64_t height = uint64_t{picture.height} * width / picture.width;
  return shrink_picture(picture, width, static_cast<uint32_t>(std::max<uint64_t>(height, 1)));
}

// Sends a picture of all that was taken to its file, beside the run.
template <class Encode>
void send_file(Run& run, size_t camera, std::string_view ending, Encode encode) {
  const std::string path =
      fmt::format("{}/{}-{}", run.folder, name_camera(run.plan, run.plan.cameras[camera]), ending);
  // Jobs are copied: what they hold need not be.
  const auto job = std::make_shared<Encode>(std::move(encode));
  push_job(run.jobs, [path, job] { write_file(path, (*job)()); });
  run.pictures.push_back(path);
}

// A frame a camera: the light after the last step.
void add_step_frames(const Run& run, std::vector<Animation>& animations, double seconds,
                     std::span<const Rgb> shown) {
  const std::string label = fmt::format("{}{}+{}", label_step(run), kDot,
                                        format_watts(find_watts(run, run.solution.log.passes.size() - 1)));
  animations.resize(run.films.size());
  for (size_t k = 0; k < run.films.size(); ++k)
    add_frame(animations[k], take_picture(run, run.films[k], shown, PixelKind::kDisplay), label, seconds);
}

}  // namespace

void take_round(Run& run) {
  if (!run.plan.animate_rounds) return;
  Stopwatch watch;
  const Solution& solution = run.solution;
  std::vector<FilmTable> films;
  std::vector<float> brightness;
  for (const Camera& camera : run.plan.cameras) {
    films.push_back(make_film(make_scenery(solution), make_view(camera),
                              {.smooth = false, .mesh_lines = true, .seed = run.scene.solver.seed}));
    run.report.film_rays += films.back().ray_count;
    collect_brightness(brightness, films.back(), solution.mesh.elements.radiosity, solution, run.scene.faces,
                       false);
  }
  // The exposure of the run is not known yet; the first round is near to it.
  if (!run.series.round_ev)
    run.series.round_ev = run.scene.output.exposure_ev.value_or(pick_exposure_ev(brightness));
  const std::vector<Rgb> shown =
      expose_values(solution.mesh.elements.radiosity, *run.series.round_ev, run.plan.look.tone);
  run.series.rounds.resize(films.size());
  for (size_t k = 0; k < films.size(); ++k) {
    Picture picture{films[k].width, films[k].height, expose(films[k], shown)};
    draw_mesh_lines(picture.pixels, films[k].line_cover);
    const RoundReport& round = solution.log.rounds.back();
    add_frame(run.series.rounds[k], picture,
              fmt::format("round {}{}{} patches", round.round, kDot, round.patch_count), kFrameSeconds);
  }
  run.report.seconds.render += watch.lap();
}

void take_pass(Run& run) {
  if (!run.plan.animate_passes) return;
  Stopwatch watch;
  add_step_frames(run, run.series.passes, kFrameSeconds,
                  show_values(run, pick_light(run.light, find_radiosity(run), run.plan.look.light)));
  run.report.seconds.render += watch.lap();
}

void take_snapshot(Run& run, const std::vector<Rgb>& radiosity, std::span<const Rgb> shown) {
  if (!run.plan.storyboard && !run.plan.animate_shots) return;
  Series& series = run.series;
  if (run.plan.animate_shots) add_step_frames(run, series.shots, kShotSeconds, shown);
  if (!run.plan.storyboard) return;
  const std::vector<Rgb> added =
      color_values(series.added_scale, find_added({.first = {}, .before = series.told, .now = radiosity}));
  series.storyboards.resize(run.films.size());
  for (size_t k = 0; k < run.films.size(); ++k) {
    const FilmTable& film = run.films[k];
    Picture colored{film.width, film.height, expose(film, added)};
    fill_nothing(colored.pixels, film, kNothingColor);
    Picture lit{film.width, film.height, expose(film, shown)};
    if (run.plan.look.false_color != FalseColor::kOff) fill_nothing(lit.pixels, film, kNothingColor);
    series.storyboards[k].panels.push_back(
        {label_step(run), fmt::format("reflects {}", format_watts(find_watts(run, 0))),
         shrink_panel(run, lit), label_added(run, series.told_pass),
         fmt::format("+{}", format_watts(find_watts(run, series.told_pass))), shrink_panel(run, colored)});
  }
  series.told = radiosity;
  series.told_pass = run.solution.log.passes.back().pass;
}

void write_series(Run& run) {
  Stopwatch watch;
  Series& series = run.series;
  for (size_t k = 0; k < series.storyboards.size(); ++k) {
    Storyboard& storyboard = series.storyboards[k];
    storyboard.title = run.scene.title.empty() ? run.plan.stem : run.scene.title;
    if (run.plan.cameras_named) storyboard.title += ": " + run.plan.cameras[k].name;
    storyboard.note = fmt::format("{} patches", run.solution.mesh.elements.size());
    if (run.plan.look.false_color == FalseColor::kOff)
      storyboard.note += fmt::format("{}EV {:.2f}", kDot, *run.scene.output.exposure_ev);
    else
      storyboard.scales.push_back(run.scale);
    storyboard.scales.push_back(series.added_scale);
    send_file(run, k, "storyboard.png",
              [picture = compose_storyboard(storyboard)] { return encode_png(picture); });
  }
  for (auto& [animations, ending] : {std::pair{&series.passes, "passes.gif"},
                                     {&series.rounds, "rounds.gif"},
                                     {&series.shots, "shots.gif"}})
    for (size_t k = 0; k < animations->size(); ++k) {
      (*animations)[k].seconds.back() = kLastFrameSeconds;
      send_file(run, k, ending, [animation = std::move((*animations)[k])] { return encode_gif(animation); });
    }
  series = {};
  run.report.seconds.write += watch.lap();
}

void write_plots(Run& run) {
  if (!wants(run, PixelKind::kPlots)) return;
  Stopwatch watch;
  const PlotText text{.title = run.scene.title.empty() ? run.plan.stem : run.scene.title,
                      .step = run.plan.solver->step,
                      .metres_per_length = run.scene.metres_per_length(),
                      .until = run.scene.solver.until};
  const std::string stem = run.folder + "/" + run.plan.stem;
  for (const auto& [path, svg] :
       {std::pair{stem + "-convergence.svg", plot_convergence(run.solution.log.passes, text)},
        std::pair{stem + "-rounds.svg", plot_rounds(run.solution.log.rounds, text)}}) {
    write_file(path, svg);
    run.tables.push_back(path);
  }
  run.report.seconds.write += watch.lap();
}

}  // namespace patchlight
