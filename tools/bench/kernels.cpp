// The kernels on a scene to rates. Rays are compared on the same rays: those of the engine's own kernels, on
// tape.
#include "dsl/scene/scene.h"
#include "engine/base/parallel.h"
#include "engine/film/film.h"
#include "engine/light/direct.h"
#include "engine/mesh/vertices.h"
#include "engine/solve/solution.h"
#include "engine/trace/ray_tape.h"
#include "engine/transport/gather.h"
#include "engine/transport/rows.h"
#include "engine/transport/sources.h"
#include "tools/bench/apart.h"
#include "tools/bench/figure.h"
#include "tools/bench/measure.h"
#include "tools/bench/sections.h"
#include "tools/bench/solve_case.h"
#include "tools/export/exporters.h"
#include "tools/render/pictures.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cstring>
#include <memory>
#include <numeric>

namespace patchlight {
namespace {

constexpr uint32_t kSourceCount = 400;            // as the solver's pass 2
constexpr size_t kMemoryWords = size_t{1} << 25;  // 256 MB: far more than caches hold

// Everything that the kernels read, made once.
struct Bench {
  Scene scene;
  SolverSettings settings = {};
  std::shared_ptr<const Surfaces> surfaces = {};
  Solution start = {};              // before the first round
  Solution refined = {};            // after the last one; the mesh is not frozen
  Solution passed = {};             // after pass 2
  std::vector<uint32_t> rows = {};  // all elements of `refined`
  SourceTable sources = {};         // of pass 2
  std::vector<Rgb> sent = {};       // by the elements in pass 2
  View view = {};
  FilmTable film = {};
  std::vector<Rgb> vertex_values = {};
  Picture picture = {};
  std::vector<uint64_t> memory = {};
};

// What the kernels write.
struct Scratch {
  std::vector<Rgb> direct, irradiance;
  std::vector<float> error, noise;
  std::vector<float> exposed;
  HitTable hits;
  Solution solution;
  std::vector<uint32_t> parent;
  PatchTable leaves;
  std::vector<uint64_t> memory;
};

struct Tapes {
  RayTape direct, rows, aimed, film;
};

uint64_t direct_light(Scratch& scratch, const Bench& b) {
  const PatchTable& elements = b.refined.mesh.elements;
  scratch.direct.resize(elements.size());
  scratch.error.resize(elements.size());
  scratch.noise.resize(elements.size());
  return find_direct({scratch.direct, scratch.error, scratch.noise}, b.rows,
                     {*b.surfaces, b.refined.mesh, b.refined.transport.receivers, b.refined.transport.groups,
                      b.refined.transport.sights},
                     {}, b.settings.seed);
}

uint64_t rows_of_patches(Scratch& scratch, const Bench& b) {
  return cast_rows(scratch.hits, scratch.exposed, all_rows(b.refined.transport.receivers.size()),
                   get_rows(b.refined).by, true);
}

uint64_t second_pass(Scratch& scratch, const Bench& b) {
  return gather_elements(scratch.irradiance, {}, get_rows(b.passed),
                         {b.passed.mesh.elements, b.passed.mesh.element_first}, b.sent, b.sources);
}

Bench make_bench(const std::string& path, uint64_t max_patches) {
  Scene scene = load_quietly(path);
  Bench b{.scene = std::move(scene)};
  b.surfaces = make_surfaces(b.scene.faces, b.scene.sky);
  b.settings = settings_within(b.scene, max_patches);
  b.start = make_solution(b.surfaces, b.settings);
  b.refined = b.start;
  while (refine(b.refined)) {
  }
  b.rows = all_rows(b.refined.mesh.elements.size());
  b.passed = b.refined;
  freeze(b.passed);
  advance(b.passed);
  b.sent = b.passed.mesh.elements.unshot;
  b.sources = make_sources(b.passed.mesh.elements, *b.surfaces, b.sent, kSourceCount);
  advance(b.passed);
  b.view = make_view(b.scene.cameras.front());
  b.film = make_film(make_scenery(b.passed), b.view, {});
  b.vertex_values = vertex_radiosity(b.passed);
  b.picture = {b.film.width, b.film.height, expose(b.film, b.vertex_values)};
  b.memory.assign(kMemoryWords, 1);
  return b;
}

// What each ray kernel asks of the tracer.
Tapes record_tapes(Scratch& scratch, const Bench& b) {
  Tapes tapes;
  const WorkersScope scope(std::make_shared<Workers>(1));
  observe_rays(b.surfaces->tracer, &tapes.direct);
  direct_light(scratch, b);
  observe_rays(b.surfaces->tracer, &tapes.rows);
  rows_of_patches(scratch, b);
  observe_rays(b.surfaces->tracer, &tapes.aimed);
  second_pass(scratch, b);
  observe_rays(b.surfaces->tracer, &tapes.film);
  make_film(make_scenery(b.passed), b.view, {});
  observe_rays(b.surfaces->tracer, nullptr);
  return tapes;
}

// One thread, by the processor's clock.
Kernel ray_kernel(std::string name, std::function<double()> run, std::function<void()> prepare = {}) {
  return {std::move(name), "rays/s", 1, Clock::kProcessor, std::move(run), std::move(prepare)};
}

// A kernel beside bare Embree on the rays of its tape: four rows, the kernel itself last. Those of neither
// kind are left out: the few rays of find_direct that look for buried points, for one. order: what the kernel
// asks of the tracer.
void add_ray_kernels(std::vector<Kernel>& kernels, const std::string& name, const Bench& b,
                     const TapeTrack& track, bool visibility, RayOrder order, std::function<double()> whole,
                     std::function<void()> prepare) {
  const auto replay = std::make_shared<Replay>(make_replay(track));
  const auto rays = static_cast<double>(count_kept_rays(track));
  const auto add = [&](const std::string& what, auto step) {
    kernels.push_back(ray_kernel(name + ": " + what, [&b, replay, rays, step] {
      step(b.surfaces->tracer, *replay);
      return rays;
    }));
  };
  const auto bare = visibility ? replay_blocked : replay_nearest;
  const std::string call = visibility ? "rtcOccluded16" : "rtcIntersect16";
  add("bare " + call + ", coherent",
      [bare](const Tracer& tracer, Replay& packets) { bare(tracer, packets, RayOrder::kCoherent); });
  add("bare " + call + ", incoherent",
      [bare](const Tracer& tracer, Replay& packets) { bare(tracer, packets, RayOrder::kIncoherent); });
  if (visibility)
    add("find_blocked",
        [order](const Tracer& tracer, Replay& packets) { replay_find_blocked(tracer, packets, order); });
  else
    add("find_hits", replay_find_hits);
  kernels.push_back(ray_kernel(name, std::move(whole), std::move(prepare)));
}

std::vector<Kernel> list_kernels(Scratch& scratch, const Bench& b, const Tapes& tapes, size_t threads) {
  std::vector<Kernel> kernels;
  if (tapes.direct.visibility.ray_count > 0)
    add_ray_kernels(kernels, "find_direct", b, tapes.direct.visibility, true, RayOrder::kCoherent,
                    [&] { return static_cast<double>(direct_light(scratch, b)); }, {});
  add_ray_kernels(kernels, "cast_rows", b, tapes.rows.nearest, false, RayOrder::kCoherent,
                  [&] { return static_cast<double>(rows_of_patches(scratch, b)); }, {});
  if (tapes.aimed.visibility.ray_count > 0)
    add_ray_kernels(kernels, "gather_elements", b, tapes.aimed.visibility, true, RayOrder::kIncoherent,
                    [&] { return static_cast<double>(second_pass(scratch, b)); }, {});
  add_ray_kernels(
      kernels, "make_film", b, tapes.film.nearest, false, RayOrder::kCoherent,
      [&] { return static_cast<double>(make_film(make_scenery(b.passed), b.view, {}).ray_count); }, {});

  const auto factors = static_cast<double>(b.passed.transport.hits.patch.size());
  kernels.push_back({"gather_patches", "factors/s", threads, Clock::kWall, [&, factors] {
                       gather_patches(scratch.irradiance, {}, get_rows(b.passed),
                                      b.passed.mesh.patches.unshot);
                       return factors;
                     }});
  kernels.push_back({"memory read", "B/s", threads, Clock::kWall, [&] {
                       std::atomic<uint64_t> sum{0};
                       for_rows(kMemoryWords, 1 << 16, [&](size_t begin, size_t end) {
                         sum +=
                             std::accumulate(b.memory.begin() + begin, b.memory.begin() + end, uint64_t{0});
                       });
                       // Nothing of it is left out by the compiler: the sum decides.
                       return sum == kMemoryWords ? 8.0 * kMemoryWords : 0.0;
                     }});
  kernels.push_back({"memory copy, read and written", "B/s", threads, Clock::kWall, [&] {
                       for_rows(kMemoryWords, 1 << 16, [&](size_t begin, size_t end) {
                         std::memcpy(&scratch.memory[begin], &b.memory[begin], 8 * (end - begin));
                       });
                       return 16.0 * kMemoryWords;
                     }});

  kernels.push_back({"refine, rays included", "splits/s", 1, Clock::kProcessor,
                     [&] {
                       while (refine(scratch.solution)) {
                       }
                       double splits = 0;
                       for (const RoundReport& round : scratch.solution.log.rounds)
                         splits += static_cast<double>(round.split_count);
                       return splits;
                     },
                     [&] {
                       scratch.solution = b.start;
                       scratch.solution.workers = current_workers();
                     }});
  kernels.push_back({"split_leaves", "splits/s", 1, Clock::kProcessor, [&] {
                       const std::vector<uint8_t> marks(b.start.mesh.elements.size(), 1);
                       scratch.leaves =
                           split_leaves(b.start.mesh.elements, b.surfaces->frames, marks, scratch.parent);
                       return static_cast<double>(marks.size());
                     }});
  kernels.push_back(
      {"make_vertices and reconstruct", "patches/s", 1, Clock::kProcessor, [&] {
         const VertexTable vertices =
             make_vertices(b.refined.mesh.elements, b.surfaces->frames, b.surfaces->links);
         reconstruct({vertices, b.refined.mesh.elements, b.surfaces->frames}, b.refined.light.direct, {3, 3});
         return static_cast<double>(b.refined.mesh.elements.size());
       }});
  const double pixels = static_cast<double>(b.film.width) * b.film.height;
  kernels.push_back({"expose", "pixels/s", 1, Clock::kProcessor, [&, pixels] {
                       expose(b.film, b.vertex_values);
                       return pixels;
                     }});
  kernels.push_back({"encode_png, of raw pixels", "B/s", 1, Clock::kProcessor, [&, pixels] {
                       return find_exporter("png").encode_picture(b.picture).empty() ? 0.0 : 3 * pixels;
                     }});
  return kernels;
}

// Quotients of rates of one round each.
Json make_ratio(std::string name, const std::vector<double>& over, const std::vector<double>& under) {
  std::vector<double> quotients;
  for (size_t k = 0; k < over.size(); ++k) quotients.push_back(over[k] / under[k]);
  Json figure = make_figure(std::move(quotients), "");
  figure["name"] = std::move(name);
  return figure;
}

double sum(const std::vector<double>& runs) { return std::accumulate(runs.begin(), runs.end(), 0.0); }

Json make_ratios(const std::vector<Kernel>& kernels, const std::vector<std::vector<double>>& rates) {
  Json ratios = Json::array();
  const std::vector<double>* gather = nullptr;
  for (size_t k = 0; k < kernels.size(); ++k) {
    if (kernels[k].name.find(": bare ") != std::string::npos && kernels[k].name.ends_with(", coherent")) {
      // The faster of Embree's two ways is the one to be held against.
      const std::vector<double>& best = sum(rates[k]) > sum(rates[k + 1]) ? rates[k] : rates[k + 1];
      for (const size_t other : {k + 2, k + 3})
        ratios.push_back(make_ratio(kernels[other].name + " / bare Embree", rates[other], best));
    }
    if (kernels[k].name == "gather_patches") gather = &rates[k];
    if (kernels[k].name == "memory read" && gather) {
      // A factor is the index of a patch, four bytes; what the patches send stays in caches.
      Json ratio = make_ratio("gather_patches' bytes / memory read", *gather, rates[k]);
      for (const char* value : {"median", "low", "high"}) ratio[value] = 4 * ratio[value].get<double>();
      ratios.push_back(ratio);
    }
  }
  return ratios;
}

Json measure(const BenchOptions& options) {
  const WorkersScope scope(std::make_shared<Workers>(options.threads));
  const size_t threads = current_workers()->thread_count();
  const Bench b = make_bench(options.scenes.front(), options.max_patches);
  Scratch scratch;
  scratch.exposed = b.refined.mesh.patches.exposed;
  scratch.memory.assign(kMemoryWords, 2);
  scratch.irradiance.resize(b.passed.mesh.patches.size());
  const Tapes tapes = record_tapes(scratch, b);
  const std::vector<Kernel> kernels = list_kernels(scratch, b, tapes, threads);
  const auto rates = measure_kernels(kernels, options.repetitions, options.seconds);
  Json result = {{"scene", options.scenes.front()},
                 {"patches", b.refined.mesh.elements.size()},
                 {"form_factor_patches", b.refined.mesh.patches.size()},
                 {"kernels", Json::array()}};
  for (size_t k = 0; k < kernels.size(); ++k) {
    Json figure = make_figure(rates[k], kernels[k].unit);
    figure["name"] = kernels[k].name;
    figure["threads"] = kernels[k].thread_count;
    figure["clock"] = kernels[k].clock == Clock::kWall ? "wall" : "processor";
    result["kernels"].push_back(figure);
  }
  result["ratios"] = make_ratios(kernels, rates);
  return result;
}

}  // namespace

Json measure_kernels_section(const BenchOptions& options, Talk& talk) {
  say_progress(talk, "kernels on " + options.scenes.front());
  return run_apart([&] { return measure(options); });
}

std::string format_kernels(const Json& section) {
  std::string text = fmt::format("kernels, on {} ({} patches, {} with rows); median (lowest .. highest)\n",
                                 section["scene"].get<std::string>(), section["patches"].get<uint64_t>(),
                                 section["form_factor_patches"].get<uint64_t>());
  for (const Json& figure : section["kernels"])
    text += fmt::format(
        "  {:48} {}{}\n", figure["name"].get<std::string>(), format_figure(figure),
        figure["clock"] == "wall" ? fmt::format(", {} threads", figure["threads"].get<size_t>()) : "");
  for (const Json& figure : section["ratios"])
    text += fmt::format("  {:48} {}\n", figure["name"].get<std::string>(), format_figure(figure));
  return text;
}

}  // namespace patchlight
