// The table of formats.
#include "exporters.h"

#include <cassert>

namespace patchlight {
namespace {

constexpr Exporter kExporters[] = {
    {.format = "png", .pixels = PixelKind::kDisplay, .encode_picture = encode_png},
    {.format = "exr", .pixels = PixelKind::kLayers, .encode_picture = encode_exr},
    {.format = "hdr", .pixels = PixelKind::kRadiosity, .encode_picture = encode_hdr},
    {.format = "svg", .pixels = PixelKind::kPlots},
    {.format = "csv",
     .pixels = PixelKind::kNoPixels,
     .name_end = "-patches",
     .export_solution = export_patches_csv},
    {.format = "glb",
     .pixels = PixelKind::kNoPixels,
     .exposed = true,
     .bytes_per_patch = 500,
     .export_solution = export_glb},
    {.format = "ply",
     .pixels = PixelKind::kNoPixels,
     .exposed = true,
     .bytes_per_patch = 300,
     .export_solution = export_ply},
    {.format = "obj",
     .pixels = PixelKind::kNoPixels,
     .exposed = true,
     .bytes_per_patch = 300,
     .export_solution = export_obj},
    {.format = "html",
     .pixels = PixelKind::kNoPixels,
     .exposed = true,
     .bytes_per_patch = 700,
     .export_passes = export_html},
};

}  // namespace

std::span<const Exporter> exporters() { return kExporters; }

std::vector<std::string> exporter_formats() {
  std::vector<std::string> formats;
  for (const Exporter& exporter : kExporters) formats.emplace_back(exporter.format);
  return formats;
}

const Exporter& find_exporter(std::string_view format) {
  for (const Exporter& exporter : kExporters)
    if (exporter.format == format) return exporter;
  assert(!"a format that the command line has let through");
  return kExporters[0];
}

}  // namespace patchlight
