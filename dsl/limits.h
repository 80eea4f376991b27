// What the loader accepts at most. Every message about one of these names its number.
#pragma once

#include <cstddef>
#include <cstdint>

namespace patchlight {

constexpr size_t kSceneBytesMax = 32u << 20;
constexpr size_t kMeshBytesMax = 256u << 20;  // of one OBJ or MTL file
constexpr uint32_t kNestingMax = 64;
constexpr uint64_t kNodesMax = 2'000'000;
constexpr uint64_t kAliasNodesMax = 1'000'000;
constexpr uint64_t kPolygonsMax = 1'000'000;
constexpr uint32_t kCornersMax = 10'000;    // corners of one polygon, its holes included
constexpr double kCoordinateMax = 1e15;     // file units
constexpr double kSizeRatioMax = 1e7;       // largest to smallest polygon, a warning beyond
constexpr double kEmissionMax = 1e20;       // W/m2
constexpr uint32_t kImageSideMax = 16'384;  // pixels
constexpr uint64_t kImagePixelsMax = 64'000'000;
constexpr uint32_t kPassesMax = 10'000;
constexpr double kQualityMin = 0.01, kQualityMax = 100;  // times the work
constexpr uint64_t kStartPatchesMax =
    1'000'000;  // what `subdivide` may ask for, unless max_patches is larger
constexpr size_t kExpressionBytesMax = 1000;
constexpr int kExpressionDepthMax = 64;
constexpr size_t kIncludesMax = 256;
constexpr size_t kIncludeDepthMax = 16;
constexpr size_t kErrorsShown = 20;
constexpr size_t kWarningsShown = 20;  // of one kind

}  // namespace patchlight
