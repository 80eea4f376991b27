// Checked and cut polygons to the engine's table of faces.
#include "dsl/scene/faces.h"

#include "dsl/polygons/cut.h"
#include "dsl/polygons/flatten.h"
#include "dsl/report/limits.h"
#include "dsl/scene/power.h"
#include "dsl/scene/sheets.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace patchlight {
namespace {

// Sums over polygons: what the conversion to engine lengths is made from.
struct Sums {
  double area = 0;
  DVec3 moment{0};  // area times centroid, relative to `base`
  DVec3 base{0};
  double smallest = 1e300, largest = 0;
  uint32_t smallest_polygon = 0;
  bool any_lit = false;  // area and moment are those of what light falls on
};

uint8_t level_for(uint32_t subdivide, size_t face_count) {
  // n x n patches on the whole polygon: 4^level a face.
  const double wanted =
      static_cast<double>(subdivide) * static_cast<double>(subdivide) / static_cast<double>(face_count);
  uint8_t level = 0;
  for (double patches = 1; patches < wanted * (1 - 1e-12); patches *= 4) ++level;
  return level;
}

// is_lit: light falls on it. A sun or a sky may be as far and as large as it likes: single precision is kept
// for the others.
void add_sums(const FlatPolygon& flat, uint32_t p, bool is_lit, Sums& sums) {
  const double area = flat.area * flat.size * flat.size;
  if (is_lit && !sums.any_lit) sums.area = 0, sums.moment = DVec3(0), sums.any_lit = true;
  sums.largest = std::max(sums.largest, flat.size);
  if (flat.size < sums.smallest) {
    sums.smallest = flat.size;
    sums.smallest_polygon = p;
  }
  if (!is_lit && sums.any_lit) return;
  if (sums.area == 0) sums.base = flat.origin;
  sums.area += area;
  sums.moment += (point_at(flat, flat.centroid) - sums.base) * area;
}

// Lays polygon p flat by the rules for scenes or those for meshes. False where nothing is to be cut.
bool flatten(Messages& messages, const Tree& tree, const ObjectTable& objects, const OutlineTable& outlines,
             uint32_t p, FlatPolygon& flat) {
  if (!objects.is_mesh[outlines.object[p]]) return flatten_polygon(messages, tree, outlines, p, flat);
  const uint32_t ring = outlines.polygon_first[p];
  const auto corners = ring_of(outlines, ring);
  for (const DVec3& c : corners)
    if (!(std::max({std::abs(c.x), std::abs(c.y), std::abs(c.z)}) <= kCoordinateMax)) {
      add_error(messages, place_of(tree, outlines.ring_node[ring]), "coordinate-too-large",
                fmt::format("'{}': a corner of it is beyond the limit of {:g}", escape_text(outlines.id[p]),
                            kCoordinateMax));
      return false;
    }
  return flatten_mesh_face(corners, flat) != MeshFace::kNoArea;
}

// Ends early, with an error, where there are more faces than patches to start with are allowed.
CutTable cut_all(Messages& messages, const Tree& tree, const MaterialTable& materials,
                 const ObjectTable& objects, const OutlineTable& outlines, uint64_t start_patches_max,
                 Sums& sums) {
  CutTable table;
  uint64_t count = 0;  // faces, those of second sides included
  FlatPolygon flat;
  CutFaces cut;
  for (uint32_t p = 0; p < outlines.size(); ++p) {
    cut.points.clear();
    cut.faces.clear();
    DVec3 normal(0);
    if (flatten(messages, tree, objects, outlines, p, flat)) {
      // No material: an error was reported, and the polygon is only checked.
      const uint32_t material = outlines.material[p];
      const DRgb emission = material == kNone ? DRgb(0) : materials.emission[material];
      const bool is_cut = cut_polygon(flat, std::max({emission.r, emission.g, emission.b}) > 0, cut);
      if (!is_cut && !objects.is_mesh[outlines.object[p]])
        add_error(messages, place_of(tree, outlines.ring_node[outlines.polygon_first[p]]),
                  "self-intersecting",
                  fmt::format("'{}' cannot be cut: parts of it are too close to each other",
                              escape_text(outlines.id[p])));
      normal = flat.normal;
      const bool is_lamp =
          material != kNone && emission != DRgb(0) && materials.reflectance[material] == DRgb(0);
      add_sums(flat, p, !is_lamp, sums);
    }
    table.points.insert(table.points.end(), cut.points.begin(), cut.points.end());
    table.faces.insert(table.faces.end(), cut.faces.begin(), cut.faces.end());
    const bool two_sided = objects.two_sided[outlines.object[p]] != 0;
    table.sides.resize(table.faces.size(), two_sided ? kFrontSide | kBackSide : kFrontSide);
    table.sheet.resize(table.faces.size(), kNone);
    table.point_first.push_back(static_cast<uint32_t>(table.points.size()));
    table.face_first.push_back(static_cast<uint32_t>(table.faces.size()));
    table.normal.push_back(normal);
    count += cut.faces.size() * (two_sided ? 2 : 1);
    if (count > start_patches_max) {
      add_error(messages, place_of(tree, outlines.ring_node[outlines.polygon_first[p]]), "too-many-patches",
                fmt::format("'{}' takes the scene above the limit of {} starting patches (--max-patches "
                            "raises it)",
                            escape_text(outlines.id[p]), start_patches_max));
      break;
    }
  }
  return table;
}

// Sets origin and unit: the area-weighted centroid, and a power of two that makes the area's root 1 to 2.
void set_units(const Sums& sums, Scene& scene) {
  scene.origin = sums.base + sums.moment / sums.area;
  scene.units_per_length = std::exp2(std::floor(std::log2(std::sqrt(sums.area))));
}

// The unit normal of a face from its float corners' doubles; zero when floats leave it no area on the right
// side.
DVec3 float_normal(const std::array<Vec3, 4>& corners, DVec3 wanted) {
  const DVec3 sum = glm::cross(DVec3(corners[2] - corners[0]), DVec3(corners[3] - corners[1]));
  const DVec3 triangle = glm::cross(DVec3(corners[1] - corners[0]), DVec3(corners[2] - corners[0]));
  const DVec3 normal = corners[2] == corners[3] ? triangle : sum;
  return glm::dot(normal, wanted) > 0.5 * glm::length(normal) ? normal : DVec3(0);
}

struct FaceRow {
  std::array<Vec3, 4> corners;
  std::array<DVec3, 4> fine;  // the same before the origin was taken off, and before rounding
  uint8_t corner_count;
  Vec3 normal;
  uint8_t sides;
  uint32_t sheet;
};

void push_face(FaceTable& faces, const FaceRow& row, Rgb emission, Rgb reflectance, uint32_t polygon,
               uint32_t surface, float patch_size, float patch_size_min, uint8_t level) {
  faces.corners.push_back(row.corners);
  faces.corner_count.push_back(row.corner_count);
  faces.normal.push_back(row.normal);
  faces.emission.push_back(emission);
  faces.reflectance.push_back(reflectance);
  faces.polygon.push_back(polygon);
  faces.surface.push_back(surface);
  faces.twin.push_back(kNone);
  faces.patch_size.push_back(patch_size);
  faces.patch_size_min.push_back(patch_size_min);
  faces.level_min.push_back(level);
}

FaceRow turned_over(const FaceRow& row) {
  const auto& c = row.corners;
  const auto& f = row.fine;
  if (row.corner_count == 3)
    return {{c[0], c[2], c[1], c[1]}, {f[0], f[2], f[1], f[1]}, 3, -row.normal, row.sides, row.sheet};
  return {{c[0], c[3], c[2], c[1]}, {f[0], f[3], f[2], f[1]}, 4, -row.normal, row.sides, row.sheet};
}

// The faces of polygon p, in engine lengths, that floats can tell apart from nothing; all that doubles can,
// where `fine_corners` are kept.
void convert_faces(const CutTable& table, uint32_t p, const Scene& scene, bool fine_corners,
                   std::vector<FaceRow>& rows) {
  rows.clear();
  for (uint32_t f = table.face_first[p]; f < table.face_first[p + 1]; ++f) {
    FaceRow row;
    row.corner_count = is_triangle(table.faces[f]) ? 3 : 4;
    std::array<DVec3, 4> corners;
    for (size_t k = 0; k < 4; ++k) {
      const DVec3 point = table.points[table.point_first[p] + table.faces[f][k]];
      row.fine[k] = point / scene.units_per_length;
      corners[k] = (point - scene.origin) / scene.units_per_length;
      row.corners[k] = Vec3(corners[k]);
    }
    // Faces of a polygon that is off plane have normals of their own.
    const DVec3 own = glm::cross((corners[2] - corners[0]), corners[3] - corners[1]);
    const DVec3 triangle = glm::cross(corners[1] - corners[0], corners[2] - corners[0]);
    const DVec3 exact = row.corner_count == 3 ? triangle : own;
    const double length = glm::length(exact);
    const DVec3 normal = length > 0 ? exact / length : table.normal[p];
    if (!(glm::dot(normal, table.normal[p]) > 0)) continue;
    if (!(fine_corners && length > 0) && float_normal(row.corners, normal) == DVec3(0)) continue;
    row.normal = Vec3(normal);
    row.sides = table.sides[f];
    row.sheet = table.sheet[f];
    rows.push_back(row);
  }
}

// Unit, from the outline's first corner to the next that is another one.
Vec3 find_first_edge(const OutlineTable& outlines, uint32_t p) {
  const uint32_t ring = outlines.polygon_first[p], first = outlines.ring_first[ring];
  for (uint32_t k = first + 1; k < outlines.ring_first[ring + 1]; ++k)
    if (const DVec3 edge = outlines.corners[k] - outlines.corners[first]; glm::length(edge) > 0)
      return Vec3(edge / glm::length(edge));
  return Vec3(1, 0, 0);
}

// `first_of_sheet`: of each sheet the face that came first.
void add_polygon_faces(const CutTable& table, const MaterialTable& materials, const ObjectTable& objects,
                       const OutlineTable& outlines, const Tree& tree, uint32_t p, std::vector<FaceRow>& rows,
                       std::vector<uint32_t>& first_of_sheet, bool fine_corners, Scene& scene) {
  const uint32_t object = outlines.object[p], material = outlines.material[p];
  const bool two_sided = objects.two_sided[object] != 0;
  const auto emission = Rgb(materials.emission[material]);
  const auto reflectance = Rgb(materials.reflectance[material]);
  const auto patch_size = to_patch_size(objects.patch_size[object] / scene.units_per_length);
  const auto patch_size_min = to_patch_size(objects.patch_size_min[object] / scene.units_per_length);
  const uint32_t line = tree.nodes[outlines.ring_node[outlines.polygon_first[p]]].line;
  convert_faces(table, p, scene, fine_corners, rows);
  const uint8_t level = rows.empty() ? uint8_t{0} : level_for(objects.subdivide[object], rows.size());
  const Vec3 first_edge = find_first_edge(outlines, p);
  for (FaceRow& row : rows) {
    if (row.sides != (kFrontSide | kBackSide)) continue;
    row.sheet = static_cast<uint32_t>(first_of_sheet.size());
    first_of_sheet.push_back(kNone);
  }
  for (int side = 0; side < (two_sided ? 2 : 1); ++side) {
    const auto polygon = static_cast<uint32_t>(scene.polygons.size());
    for (const FaceRow& row : rows) {
      if (!(row.sides & (side == 0 ? kFrontSide : kBackSide))) continue;
      const auto face = static_cast<uint32_t>(scene.faces.size());
      const FaceRow turned = side == 0 ? row : turned_over(row);
      if (fine_corners) scene.fine_corners.push_back(turned.fine);
      push_face(scene.faces, turned, emission, reflectance, polygon,
                objects.is_smooth[object] ? object : kNone, patch_size, patch_size_min, level);
      if (row.sheet == kNone) continue;
      uint32_t& first = first_of_sheet[row.sheet];
      if (first == kNone)
        first = face;
      else
        scene.faces.twin[face] = first, scene.faces.twin[first] = face;
    }
    scene.polygons.id.push_back(outlines.id[p] + (side == 0 ? "" : ".back"));
    scene.polygons.object.push_back(objects.top[object]);
    scene.polygons.line.push_back(line);
    scene.polygons.first_edge.push_back(first_edge);
    scene.polygons.face_first.push_back(static_cast<uint32_t>(scene.faces.size()));
  }
}

// Counts the patches that `subdivide` asks for; the polygon that takes the count past the limit is named.
void check_start_patches(Messages& messages, const Tree& tree, const CutTable& table,
                         const ObjectTable& objects, const OutlineTable& outlines, uint64_t limit) {
  uint64_t sum = 0;
  for (uint32_t p = 0; p < outlines.size(); ++p) {
    const uint32_t object = outlines.object[p];
    const uint64_t faces = table.face_first[p + 1] - table.face_first[p];
    if (faces == 0 || objects.subdivide[object] == 1) continue;
    const unsigned level = level_for(objects.subdivide[object], faces);
    const uint64_t each = level < 31 ? uint64_t{1} << (2 * level) : ~uint64_t{0} >> 2;
    uint64_t patches = 0;
    const uint64_t sides = objects.two_sided[object] ? 2 : 1;
    if (__builtin_mul_overflow(each, faces * sides, &patches) || __builtin_add_overflow(sum, patches, &sum) ||
        sum > limit) {
      add_error(messages, place_of(tree, objects.subdivide_node[object]), "too-many-patches",
                fmt::format("'subdivide: {}' takes the scene above the limit of {} starting patches "
                            "(--max-patches raises it)",
                            objects.subdivide[object], limit));
      return;
    }
  }
}

// A polygon so small for its distance from the scene's middle that single precision has no corners for it.
void warn_of_lost(Messages& messages, const Tree& tree, const OutlineTable& outlines, uint32_t p) {
  add_warning(messages, place_of(tree, outlines.ring_node[outlines.polygon_first[p]]), "scale-ratio",
              fmt::format("'{}' is left out: it is too small, so far from the others, for single precision",
                          escape_text(outlines.id[p])));
}

void make_sheets(Messages& messages, const Tree& tree, const MaterialTable& materials,
                 const ObjectTable& objects, const OutlineTable& outlines, double length, CutTable& table) {
  const std::vector<Overlap> overlaps = find_overlaps(objects, outlines, table, length);
  warn_of_coincident(messages, tree, objects, outlines, table, overlaps);
  std::vector<uint8_t> emits(outlines.size(), 0);
  for (uint32_t p = 0; p < outlines.size(); ++p)
    emits[p] = outlines.material[p] != kNone && materials.emission[outlines.material[p]] != DRgb(0);
  join_sheets(objects, outlines, emits, overlaps, length, table);
}

}  // namespace

void make_faces(Messages& messages, const Tree& tree, const MaterialTable& materials,
                const ObjectTable& objects, const OutlineTable& outlines, uint64_t start_patches_max,
                Scene& scene, bool fine_corners) {
  Sums sums;
  CutTable table = cut_all(messages, tree, materials, objects, outlines, start_patches_max, sums);
  if (messages.error_count > 0 || outlines.size() == 0) return;
  if (!(sums.area > 0))
    return add_error(messages, place_of(tree, outlines.ring_node[0]), "zero-area",
                     "all polygons are too small: their area is 0 even in double precision");
  if (sums.largest > kSizeRatioMax * sums.smallest)
    add_warning(messages, place_of(tree, outlines.ring_node[outlines.polygon_first[sums.smallest_polygon]]),
                "scale-ratio",
                fmt::format("'{}' is {:.2g} times smaller than the largest polygon: beyond {:.0g}, single "
                            "precision may lose it",
                            escape_text(outlines.id[sums.smallest_polygon]), sums.largest / sums.smallest,
                            kSizeRatioMax));
  set_units(sums, scene);
  make_sheets(messages, tree, materials, objects, outlines, scene.units_per_length, table);
  check_start_patches(messages, tree, table, objects, outlines, start_patches_max);
  scene.object_ids = objects.top_ids;
  scene.is_heat = std::all_of(outlines.material.begin(), outlines.material.end(),
                              [&](uint32_t row) { return materials.is_heat[row] != 0; });
  scene.polygons.face_first.assign(1, 0);
  std::vector<FaceRow> rows;
  std::vector<uint32_t> first_of_sheet(table.sheet_count, kNone);
  for (uint32_t p = 0; p < outlines.size(); ++p) {
    const size_t faces_before = scene.faces.size();
    add_polygon_faces(table, materials, objects, outlines, tree, p, rows, first_of_sheet, fine_corners,
                      scene);
    if (scene.faces.size() == faces_before && table.face_first[p] < table.face_first[p + 1])
      warn_of_lost(messages, tree, outlines, p);
  }
  if (scene.faces.size() == 0)
    add_error(messages, place_of(tree, outlines.ring_node[0]), "coordinate-too-large",
              "all polygons are lost in single precision: they are too small for their distances; move them "
              "nearer to each other");
  share_power(messages, tree, materials, objects, outlines, scene);
}

}  // namespace patchlight
