// The formats that render writes: one row a format, one file tools/export_<format>.cpp a row.
#pragma once

#include "dsl/scene.h"
#include "engine/solve.h"
#include "files.h"
#include "picture.h"

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace patchlight {

// What a format's pixels hold.
enum class PixelKind {
  kNoPixels,   // not a picture: a file of the whole solution, written once
  kDisplay,    // linear light, exposed, 0..1 is what a display shows
  kRadiosity,  // mean radiosity, W/m2, no limit
  kLayers,     // the same, and channels of its parts and of what is seen
  kPlots,      // not pictures either: drawings of how the run went (plots.h)
};

inline bool has_pixels(PixelKind kind) { return kind != PixelKind::kNoPixels && kind != PixelKind::kPlots; }

struct Exporter {
  std::string_view format;  // its name on the command line and the end of its files' names
  PixelKind pixels;
  std::string (*encode_picture)(const Picture&);  // has_pixels() only: a picture -> the file's bytes
  void (*export_solution)(NewFile&, const Scene&, const Solution&);  // kNoPixels only
};

std::span<const Exporter> exporters();
std::vector<std::string> exporter_formats();
// The row of a known format.
const Exporter& find_exporter(std::string_view format);

// export_png.cpp: 8-bit sRGB. Pixels outside 0..1 are clipped.
std::string encode_png(const Picture& picture);
// export_exr.cpp: float32 linear R, G, B, and the picture's channels.
std::string encode_exr(const Picture& picture);
// export_hdr.cpp: Radiance HDR, about one part in 200 exact.
std::string encode_hdr(const Picture& picture);
// export_csv.cpp: a row a patch, positions and areas in the file's units.
void export_patches_csv(NewFile& file, const Scene& scene, const Solution& solution);

}  // namespace patchlight
