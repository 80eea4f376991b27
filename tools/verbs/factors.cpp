// The verb factors, and its two formats. The matrix of a thousand polygons is ten megabytes of text: rows are
// written as they are made.
#include "tools/verbs/factors.h"

#include "engine/base/parallel.h"
#include "engine/base/stopwatch.h"
#include "tools/base/files.h"
#include "tools/base/flag_values.h"
#include "tools/base/format.h"
#include "tools/base/json.h"
#include "tools/base/memory.h"
#include "tools/base/start.h"
#include "tools/base/stop.h"
#include "tools/render/plan.h"
#include "tools/verbs/flag_groups.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>

namespace patchlight {
namespace {

constexpr const char* kHelp =
    R"(Prints the form factors (view factors) between the polygons of a scene: a row a polygon, with its area, the
factors to all polygons in the order of the scene, and their sum, which is not adjusted.

Examples:
  patchlight factors duct.yaml > duct.csv
  patchlight factors duct.yaml --format json        with an estimated error beside every factor
  patchlight factors duct.yaml --error 1e-4         more rays where something stands between polygons
  patchlight factors duct.yaml -D gap=0.02          a variable of the scene

Factors between polygons with nothing in between are exact (1e-6) and need no rays.
)";

constexpr size_t kChunkBytes = size_t{1} << 20;
constexpr size_t kWorstCount = 5;

void check_memory(const Scene& scene, uint64_t max_memory) {
  const size_t n = scene.polygons.size();
  const uint64_t bytes = forecast_factor_bytes(n, scene.faces.size());
  const uint64_t available = std::min(find_memory_available(), max_memory);
  if (bytes > available)
    throw UserError("memory-limit",
                    fmt::format("the matrix of {} x {} polygons may need {} and {} are available", n, n,
                                format_bytes(bytes), format_bytes(available)),
                    scene.file);
}

// Text on its way out, in parts of about kChunkBytes.
struct Writer {
  const PutText& put;
  std::string text;

  template <class... Values>
  void add(fmt::format_string<Values...> format, Values&&... values) {
    fmt::format_to(std::back_inserter(text), format, std::forward<Values>(values)...);
    if (text.size() >= kChunkBytes) flush();
  }
  void flush() {
    put(text);
    text.clear();
  }
};

double scene_area(const Scene& scene, const FactorTable& table, uint32_t polygon) {
  return table.area[polygon] * scene.units_per_length * scene.units_per_length;
}

// [[...], ...], a line a row.
template <class Find>
void add_matrix(Writer& writer, const char* format, size_t n, Find find) {
  writer.add("[");
  for (uint32_t i = 0; i < n; ++i) {
    writer.add("{}\n    [", i == 0 ? "" : ",");
    for (uint32_t j = 0; j < n; ++j) {
      if (j > 0) writer.add(", ");
      fmt::format_to(std::back_inserter(writer.text), fmt::runtime(format), find(i, j));
    }
    writer.add("]");
  }
  writer.add("\n  ]");
}

void add_list(Writer& writer, const char* format, const std::vector<double>& values) {
  writer.add("[");
  for (size_t k = 0; k < values.size(); ++k) {
    if (k > 0) writer.add(", ");
    fmt::format_to(std::back_inserter(writer.text), fmt::runtime(format), values[k]);
  }
  writer.add("]");
}

void say_summary(Talk& talk, const Scene& scene, const FactorTable& table, const FactorSummary& summary,
                 double seconds) {
  const auto& id = scene.polygons.id;
  say(talk, fmt::format("{}: {} polygons, {} pairs clear, {} hidden, {} by {} rays, {:.2f} s",
                        pick_stem(scene.file, ""), table.size(), table.clear_count, table.hidden_count,
                        table.sampled_count, format_count(table.ray_count), seconds));
  const auto [least, most] = std::minmax_element(summary.row_sums.begin(), summary.row_sums.end());
  const auto name = [&](auto at) {
    return escape_text(id[static_cast<size_t>(at - summary.row_sums.begin())]);
  };
  say(talk, fmt::format("row sums: {:.6f} ({}) to {:.6f} ({})", *least, name(least), *most, name(most)));
  if (summary.error_max > 0)
    say(talk, fmt::format("largest estimated error of a factor: {:.2g}, {} to {}", summary.error_max,
                          escape_text(id[summary.error_from]), escape_text(id[summary.error_to])));
}

}  // namespace

FactorSummary summarize_factors(const FactorTable& table) {
  const auto n = static_cast<uint32_t>(table.size());
  FactorSummary summary;
  for (uint32_t i = 0; i < n; ++i) {
    double sum = 0, squares = 0;
    for (uint32_t j = 0; j < n; ++j) {
      const double factor = find_factor(table, i, j), error = find_factor_error(table, i, j);
      sum += factor, squares += error * error;
      if (error > summary.error_max) summary.error_max = error, summary.error_from = i, summary.error_to = j;
      const double there = table.area[i] * factor, back = table.area[j] * find_factor(table, j, i);
      if (const double least = std::min(table.area[i], table.area[j]); least > 0)
        summary.reciprocity_error_max =
            std::max(summary.reciprocity_error_max, std::abs(there - back) / least);
    }
    summary.row_sums.push_back(sum);
    summary.row_errors.push_back(std::sqrt(squares));
    if (sum > 0) summary.worst.push_back(i);
  }
  const auto off = [&](uint32_t i) { return std::abs(summary.row_sums[i] - 1); };
  std::stable_sort(summary.worst.begin(), summary.worst.end(),
                   [&](uint32_t a, uint32_t b) { return off(a) > off(b); });
  summary.worst.resize(std::min(summary.worst.size(), kWorstCount));
  return summary;
}

void format_factors_csv(const PutText& put, const Scene& scene, const FactorTable& table,
                        const FactorSummary& summary) {
  const auto n = static_cast<uint32_t>(table.size());
  Writer writer{put, {}};
  writer.add("polygon,area");
  for (const std::string& id : scene.polygons.id) writer.add(",{}", quote_csv(id));
  writer.add(",row_sum,row_error\n");
  for (uint32_t i = 0; i < n; ++i) {
    writer.add("{},{:.9g}", quote_csv(scene.polygons.id[i]), scene_area(scene, table, i));
    for (uint32_t j = 0; j < n; ++j) writer.add(",{:.9g}", find_factor(table, i, j));
    writer.add(",{:.9g},{:.2g}\n", summary.row_sums[i], summary.row_errors[i]);
  }
  writer.flush();
}

void format_factors_json(const PutText& put, const Scene& scene, const FactorTable& table,
                         const FactorSummary& summary, const FactorSettings& settings) {
  const auto n = static_cast<uint32_t>(table.size());
  const auto quote = [](const std::string& text) {
    return Json(text).dump(-1, ' ', false, Json::error_handler_t::replace);
  };
  const auto name = [&](uint32_t polygon) { return quote(scene.polygons.id[polygon]); };
  Writer writer{put, {}};
  writer.add("{{\n  \"scene\": {},\n  \"units\": {},\n  \"polygons\": [", quote(scene.file),
             quote(scene.units));
  for (uint32_t i = 0; i < n; ++i)
    writer.add("{}\n    {{\"id\": {}, \"area\": {:.9g}}}", i == 0 ? "" : ",", name(i),
               scene_area(scene, table, i));
  writer.add("\n  ],\n  \"form_factors\": ");
  add_matrix(writer, "{:.9g}", n, [&](uint32_t i, uint32_t j) { return find_factor(table, i, j); });
  writer.add(",\n  \"errors\": ");
  add_matrix(writer, "{:.2g}", n, [&](uint32_t i, uint32_t j) { return find_factor_error(table, i, j); });
  writer.add(",\n  \"row_sums\": ");
  add_list(writer, "{:.9g}", summary.row_sums);
  writer.add(",\n  \"row_errors\": ");
  add_list(writer, "{:.2g}", summary.row_errors);
  writer.add(",\n  \"reciprocity_error_max\": {:.2g},\n", summary.reciprocity_error_max);
  writer.add("  \"error_max\": {{\"error\": {:.2g}, \"from\": {}, \"to\": {}}},\n", summary.error_max,
             name(summary.error_from), name(summary.error_to));
  writer.add("  \"worst\": [");
  for (size_t k = 0; k < summary.worst.size(); ++k) {
    const uint32_t i = summary.worst[k];
    writer.add("{}\n    {{\"polygon\": {}, \"row_sum\": {:.9g}, \"row_error\": {:.2g}}}", k == 0 ? "" : ",",
               name(i), summary.row_sums[i], summary.row_errors[i]);
  }
  writer.add("{}],\n", summary.worst.empty() ? "" : "\n  ");
  writer.add("  \"pairs\": {{\"clear\": {}, \"hidden\": {}, \"by_rays\": {}}},\n", table.clear_count,
             table.hidden_count, table.sampled_count);
  writer.add("  \"rays\": {},\n  \"error_wanted\": {},\n  \"seed\": {}\n}}\n", table.ray_count,
             settings.error, settings.seed);
  writer.flush();
}

void describe_factors(Usage& usage, Options& options) {
  usage.help = kHelp;
  FactorOptions& factors = options.own.emplace<FactorOptions>();
  add_scene(usage, options);
  add_run_flags(usage, options);
  for (Flag& flag : usage.flags)
    if (flag.name == "--max-seconds")
      flag.help = fmt::format("end a run that takes longer; {} unless given", options.max_seconds);
  add_choice(usage, "--format", {"csv", "json"}, "csv unless given",
             [&factors](size_t choice) { factors.format = static_cast<FactorFormat>(choice); });
  add_value(usage, "--error", "E", "no estimated error of a factor is larger; 0.001 unless given",
            [&factors](const std::string& text) { factors.error = parse_number("--error", text, 1e-6, 1); });
  add_talk_flags(usage, options);
}

namespace {

FineCorners find_fine_corners(const Scene& scene) {
  return {scene.fine_corners, scene.origin / scene.units_per_length};
}

}  // namespace

int factors(const Options& options, Talk& talk) {
  Stopwatch watch;
  if (!options.json) check_standard_output();
  std::vector<Diagnostic> warnings;
  LoadOptions load = options.load;
  load.fine_corners = true;
  const Scene scene = load_scene(options.scene, warnings, load);
  // Form factors need no lamp.
  std::erase_if(warnings, [](const Diagnostic& warning) { return warning.slug == "no-emitter"; });
  say_diagnostics(talk, warnings);
  check_memory(scene, options.max_memory.value_or(~uint64_t{0}));
  if (options.json) return 0;

  const WorkersScope scope(start_workers(options, talk));
  const double loading = watch.lap();
  const StopSignals signals(*current_workers(), std::max(options.max_seconds - loading, 1e-3));
  const FactorOptions& own = get_own<FactorOptions>(options);
  const FactorSettings settings{own.error, options.seed.value_or(scene.solver.seed)};
  const size_t n = scene.polygons.size();
  FactorTable table;
  try {
    const Tracer tracer = make_tracer(scene.faces);
    const FactorScene factor_scene = make_factor_scene(scene.faces, n, find_fine_corners(scene));
    table = make_factor_table(factor_scene, n);
    while (extend_factors(table, factor_scene, scene.faces, tracer, settings))
      say_progress(talk,
                   fmt::format("row {} of {}, {} rays", table.row_done, n, format_count(table.ray_count)));
  } catch (const Cancelled&) {
    if (stop_signal() == SIGALRM)
      throw UserError("time-limit",
                      fmt::format("{} of {} rows are found after {:g} s (--max-seconds raises the limit); "
                                  "nothing is printed",
                                  table.row_done, n, options.max_seconds),
                      scene.file);
    say(talk, fmt::format("stopped by {} after {} of {} rows: nothing is printed",
                          stop_signal() == SIGTERM ? "SIGTERM" : "SIGINT", table.row_done, n));
    return 128 + stop_signal();
  }
  say_progress_done(talk);

  const FactorSummary summary = summarize_factors(table);
  if (own.format == FactorFormat::kCsv)
    format_factors_csv(print_result, scene, table, summary);
  else
    format_factors_json(print_result, scene, table, summary, settings);
  if (table.rough_count > 0)
    say_warning(
        talk, "not-converged",
        fmt::format("{} of {} pairs found by rays have a larger estimated error than {:g}; the largest "
                    "is {:.2g}, '{}' to '{}'",
                    table.rough_count, table.sampled_count, settings.error, summary.error_max,
                    escape_text(scene.polygons.id[summary.error_from]),
                    escape_text(scene.polygons.id[summary.error_to])),
        scene.file);
  say_summary(talk, scene, table, summary, loading + watch.lap());
  return 0;
}

}  // namespace patchlight
