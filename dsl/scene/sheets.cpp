// Overlapping polygons to sheets.
#include "dsl/scene/sheets.h"

#include "dsl/polygons/flatten.h"
#include "dsl/polygons/sheet.h"
#include "dsl/report/text.h"
#include "engine/base/sampling.h"
#include "engine/base/union_find.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <map>

namespace patchlight {
namespace {

// What a polygon is cut into instead.
struct Recut {
  std::vector<DVec3> points;
  std::vector<FaceCorners> faces;
  std::vector<uint8_t> sides;
  std::vector<uint32_t> sheet;
};
using Recuts = std::map<uint32_t, Recut>;  // by polygon

FaceCorners turned_over(const FaceCorners& face) {
  if (is_triangle(face)) return {face[0], face[2], face[1], face[1]};
  return {face[0], face[3], face[2], face[1]};
}

// Adds faces of one region to a polygon: counter-clockwise from its front, or, with `turn`, from its back.
// `first_sheet`: the sheet of the first face, the others follow; kNone: none.
void add_faces(Recut& recut, const CutFaces& cut, bool turn, uint8_t sides, uint32_t first_sheet) {
  const auto base = static_cast<uint32_t>(recut.points.size());
  recut.points.insert(recut.points.end(), cut.points.begin(), cut.points.end());
  for (size_t k = 0; k < cut.faces.size(); ++k) {
    FaceCorners face = turn ? turned_over(cut.faces[k]) : cut.faces[k];
    for (uint32_t& corner : face) corner += base;
    recut.faces.push_back(face);
    recut.sides.push_back(sides);
    recut.sheet.push_back(first_sheet == kNone ? kNone : first_sheet + static_cast<uint32_t>(k));
  }
}

// Cuts polygons that overlap each other; nothing where they cannot be cut.
void recut_group(const ObjectTable& objects, const OutlineTable& outlines, const std::vector<uint8_t>& emits,
                 const std::vector<uint32_t>& polygons, double near, CutTable& table, Recuts& recuts) {
  std::vector<SheetPart> parts;
  for (const uint32_t p : polygons) {
    SheetPart part;
    part.two_sided = objects.two_sided[outlines.object[p]] != 0;
    part.emits = emits[p] != 0;
    if (!flatten_again(outlines, p, part.flat)) return;
    parts.push_back(std::move(part));
  }
  // The largest is what the plane is taken from.
  const auto area = [&](size_t k) { return parts[k].flat.area * parts[k].flat.size * parts[k].flat.size; };
  size_t base = 0;
  for (size_t k = 1; k < parts.size(); ++k)
    if (area(k) > area(base)) base = k;
  std::vector<uint32_t> order = polygons;
  std::rotate(order.begin(), order.begin() + static_cast<ptrdiff_t>(base),
              order.begin() + static_cast<ptrdiff_t>(base) + 1);
  std::rotate(parts.begin(), parts.begin() + static_cast<ptrdiff_t>(base),
              parts.begin() + static_cast<ptrdiff_t>(base) + 1);
  std::vector<SheetRegion> regions;
  if (!cut_sheet(parts, near, regions)) return;
  for (const uint32_t p : order) recuts[p] = {};
  for (const SheetRegion& region : regions) {
    const auto count = static_cast<uint32_t>(region.cut.faces.size());
    if (region.up == region.down) {
      const bool front_up = glm::dot(parts[region.up].flat.normal, parts[0].flat.normal) > 0;
      add_faces(recuts[order[region.up]], region.cut, !front_up, kFrontSide | kBackSide, kNone);
      continue;
    }
    const uint32_t sheet = region.up != kNone && region.down != kNone ? table.sheet_count : kNone;
    if (sheet != kNone) table.sheet_count += count;
    for (const bool up : {true, false}) {
      const uint32_t part = up ? region.up : region.down;
      if (part == kNone) continue;
      const bool front_up = glm::dot(parts[part].flat.normal, parts[0].flat.normal) > 0;
      add_faces(recuts[order[part]], region.cut, !front_up, front_up == up ? kFrontSide : kBackSide, sheet);
    }
  }
}

// Groups of polygons with the same corners, in any order: of each the first row, and the others ascending.
std::vector<std::vector<uint32_t>> find_equals(const OutlineTable& outlines) {
  struct Row {
    uint64_t hash;
    uint32_t polygon;
  };
  const auto ring = [&](uint32_t p) { return ring_of(outlines, outlines.polygon_first[p]); };
  std::vector<Row> rows(outlines.size());
  for (uint32_t p = 0; p < outlines.size(); ++p) {
    uint64_t sum = 0;  // a sum: the order of the corners does not matter
    for (const DVec3& c : ring(p))
      sum += mix_bits(
          mix_bits(mix_bits(std::bit_cast<uint64_t>(c.x + 0.0)) + std::bit_cast<uint64_t>(c.y + 0.0)) +
          std::bit_cast<uint64_t>(c.z + 0.0));
    rows[p] = {sum, p};
  }
  std::sort(rows.begin(), rows.end(), [](const Row& a, const Row& b) {
    return a.hash != b.hash ? a.hash < b.hash : a.polygon < b.polygon;
  });
  std::vector<std::vector<uint32_t>> groups;
  for (size_t first = 0, last = 0; first < rows.size(); first = last) {
    while (last < rows.size() && rows[last].hash == rows[first].hash) ++last;
    if (last - first < 2) continue;
    std::vector<uint32_t> group;
    for (size_t k = first; k < last; ++k)
      if (ring(rows[k].polygon).size() == ring(rows[first].polygon).size()) group.push_back(rows[k].polygon);
    if (group.size() > 1) groups.push_back(std::move(group));
  }
  std::sort(groups.begin(), groups.end());
  return groups;
}

bool has_holes(const OutlineTable& outlines, uint32_t p) {
  return outlines.polygon_first[p + 1] - outlines.polygon_first[p] > 1;
}

// Of polygons with the same corners the last one of each side is kept; both are cut alike.
void recut_equals(const OutlineTable& outlines, const std::vector<uint32_t>& group, CutTable& table,
                  Recuts& recuts) {
  uint32_t front = kNone, back = kNone;
  for (const uint32_t p : group) {
    if (table.face_first[p] == table.face_first[p + 1] || has_holes(outlines, p)) continue;
    recuts[p] = {};
    (glm::dot(table.normal[p], table.normal[group[0]]) >= 0 ? front : back) = p;
  }
  const uint32_t kept = front != kNone ? front : back;
  if (kept == kNone) return;
  CutFaces cut;
  cut.points.assign(table.points.begin() + table.point_first[kept],
                    table.points.begin() + table.point_first[kept + 1]);
  cut.faces.assign(table.faces.begin() + table.face_first[kept],
                   table.faces.begin() + table.face_first[kept + 1]);
  const uint32_t sheet = front != kNone && back != kNone ? table.sheet_count : kNone;
  if (sheet != kNone) table.sheet_count += static_cast<uint32_t>(cut.faces.size());
  add_faces(recuts[kept], cut, false, kFrontSide, sheet);
  if (sheet != kNone) add_faces(recuts[back], cut, true, kFrontSide, sheet);
}

void apply_recuts(const Recuts& recuts, CutTable& table) {
  CutTable next;
  next.sheet_count = table.sheet_count;
  next.normal = std::move(table.normal);
  const auto append = [](auto& column, const auto& from, size_t first, size_t last) {
    column.insert(column.end(), from.begin() + static_cast<ptrdiff_t>(first),
                  from.begin() + static_cast<ptrdiff_t>(last));
  };
  for (uint32_t p = 0; p < next.size(); ++p) {
    if (const auto found = recuts.find(p); found != recuts.end()) {
      const Recut& recut = found->second;
      append(next.points, recut.points, 0, recut.points.size());
      append(next.faces, recut.faces, 0, recut.faces.size());
      append(next.sides, recut.sides, 0, recut.sides.size());
      append(next.sheet, recut.sheet, 0, recut.sheet.size());
    } else {
      append(next.points, table.points, table.point_first[p], table.point_first[p + 1]);
      append(next.faces, table.faces, table.face_first[p], table.face_first[p + 1]);
      append(next.sides, table.sides, table.face_first[p], table.face_first[p + 1]);
      append(next.sheet, table.sheet, table.face_first[p], table.face_first[p + 1]);
    }
    next.point_first.push_back(static_cast<uint32_t>(next.points.size()));
    next.face_first.push_back(static_cast<uint32_t>(next.faces.size()));
  }
  table = std::move(next);
}

Place place_of_polygon(const Tree& tree, const OutlineTable& outlines, uint32_t p) {
  return place_of(tree, outlines.ring_node[outlines.polygon_first[p]]);
}

}  // namespace

void join_sheets(const ObjectTable& objects, const OutlineTable& outlines, const std::vector<uint8_t>& emits,
                 const std::vector<Overlap>& overlaps, double length, CutTable& table) {
  Recuts recuts;
  UnionFind sets(outlines.size());
  for (const Overlap& overlap : overlaps) sets.join(overlap.small, overlap.large);
  std::map<uint32_t, std::vector<uint32_t>> groups;
  for (const Overlap& overlap : overlaps)
    for (const uint32_t p : {overlap.small, overlap.large}) groups[sets.find(p)].push_back(p);
  for (auto& [first, polygons] : groups) {
    std::sort(polygons.begin(), polygons.end());
    polygons.erase(std::unique(polygons.begin(), polygons.end()), polygons.end());
    recut_group(objects, outlines, emits, polygons, kOnePlane * length, table, recuts);
  }
  for (std::vector<uint32_t> group : find_equals(outlines)) {
    std::erase_if(
        group, [&](uint32_t p) { return recuts.contains(p) || objects.two_sided[outlines.object[p]] != 0; });
    if (group.size() > 1) recut_equals(outlines, group, table, recuts);
  }
  if (!recuts.empty()) apply_recuts(recuts, table);
}

void warn_of_coincident(Messages& messages, const Tree& tree, const ObjectTable& objects,
                        const OutlineTable& outlines, const CutTable& table,
                        const std::vector<Overlap>& overlaps) {
  const auto is_back_to_back = [&](uint32_t p, uint32_t q) {
    return glm::dot(table.normal[p], table.normal[q]) < 0 && !objects.two_sided[outlines.object[p]] &&
           !objects.two_sided[outlines.object[q]];
  };
  const auto report = [&](uint32_t p, std::string message) {
    add_warning(messages, place_of_polygon(tree, outlines, p), "coincident", std::move(message));
  };
  std::vector<uint32_t> in_mesh(objects.size(), 0);  // pairs within one mesh
  for (const std::vector<uint32_t>& group : find_equals(outlines))
    for (size_t k = 1; k < group.size(); ++k) {
      const uint32_t p = group[k];
      size_t before = k;  // the nearest one before that faces the same way
      while (before > 0 && is_back_to_back(p, group[before - 1])) --before;
      if (before == 0) continue;
      const uint32_t q = group[before - 1], object = outlines.object[p];
      if (objects.is_mesh[object] && outlines.object[q] == object) {
        ++in_mesh[object];
        continue;
      }
      report(p, fmt::format("'{}' lies on '{}': the same corners; '{}' alone is there",
                            escape_text(outlines.id[p]), escape_text(outlines.id[q]),
                            escape_text(outlines.id[p])));
    }
  for (uint32_t object = 0; object < objects.size(); ++object)
    if (in_mesh[object] > 0)
      add_warning(
          messages, place_of(tree, objects.node[object]), "coincident",
          fmt::format("{} faces of this mesh lie on others of it that face the same way; the later ones "
                      "alone are there",
                      in_mesh[object]));
  for (const Overlap& overlap : overlaps) {
    if (!overlap.one_way || overlap.same_corners) continue;
    const std::string small = escape_text(outlines.id[overlap.small]);
    report(overlap.small,
           fmt::format("'{}' lies in the plane of '{}' and overlaps it; where both are, '{}' alone is there: "
                       "move it a little off",
                       small, escape_text(outlines.id[overlap.large]), small));
  }
}

}  // namespace patchlight
