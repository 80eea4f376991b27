// repeat: copies of an object, ID[i] or ID[i,j,k]: in rows by `step`, or by a transform applied again and
// again.
#include "dsl/report/limits.h"
#include "dsl/shapes/objects.h"
#include "dsl/shapes/shape.h"
#include "dsl/shapes/transform.h"

#include <fmt/format.h>

namespace patchlight {
namespace {

using enum ValueType;
using enum RuleKind;

constexpr KeyRow kRows[] = {
    {"count", kIntegerOrVec3, true, "", 1, kAnyInteger, "out-of-range", "",
     "How many copies: n, or [nx, ny, nz]."},
    {"step", kVec3, false, "", -kAnyNumber, kAnyNumber, "out-of-range", "",
     "From one copy to the next: along each axis where count is a list, else as a whole."},
    {"transform", kList, false, "", 0, 0, "", "transform", "Instead of step: copy i has it applied i times."},
    {"of", kMap, true, "", 0, 0, "", "object", "The object; $i ($j, $k) in it is the copy's index, from 0."},
};

constexpr KeyRule kRules[] = {
    {kOneOf, "step|transform", "", "missing-key",
     "a repeat needs 'step', or 'transform': how one copy follows from the one before"},
    {kExcludes, "step", "transform", "ambiguous-shape", "a repeat has either 'step' or 'transform'"},
};

struct Counts {
  int64_t each[3] = {1, 1, 1};
  bool is_list = false;
};

bool read_counts(const ShapeInput& input, uint32_t node, Counts& counts) {
  const Context& context = input.context;
  const Node& source = context.tree.nodes[node];
  KeyRow row = kRows[0];
  row.type = kInteger;
  Value value;
  counts.is_list = source.kind == NodeKind::kList;
  if (!counts.is_list) {
    if (!read_value(context, node, row, value)) return false;
    counts.each[0] = value.integer[0];
  } else {
    if (source.count != 3) {
      add_error(
          context.messages, place_of(context.tree, node), "expected-vec3",
          fmt::format("expected a number or three numbers [nx, ny, nz], got a list of {}", source.count));
      return false;
    }
    uint32_t child = source.first;
    for (int64_t& count : counts.each) {
      if (!read_value(context, child, row, value)) return false;
      count = value.integer[0];
      child = context.tree.nodes[child].next;
    }
  }
  return true;
}

// What reading a node takes: the values in it, aliases followed, and sixteen bytes of text count as one more.
uint64_t count_reads(const Tree& tree, uint32_t node) {
  const Node& row = tree.nodes[node];
  if (row.kind == NodeKind::kScalar) return 1 + row.count / 16;
  uint64_t count = 1;
  if (row.kind == NodeKind::kNull) return count;
  for (uint32_t child = row.first; child != kNone; child = tree.nodes[child].next)
    count += count_reads(tree, child);
  return count;
}

// The copies of node `of` that this repeat stands for within those around it. False after too-many-polygons:
// nothing is expanded before that is known.
bool count_copies(const ShapeInput& input, uint32_t node, const Counts& counts, uint32_t of,
                  uint64_t& copies) {
  copies = input.context.copies;
  bool overflow = false;
  for (const int64_t count : counts.each)
    overflow = __builtin_mul_overflow(copies, static_cast<uint64_t>(count), &copies) || overflow;
  const Limits& limits = input.context.messages.limits;
  const uint64_t reads = count_reads(input.context.tree, of), reads_max = limits.polygons * kReadsPerPolygon;
  const bool too_many = overflow || copies > limits.polygons;
  // Here, and with all that was read before.
  const uint64_t reads_here = too_many ? 0 : copies / input.context.copies * reads;
  const bool too_long =
      !too_many && (reads > reads_max / copies || reads_here > reads_max - input.scene.reads);
  if (!too_many && !too_long) {
    input.scene.reads += reads_here;
    return true;
  }
  add_error(input.context.messages, place_of(input.context.tree, node), "too-many-polygons",
            fmt::format("this makes {} copies{}, more than the limit of {}",
                        overflow ? "more than 2^64" : fmt::format("{}", copies),
                        too_long ? fmt::format(" of {} values each", reads) : "",
                        limit_text(limits, &Limits::polygons)));
  return false;
}

constexpr KeyTable kKeys = {"repeat", kRows, kRules};

void build(const ShapeInput& input) {
  const MapValues map = read_map(input.context, input.node, kKeys);
  if (!map.good) return;
  const auto report = [&](std::string_view slug, std::string message) {
    add_error(input.context.messages, place_of(input.context.tree, input.node), slug, std::move(message));
  };
  Counts counts;
  const uint32_t list = value_of(map, "transform").node;
  if (!read_counts(input, value_of(map, "count").node, counts)) return;
  if (counts.is_list && list != kNone)
    return report("ambiguous-shape", "with 'transform', 'count' is one number");
  Context inner = input.context;
  const uint32_t of = value_of(map, "of").node;
  if (!count_copies(input, value_of(map, "count").node, counts, of, inner.copies)) return;
  Transform each, moved;
  if (list != kNone && !read_transform(input.context, list, each)) return;
  const DVec3 step = vec3_of(value_of(map, "step"));
  const size_t errors_before = inner.messages.error_count;
  const ShapeInput& in = input;
  for (int64_t k = 0; k < counts.each[2]; ++k)
    for (int64_t j = 0; j < counts.each[1]; ++j)
      for (int64_t i = 0; i < counts.each[0]; ++i) {
        const DVec3 index(static_cast<double>(i), static_cast<double>(j), static_cast<double>(k));
        inner.index[0] = index.x;
        if (counts.is_list) inner.index[1] = index.y, inner.index[2] = index.z;
        const std::string id =
            counts.is_list ? fmt::format("{}[{},{},{}]", in.id, i, j, k) : fmt::format("{}[{}]", in.id, i);
        const size_t first = in.scene.outlines.size();
        read_object(inner, of, {id + ".", id}, in.own, in.scene);
        // One copy that is wrong is like all others.
        if (inner.messages.error_count > errors_before) return;
        if (list == kNone) moved.shift = step * (counts.is_list ? index : DVec3(index.x));
        if (i + j + k > 0) apply_transform(moved, input.node, first, in.scene.outlines);
        if (list != kNone) moved = combine(moved, each);
      }
}

}  // namespace

extern const ShapeRow kRepeatShape = {
    .name = "repeat",
    .keys = &kKeys,
    .build = build,
    .description = "Copies of an object, in rows or by a transform applied again and again.",
};

}  // namespace patchlight
