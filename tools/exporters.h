// The formats that render writes: one row a format, one file tools/export_<format>.cpp a row.
#pragma once

#include "dsl/scene.h"
#include "engine/solve/solve.h"
#include "files.h"
#include "pass_record.h"
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
  std::string_view name_end = "";  // what its file's name has after S, before the dot; kNoPixels only
  bool exposed = false;            // kNoPixels: it shows light as the pictures do, by the run's exposure
  uint32_t bytes_per_patch = 0;    // kNoPixels: what writing it holds at most
  // One of these three, but for plots: a picture -> the file's bytes; a solution, or the passes to it, into a
  // file.
  std::string (*encode_picture)(const Picture&) = nullptr;
  void (*export_solution)(NewFile&, const Scene&, const Solution&) = nullptr;
  void (*export_passes)(NewFile&, const Scene&, const Solution&, const PassRecord&) = nullptr;
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
// These four write the lit mesh (lit_mesh.h), smooth or flat as scene.output.shading says, by
// scene.output.exposure_ev, which must be set.
// export_glb.cpp: binary glTF 2.0, in metres, a node a thing.
void export_glb(NewFile& file, const Scene& scene, const Solution& solution);
// export_ply.cpp: binary, little endian, in the file's units.
void export_ply(NewFile& file, const Scene& scene, const Solution& solution);
// export_obj.cpp: Wavefront OBJ with colours of vertices, in the file's units.
void export_obj(NewFile& file, const Scene& scene, const Solution& solution);
// export_html.cpp: a page that shows all recorded passes and needs nothing else.
void export_html(NewFile& file, const Scene& scene, const Solution& solution, const PassRecord& record);

}  // namespace patchlight
