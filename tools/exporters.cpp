// The table of formats.
#include "exporters.h"

#include <cassert>

namespace patchlight {
namespace {

constexpr Exporter kExporters[] = {
    {"png", PixelKind::kDisplay, encode_png, nullptr},
    {"exr", PixelKind::kLayers, encode_exr, nullptr},
    {"hdr", PixelKind::kRadiosity, encode_hdr, nullptr},
    {"svg", PixelKind::kPlots, nullptr, nullptr},
    {"csv", PixelKind::kNoPixels, nullptr, export_patches_csv},
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
