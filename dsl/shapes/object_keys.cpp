// The keys of an object.
#include "dsl/shapes/object_keys.h"

#include "dsl/report/limits.h"
#include "dsl/shapes/shapes.h"

#include <fmt/format.h>

#include <deque>
#include <string>
#include <vector>

namespace patchlight {
namespace {

using enum ValueType;
using enum RuleKind;

constexpr KeyRow kFirstRows[] = {
    {"id", kName, false, "", 0, 0, "bad-id", "",
     "Name of the object. Absent: object1, object2 ... by place."},
    {"material", kText, false, "", 0, 0, "", "",
     "Name of its material. Required, but for meshes, for rooms that name all walls, and inside of groups."},
};

// Between these stand the keys that go with one shape only.
constexpr KeyRow kLastRows[] = {
    {"transform", kList, false, "", 0, 0, "", "transform",
     "Steps in order, each one of translate, rotate, scale."},
    {"translate", kVec3, false, "", -kAnyNumber, kAnyNumber, "out-of-range", "",
     "Shift by [x, y, z], after scale and rotate."},
    {"rotate", kMap, false, "", 0, 0, "", "rotate", "Turn after scale: {axis, angle}."},
    {"scale", kScale, false, "", 0, 0, "", "", "Stretch by a number or [x, y, z]; negative ones mirror."},
    {"two_sided", kBoolean, false, "false", 0, 0, "", "", "Both sides are lit, each with its own patches."},
    {"patch_size", kNumber, false, "", kAboveZero, kCoordinateMax, "out-of-range", "",
     "Longest edge of a starting patch on this object. Absent: as the solver says."},
    {"patch_size_min", kNumber, false, "", kAboveZero, kCoordinateMax, "out-of-range", "",
     "Its patches with a longest edge below this are not split. Absent: as the solver says."},
    {"subdivide", kInteger, false, "1", 1, kAnyInteger, "out-of-range", "",
     "At least n times n patches on each polygon to start with."},
};

constexpr KeyRule kMoves = {kExcludes, "translate|rotate|scale", "transform", "ambiguous-shape",
                            "an object has either 'transform' or the short keys translate, rotate, scale"};

KeyRow row_of_shape(const ShapeRow& shape) {
  KeyRow row;
  row.key = shape.name;
  row.type = shape.type;
  row.choices = shape.keys ? shape.keys->name : shape.type == kList ? "object" : "";
  row.description = shape.description;
  return row;
}

std::vector<KeyRow> join_rows() {
  std::vector<KeyRow> rows(std::begin(kFirstRows), std::end(kFirstRows));
  for (const ShapeRow& shape : shape_rows())
    rows.insert(rows.end(), shape.beside.begin(), shape.beside.end());
  rows.insert(rows.end(), std::begin(kLastRows), std::end(kLastRows));
  for (const ShapeRow& shape : shape_rows()) rows.push_back(row_of_shape(shape));
  return rows;
}

// Keys that go with one shape want it beside them. `texts` keeps what the rules say.
std::vector<KeyRule> join_rules(std::deque<std::string>& texts) {
  std::vector<KeyRule> rules;
  for (const ShapeRow& shape : shape_rows())
    for (const KeyRow& row : shape.beside)
      rules.push_back({kNeeds, row.key, shape.name, "unknown-key",
                       texts.emplace_back(fmt::format("'{}' goes with '{}' only", row.key, shape.name))});
  rules.push_back(kMoves);
  return rules;
}

}  // namespace

const KeyTable& object_keys() {
  static const std::vector<KeyRow> rows = join_rows();
  static std::deque<std::string> texts;
  static const std::vector<KeyRule> rules = join_rules(texts);
  static const KeyTable table = {"object", rows, rules};
  return table;
}

}  // namespace patchlight
