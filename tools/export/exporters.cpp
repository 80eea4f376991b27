// The table of files that render writes.
#include "tools/export/exporters.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>

namespace patchlight {

// Each is the one function of its file export_NAME.cpp; svg has two.
using EncodePicture = std::string(const Picture&);
using EncodeAnimation = std::string(const Animation&);
using ExportRun = void(NewFile&, const FinishedRun&);
EncodePicture encode_png, encode_exr, encode_hdr, encode_pfm;
EncodeAnimation encode_gif;
ExportRun export_convergence, export_rounds, export_csv, export_glb, export_ply, export_obj, export_html,
    export_report;

namespace {

constexpr Exporter kExporters[] = {
    {.format = "png", .encode_picture = encode_png, .exposed = true},
    // Two pictures with their channels, each as columns of its own, as the library's blocks and as its file.
    {.format = "exr", .encode_picture = encode_exr, .layers = true, .bytes_per_pixel = 340},
    {.format = "hdr", .encode_picture = encode_hdr},
    {.format = "pfm", .encode_picture = encode_pfm},
    {.format = "gif", .encode_animation = encode_gif, .exposed = true},
    {.format = "svg", .export_run = export_convergence, .name_end = "-convergence"},
    {.format = "svg", .export_run = export_rounds, .name_end = "-rounds"},
    {.format = "csv", .export_run = export_csv, .name_end = "-patches"},
    {.format = "glb", .export_run = export_glb, .exposed = true, .bytes_per_patch = 500},
    {.format = "ply", .export_run = export_ply, .exposed = true, .bytes_per_patch = 300},
    {.format = "obj", .export_run = export_obj, .exposed = true, .bytes_per_patch = 300},
    {.format = "html", .export_run = export_html, .exposed = true, .records = true, .bytes_per_patch = 700},
    {.format = "json", .export_run = export_report, .name_end = "-report", .always = true},
};

}  // namespace

std::span<const Exporter> exporters() { return kExporters; }

std::vector<std::string> exporter_formats() {
  std::vector<std::string> formats;
  for (const Exporter& row : kExporters)
    if (!row.always && row.encode_animation == nullptr && (formats.empty() || formats.back() != row.format))
      formats.emplace_back(row.format);
  return formats;
}

const Exporter& find_exporter(std::string_view format) {
  const auto row = std::find_if(std::begin(kExporters), std::end(kExporters),
                                [&](const Exporter& other) { return other.format == format; });
  assert(row != std::end(kExporters));  // The command line lets no others through.
  return *row;
}

const Exporter& find_report() {
  return *std::find_if(std::begin(kExporters), std::end(kExporters),
                       [](const Exporter& row) { return row.always; });
}

std::string name_run_file(std::string_view stem, const Exporter& exporter) {
  return fmt::format("{}{}.{}", stem, exporter.name_end, exporter.format);
}

}  // namespace patchlight
