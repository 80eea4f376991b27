// Solver and output.
#include "dsl/scene/settings.h"

#include "dsl/language/values.h"

#include <fmt/format.h>

#include <algorithm>

namespace patchlight {
namespace {

void report(const Context& context, uint32_t node, std::string_view slug, std::string message) {
  add_error(context.messages, place_of(context.tree, node), slug, std::move(message));
}

void read_snapshots(const Context& context, uint32_t list, const SolverSettings& solver,
                    OutputSettings& output) {
  KeyRow row = row_of(kOutputKeys, "snapshots");
  row.type = ValueType::kInteger;
  if (context.tree.nodes[list].count == 0)
    report(context, list, "expected-list", "'snapshots' names one pass at least; take it out for 1, 2, 16");
  for (uint32_t child = context.tree.nodes[list].first; child != kNone;
       child = context.tree.nodes[child].next) {
    Value value;
    if (!read_value(context, child, row, value)) continue;
    const auto pass = static_cast<uint32_t>(value.integer[0]);
    if (pass > solver.pass_count_max)
      report(context, child, "snapshot-beyond-passes",
             fmt::format("a picture of pass {} is asked, but 'passes' is {}", pass, solver.pass_count_max));
    output.snapshots.push_back(pass);
  }
  std::sort(output.snapshots.begin(), output.snapshots.end());
  output.snapshots.erase(std::unique(output.snapshots.begin(), output.snapshots.end()),
                         output.snapshots.end());
}

void read_exposure(const Context& context, uint32_t node, OutputSettings& output) {
  KeyRow row = row_of(kOutputKeys, "exposure");
  row.type = ValueType::kNumber;
  const std::string_view text = text_of(context.tree, node);
  const bool word = !text.empty() && text.find_first_of("0123456789.=$") == std::string_view::npos;
  Value value;
  if (word)
    report(context, node, "expected-number",
           fmt::format("'exposure' is auto or a number; got {}", describe(context.tree, node)));
  else if (read_value(context, node, row, value))
    output.exposure_ev = value.number[0];
}

}  // namespace

void read_solver(const Context& context, uint32_t node, SolverSettings& solver) {
  const MapValues map = read_map(context, node, kSolverKeys);
  if (!map.good) return;
  solver.pass_count_max = static_cast<uint32_t>(value_of(map, "passes").integer[0]);
  solver.until = value_of(map, "until").number[0];
  solver.threshold = static_cast<float>(value_of(map, "threshold").number[0]);
  // What the author sets holds for the patches that carry light between surfaces, too.
  if (has(map, "threshold")) solver.threshold_indirect = solver.threshold;
  solver.patch_count_max = static_cast<uint64_t>(value_of(map, "max_patches").integer[0]);
  solver.rays = static_cast<uint32_t>(value_of(map, "rays").integer[0]);
  solver.error = value_of(map, "error").number[0];
  solver.quality = static_cast<float>(value_of(map, "quality").number[0]);
  solver.seed = static_cast<uint64_t>(value_of(map, "seed").integer[0]);
  solver.patch_size = to_patch_size(value_of(map, "patch_size").number[0]);
  solver.patch_size_min = to_patch_size(value_of(map, "patch_size_min").number[0]);
}

void read_output(const Context& context, uint32_t node, const SolverSettings& solver,
                 OutputSettings& output) {
  const MapValues map = read_map(context, node, kOutputKeys);
  if (!map.good) return;
  output.shading = value_of(map, "shading").integer[0] == 1 ? Shading::kFlat : Shading::kSmooth;
  if (const uint32_t list = value_of(map, "snapshots").node; list != kNone)
    read_snapshots(context, list, solver, output);
  if (const uint32_t exposure = value_of(map, "exposure").node;
      exposure != kNone && text_of(context.tree, exposure) != "auto") {
    read_exposure(context, exposure, output);
  }
  const uint32_t basename = value_of(map, "basename").node;
  if (basename == kNone || !read_text(context, basename, output.basename)) return;
  const std::string& name = output.basename;
  if (name.empty() || name.size() > 200 || name.starts_with('.') || name.find('/') != std::string::npos ||
      name.find("..") != std::string::npos)
    report(context, basename, "output-outside-dir",
           fmt::format("a file name of 1 to 200 bytes without '/' or '..' that does not begin with '.' is "
                       "expected, got '{}'; the folder comes from -o",
                       escape_text(name)));
}

}  // namespace patchlight
