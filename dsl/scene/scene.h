// A scene as the loader hands it on: faces for the engine, and what the program needs to speak of them.
#pragma once

#include "engine/film/lens.h"
#include "engine/settings.h"
#include "engine/sky.h"
#include "engine/tables.h"

#include <algorithm>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

namespace patchlight {

// One row a polygon of the scene, in the order of the file; a two-sided polygon has a second row, `ID.back`.
struct PolygonTable {
  std::vector<std::string> id;
  std::vector<uint32_t> object;      // row of Scene::object_ids: what of the list `objects` it is a part of
  std::vector<uint32_t> line;        // 1-based place in the file
  std::vector<Vec3> first_edge;      // unit: along it u runs
  std::vector<uint32_t> face_first;  // polygons + 1: its faces are face_first[p] .. face_first[p + 1]
  size_t size() const { return id.size(); }
};

struct Camera {
  std::string name;         // empty for the single or the automatic camera
  DVec3 eye, target, up;    // engine lengths
  double fov_degrees = 60;  // vertical; some projections have a fixed one
  uint32_t width = 960, height = 720;
  const Projection* projection = &projections()[0];
};

enum class Shading { kSmooth, kFlat };

struct OutputSettings {
  std::string basename;               // empty: the scene file's name without .yaml
  std::vector<uint32_t> snapshots;    // ascending, no repeats; empty: the default 1, 2, 16
  std::optional<double> exposure_ev;  // none: automatic
  bool ambient = false;               // an estimate of the light that is unshot is shown, too
  Shading shading = Shading::kSmooth;
};

// What `verify` checks: the area mean of some polygons' radiosity after a pass.
struct Expectation {
  std::string object;              // as the file names it
  std::string file;                // where it stands, for messages
  uint32_t line = 0, column = 0;   // 1-based
  std::vector<uint32_t> polygons;  // rows of PolygonTable, at least one
  uint32_t pass = 16;
  bool after_last = false;  // the file names no pass: `pass` is the last of the file's settings
  Rgb radiosity{0};         // W/m2
  double tolerance = 0.02;  // share of the largest channel
};

// The settings that hold, in reading order: what they are called, their values as text, where they come from.
struct SettingTable {
  std::vector<std::string> path, value, origin;
  size_t size() const { return path.size(); }
};

// A length of a setting as a float. 0 means automatic, so what is above 0 stays above 0, and finite.
inline float to_patch_size(double length) {
  using Float = std::numeric_limits<float>;
  return length > 0 ? static_cast<float>(std::clamp<double>(length, Float::min(), Float::max())) : 0.0f;
}

struct Scene {
  std::string file;  // as the user named it; <stdin> for -
  std::string title;
  FaceTable faces;
  // The corners of all faces as doubles, without `origin` taken off; in lengths; empty unless asked for.
  std::vector<std::array<DVec3, 4>> fine_corners;
  Sky sky;
  PolygonTable polygons;
  std::vector<std::string> object_ids;
  bool is_heat = false;         // all materials in use are given by emissivity: one channel, W/m2 of heat
  std::vector<Camera> cameras;  // never empty: the automatic one where the file names none
  SolverSettings solver;
  OutputSettings output;
  std::vector<Expectation> expectations;
  SettingTable settings;  // for people, as the file and -D and --set leave them
  std::string units = "m";
  // A point of the file is origin + p * units_per_length, p in engine lengths. Both in the file's units.
  DVec3 origin{0};
  double units_per_length = 1;
  double metres_per_unit = 1;
  double metres_per_length() const { return units_per_length * metres_per_unit; }
};

}  // namespace patchlight
