// The lit mesh -> S.glb: binary glTF 2.0, in metres, y upwards as in the scene.
//
// The container is two chunks and the text is JSON, which json.h writes: a library for glTF would bring its
// own JSON, image code and a second copy of the mesh for these hundred lines. Colours are light that is there
// already: KHR_materials_unlit shows COLOR_0 as it is.
#include "bytes.h"
#include "dsl/report/diagnostics.h"
#include "exporters.h"
#include "exposure.h"
#include "json.h"
#include "lit_mesh.h"
#include "version.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <numbers>

namespace patchlight {
namespace {

// Words of the format.
constexpr uint32_t kMagic = 0x46546c67, kVersion = 2, kJsonChunk = 0x4e4f534a, kBinaryChunk = 0x004e4942;
constexpr int kUnsignedShort = 5123, kUnsignedInt = 5125, kFloat = 5126;
constexpr int kArrayBuffer = 34962, kElementArrayBuffer = 34963;
constexpr size_t kHeaderBytes = 12, kChunkHeaderBytes = 8;

// The columns of the binary chunk, one after the other, each with the rows of all things.
enum Column : size_t { kPosition, kNormal, kColor, kRadiosity, kIndex, kColumnCount };
constexpr std::array<size_t, kColumnCount> kRowBytes = {sizeof(Vec3), sizeof(Vec3), 4 * sizeof(uint16_t),
                                                        sizeof(Rgb), sizeof(uint32_t)};

// One node of the file.
struct Thing {
  std::string name;
  DVec3 centre{0};       // metres: its vertices are relative to it, which keeps their digits
  Vec3 low{0}, high{0};  // metres from the centre
  size_t vertex_first = 0, vertex_count = 0;
  size_t index_first = 0, index_count = 0;
};

struct Glb {
  std::vector<Thing> things;
  std::vector<Vec3> position, normal;
  std::vector<std::array<uint16_t, 4>> color;  // linear, 1 is display white; the fourth is opacity
  std::vector<Rgb> radiosity;
  std::vector<uint32_t> index;
};

uint16_t to_unsigned_short(float value) { return static_cast<uint16_t>(std::lround(value * 65535)); }

Glb make_glb(const Scene& scene, const LitMesh& mesh) {
  const TriangleTable triangles = make_triangles(mesh);
  const std::vector<Vec3> normals = find_polygon_normals(scene);
  const std::vector<Rgb> shown = expose_values(mesh.radiosity, *scene.output.exposure_ev);
  const ThingTable things = find_things(scene.polygons);
  const auto to_metres = [&](uint32_t vertex) {
    return to_file_units(scene, mesh.position[vertex]) * scene.metres_per_unit;
  };
  Glb glb;
  for (size_t t = 0; t < things.size(); ++t) {
    Thing& thing = glb.things.emplace_back();
    thing.name = things.name[t];
    thing.vertex_first = glb.position.size(), thing.index_first = glb.index.size();
    const std::span<const uint32_t> polygons(things.polygon.data() + things.first[t],
                                             things.polygon.data() + things.first[t + 1]);
    DVec3 low(std::numeric_limits<double>::max()), high(std::numeric_limits<double>::lowest());
    for (const uint32_t polygon : polygons)
      for (uint32_t v = mesh.vertex_first[polygon]; v < mesh.vertex_first[polygon + 1]; ++v)
        low = min(low, to_metres(v)), high = max(high, to_metres(v));
    thing.centre = 0.5 * (low + high);
    for (const uint32_t polygon : polygons) {
      // Rows move from the mesh's order to that of the things.
      const auto shift =
          static_cast<uint32_t>(glb.position.size() - thing.vertex_first - mesh.vertex_first[polygon]);
      for (uint32_t v = mesh.vertex_first[polygon]; v < mesh.vertex_first[polygon + 1]; ++v) {
        glb.position.emplace_back(to_metres(v) - thing.centre);
        glb.normal.push_back(normals[polygon]);
        const Rgb c = shown[v];
        glb.color.push_back({to_unsigned_short(c.r), to_unsigned_short(c.g), to_unsigned_short(c.b), 65535});
        glb.radiosity.push_back(mesh.radiosity[v]);
      }
      for (uint32_t k = triangles.polygon_first[polygon]; k < triangles.polygon_first[polygon + 1]; ++k)
        for (const uint32_t corner : triangles.corner[k]) glb.index.push_back(corner + shift);
    }
    thing.vertex_count = glb.position.size() - thing.vertex_first;
    thing.index_count = glb.index.size() - thing.index_first;
    thing.low = thing.high = glb.position[thing.vertex_first];
    for (size_t v = thing.vertex_first; v < glb.position.size(); ++v)
      thing.low = min(thing.low, glb.position[v]), thing.high = max(thing.high, glb.position[v]);
  }
  return glb;
}

template <class Vector>
Json make_array(const Vector& v) {
  return {v.x, v.y, v.z};
}

// From camera space, in which the view goes along -z and y is up, to the scene; column by column.
Json make_camera_matrix(const Scene& scene, const Camera& camera) {
  const DVec3 back = normalize(camera.eye - camera.target);
  const DVec3 right = normalize(cross(camera.up, back)), up = cross(back, right);
  const DVec3 eye = (scene.origin + camera.eye * scene.units_per_length) * scene.metres_per_unit;
  return {right.x, right.y, right.z, 0, up.x,  up.y,  up.z,  0,
          back.x,  back.y,  back.z,  0, eye.x, eye.y, eye.z, 1};
}

Json make_accessor(Column column, size_t first, size_t count, int component, const char* type) {
  return {{"bufferView", column},
          {"byteOffset", first * kRowBytes[column]},
          {"componentType", component},
          {"count", count},
          {"type", type}};
}

void add_things(Json& json, const Glb& glb) {
  for (const Thing& thing : glb.things) {
    const size_t first = json["accessors"].size();
    Json position = make_accessor(kPosition, thing.vertex_first, thing.vertex_count, kFloat, "VEC3");
    position["min"] = make_array(thing.low), position["max"] = make_array(thing.high);
    Json color = make_accessor(kColor, thing.vertex_first, thing.vertex_count, kUnsignedShort, "VEC4");
    color["normalized"] = true;
    json["accessors"].push_back(position);
    json["accessors"].push_back(
        make_accessor(kNormal, thing.vertex_first, thing.vertex_count, kFloat, "VEC3"));
    json["accessors"].push_back(color);
    json["accessors"].push_back(
        make_accessor(kRadiosity, thing.vertex_first, thing.vertex_count, kFloat, "VEC3"));
    json["accessors"].push_back(
        make_accessor(kIndex, thing.index_first, thing.index_count, kUnsignedInt, "SCALAR"));
    const Json attributes = {{"POSITION", first + kPosition},
                             {"NORMAL", first + kNormal},
                             {"COLOR_0", first + kColor},
                             {"_RADIOSITY", first + kRadiosity}};
    json["meshes"].push_back(
        {{"name", thing.name},
         {"primitives", {{{"attributes", attributes}, {"indices", first + kIndex}, {"material", 0}}}}});
    json["nodes"].push_back({{"name", thing.name},
                             {"mesh", json["meshes"].size() - 1},
                             {"translation", make_array(thing.centre)}});
  }
}

void add_cameras(Json& json, const Scene& scene) {
  const double metres_per_length = scene.metres_per_length();
  for (const Camera& camera : scene.cameras) {
    const std::string name = camera.name.empty() ? "camera" : "camera " + camera.name;
    json["cameras"].push_back({{"name", name},
                               {"type", "perspective"},
                               {"perspective",
                                {{"yfov", camera.fov_degrees * std::numbers::pi / 180},
                                 {"aspectRatio", double{1} * camera.width / camera.height},
                                 {"znear", 1e-3 * metres_per_length}}}});
    json["nodes"].push_back({{"name", name},
                             {"camera", json["cameras"].size() - 1},
                             {"matrix", make_camera_matrix(scene, camera)}});
  }
}

Json make_json(const Scene& scene, const Glb& glb) {
  Json json;
  json["asset"] = {{"version", "2.0"},
                   {"generator", fmt::format("patchlight {}", version_number())},
                   {"extras", {{"title", scene.title}, {"exposure", *scene.output.exposure_ev}}}};
  json["extensionsUsed"] = {"KHR_materials_unlit"};
  json["scene"] = 0;
  json["nodes"] = Json::array();
  json["materials"] = {{{"name", "lit"},
                        {"pbrMetallicRoughness", {{"metallicFactor", 0}, {"roughnessFactor", 1}}},
                        {"extensions", {{"KHR_materials_unlit", Json::object()}}}}};
  json["accessors"] = Json::array();
  add_things(json, glb);
  add_cameras(json, scene);
  Json roots = Json::array();
  for (size_t k = 0; k < json["nodes"].size(); ++k) roots.push_back(k);
  json["scenes"] = {{{"nodes", roots}}};
  size_t offset = 0;
  for (size_t column = 0; column < kColumnCount; ++column) {
    const bool index = column == kIndex;
    const size_t bytes = kRowBytes[column] * (index ? glb.index.size() : glb.position.size());
    Json view = {{"buffer", 0}, {"byteOffset", offset}, {"byteLength", bytes}};
    if (!index) view["byteStride"] = kRowBytes[column];
    view["target"] = index ? kElementArrayBuffer : kArrayBuffer;
    json["bufferViews"].push_back(view);
    offset += bytes;
  }
  json["buffers"] = {{{"byteLength", offset}}};
  return json;
}

}  // namespace

void export_glb(NewFile& file, const Scene& scene, const Solution& solution) {
  const Glb glb = make_glb(scene, make_lit_mesh(scene, solution, scene.output.shading));
  const Json json = make_json(scene, glb);
  std::string text = json.dump(-1, ' ', false, Json::error_handler_t::replace);
  text.append((4 - text.size() % 4) % 4, ' ');  // chunks end at whole words; so do all columns
  const size_t binary_bytes = json["buffers"][0]["byteLength"];
  const size_t bytes = kHeaderBytes + kChunkHeaderBytes + text.size() + kChunkHeaderBytes + binary_bytes;
  if (bytes > std::numeric_limits<uint32_t>::max())
    throw UserError(
        "write-failed",
        fmt::format("{}: a GLB file holds 4 GiB at most, and this mesh takes {} bytes", file.path, bytes));
  std::string head;
  for (const size_t word : {size_t{kMagic}, size_t{kVersion}, bytes, text.size(), size_t{kJsonChunk}})
    put_bytes(head, static_cast<uint32_t>(word));
  head += text;
  for (const size_t word : {binary_bytes, size_t{kBinaryChunk}}) put_bytes(head, static_cast<uint32_t>(word));
  append_file(file, head);
  append_file(file, view_bytes(std::span(glb.position)));
  append_file(file, view_bytes(std::span(glb.normal)));
  append_file(file, view_bytes(std::span(glb.color)));
  append_file(file, view_bytes(std::span(glb.radiosity)));
  append_file(file, view_bytes(std::span(glb.index)));
}

}  // namespace patchlight
