// What the loader and the program take at most. Every message about a limit names its number and its flag.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace patchlight {

// What a run may cost. Scenes by strangers are held to these; flags raise them.
struct Limits {
  uint64_t scene_bytes = 32u << 20;  // of a scene file and all that it includes
  uint64_t mesh_bytes = 256u << 20;  // of all OBJ and MTL files together
  uint64_t nesting = 64;
  uint64_t values = 2'000'000;        // nodes of the tree
  uint64_t alias_values = 1'000'000;  // nodes that aliases stand for
  uint64_t includes = 256;
  uint64_t include_depth = 16;
  uint64_t polygons = 1'000'000;
  uint64_t corners = 10'000;              // of one polygon, its holes included
  uint64_t starting_patches = 1'000'000;  // `max_patches` of the scene may be more
  uint64_t image_side = 16'384;           // pixels
  uint64_t image_pixels = 64'000'000;
  uint64_t expression_characters = 1000;
  uint64_t expression_depth = 64;
};

// What follows from the limit of polygons, a polygon: objects that hold none cost time, corners memory, and a
// copy is read anew, however little it makes.
constexpr uint64_t kObjectsPerPolygon = 4, kCornersPerPolygon = 8, kReadsPerPolygon = 64;

// One limit on the command line.
struct LimitRow {
  std::string_view flag;
  uint64_t Limits::*limit;
  uint64_t highest;       // that the flag takes: what the tables and the stack can hold
  std::string_view unit;  // of its number, in messages
  std::string_view description;
};

inline constexpr LimitRow kLimitRows[] = {
    {"--max-scene-bytes", &Limits::scene_bytes, uint64_t{1} << 31, "bytes",
     "of a scene file and all that it includes"},
    {"--max-mesh-bytes", &Limits::mesh_bytes, uint64_t{1} << 40, "bytes", "of all OBJ and MTL files"},
    {"--max-nesting", &Limits::nesting, 256, "levels", "of lists and maps in each other"},
    {"--max-values", &Limits::values, 2'000'000'000, "values", "in all files of a scene"},
    {"--max-alias-values", &Limits::alias_values, 2'000'000'000, "values", "that aliases stand for"},
    {"--max-includes", &Limits::includes, 100'000, "files", "included"},
    {"--max-include-depth", &Limits::include_depth, 100, "levels", "of files that include files"},
    {"--max-polygons", &Limits::polygons, 400'000'000, "polygons", "of a scene"},
    {"--max-corners", &Limits::corners, 1'000'000, "corners", "of one polygon, its holes included"},
    {"--max-side", &Limits::image_side, 65'535, "pixels a side", "of a picture"},
    {"--max-pixels", &Limits::image_pixels, 300'000'000, "pixels", "of a picture"},
    {"--max-expression", &Limits::expression_characters, 1'000'000, "characters", "of an expression"},
    {"--max-expression-depth", &Limits::expression_depth, 1000, "levels", "of brackets and signs in it"},
};

// "1000000 polygons (--max-polygons raises it)": what a message says of a limit of kLimitRows.
std::string limit_text(const Limits& limits, uint64_t Limits::*limit);

// What a message says of a picture that is too large; empty where it is not.
std::string find_image_fault(const Limits& limits, uint64_t width, uint64_t height);

constexpr double kCoordinateMax = 1e15;                  // file units
constexpr double kSizeRatioMax = 1e7;                    // largest to smallest polygon, a warning beyond
constexpr double kEmissionMax = 1e20;                    // W/m2
constexpr double kTemperatureMax = 1e6;                  // K: no surface is hotter
constexpr uint32_t kPassesMax = 10'000;                  // of a scene file; --passes takes more
constexpr double kErrorMin = 0.001, kErrorMax = 0.1;     // of the light, mean over mean
constexpr double kQualityMin = 0.01, kQualityMax = 100;  // times the work
constexpr size_t kErrorsShown = 20;
constexpr size_t kWarningsShown = 20;  // of one kind

}  // namespace patchlight
