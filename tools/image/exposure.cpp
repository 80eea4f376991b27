// Forecast radiosity -> EV, and values -> what the display shows of them.
#include "tools/image/exposure.h"

#include "engine/base/parallel.h"

#include <algorithm>
#include <cmath>

namespace patchlight {
namespace {

constexpr double kShareBelow = 0.9;
constexpr double kDisplayLevel = 0.7;
constexpr double kEvLimit = 100;
constexpr size_t kGrain = 4096;
const Rgb kLineTint{0.01f, 0.03f, 0.07f};
const Rgb kNoNumber{1, 0, 1};
constexpr float kLineKeeps = 0.4f;  // the share of the ground's light that a line lets through

// 1 for every value that belongs to a lamp.
std::vector<Rgb> mark_lamps(const Solution& solution, const FaceTable& faces, bool smooth) {
  const auto is_lamp = [&](uint32_t element) {
    return largest(faces.emission[solution.mesh.elements.face[element]]) > 0;
  };
  const VertexTable& vertices = solution.mesh.element_vertices;
  std::vector<Rgb> marks(smooth ? vertices.size() : solution.mesh.elements.size(), Rgb(0));
  for_rows(marks.size(), kGrain, [&](size_t begin, size_t end) {
    for (size_t row = begin; row < end; ++row) {
      // A vertex belongs to one polygon, and a polygon has one material: its first leaf tells.
      if (smooth && vertices.vertex_first[row] == vertices.vertex_first[row + 1]) continue;
      const uint32_t element =
          smooth ? vertices.vertex_leaf[vertices.vertex_first[row]] : static_cast<uint32_t>(row);
      if (is_lamp(element)) marks[row] = Rgb(1);
    }
  });
  return marks;
}

}  // namespace

void collect_brightness(std::vector<float>& brightness, const FilmTable& film, std::span<const Rgb> values,
                        const Solution& solution, const FaceTable& faces, bool smooth) {
  const std::vector<Rgb> lamp_share = expose(film, mark_lamps(solution, faces, smooth));
  const std::vector<Rgb> pixels = expose(film, values);
  for (size_t pixel = 0; pixel < pixels.size(); ++pixel) {
    const bool shows_scene = film.pixel_first[pixel] != film.pixel_first[pixel + 1];
    if (shows_scene && lamp_share[pixel].r <= 0) brightness.push_back(largest(pixels[pixel]));
  }
  if (!brightness.empty()) return;
  // Where all that is seen emits, the lamps are the picture.
  for (size_t pixel = 0; pixel < pixels.size(); ++pixel)
    if (film.pixel_first[pixel] != film.pixel_first[pixel + 1]) brightness.push_back(largest(pixels[pixel]));
  if (!brightness.empty()) return;
  for (const Rgb& sky : film.sky) brightness.push_back(largest(sky));
}

double pick_exposure_ev(std::span<float> brightness) {
  const auto lit = std::partition(brightness.begin(), brightness.end(), [](float l) { return l > 0; });
  // Black pixels say nothing about how bright the lit ones should be.
  const size_t count = static_cast<size_t>(lit - brightness.begin());
  if (count == 0) return 0;
  const size_t rank = std::min(count - 1, static_cast<size_t>(kShareBelow * static_cast<double>(count)));
  std::nth_element(brightness.begin(), brightness.begin() + static_cast<ptrdiff_t>(rank), lit);
  const double ev = std::log2(kDisplayLevel / brightness[rank]);
  return std::clamp(std::round(ev * 100) / 100, -kEvLimit, kEvLimit);
}

std::vector<Rgb> expose_values(std::span<const Rgb> values, double ev, const Tone* tone) {
  const double gain = std::exp2(ev);
  const auto show = [&](float value) {
    const double exposed = value * gain;
    return static_cast<float>(std::clamp(tone != nullptr ? tone->bend(exposed) : exposed, 0.0, 1.0));
  };
  std::vector<Rgb> shown(values.size());
  for_rows(values.size(), kGrain, [&](size_t begin, size_t end) {
    for (size_t row = begin; row < end; ++row) {
      const Rgb value = values[row];
      shown[row] = std::isnan(value.r + value.g + value.b) ? kNoNumber
                                                           : Rgb(show(value.r), show(value.g), show(value.b));
    }
  });
  return shown;
}

void show_sky(std::span<Rgb> pixels, const FilmTable& film, double ev, const Tone* tone) {
  if (film.sky_share.empty()) return;
  SkyValues values = find_sky_values(film);
  for (std::vector<Rgb>* column : {&values.plain, &values.with_sun})
    *column = expose_values(*column, ev, tone);
  add_sky(pixels, film, values);
}

void fill_nothing(std::span<Rgb> pixels, const FilmTable& film, Rgb color, bool keep_sky) {
  for_rows(pixels.size(), kGrain, [&](size_t begin, size_t end) {
    for (size_t pixel = begin; pixel < end; ++pixel) {
      float shown = keep_sky && !film.sky_share.empty() ? film.sky_share[pixel] : 0;
      for (uint64_t k = film.pixel_first[pixel]; k < film.pixel_first[pixel + 1]; ++k)
        shown += film.weight[k];
      pixels[pixel] += std::max(1 - shown, 0.0f) * color;
    }
  });
}

void draw_mesh_lines(std::span<Rgb> pixels, std::span<const float> line_cover) {
  for (size_t pixel = 0; pixel < pixels.size(); ++pixel) {
    const Rgb line = kLineKeeps * pixels[pixel] + kLineTint;
    pixels[pixel] += line_cover[pixel] * (line - pixels[pixel]);
  }
}

}  // namespace patchlight
