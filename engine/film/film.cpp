// A view to weights: which vertex or element values make each pixel, and how much of each.
#include "engine/film/film.h"

#include "engine/base/parallel.h"
#include "engine/base/sampling.h"
#include "engine/film/seen.h"

#include <atomic>
#include <bit>
#include <cassert>
#include <limits>

namespace patchlight {
namespace {

constexpr uint32_t kSide = 4;  // samples a pixel: 4 x 4
// Where elements of different brightness share a pixel, more: the noise of an edge's cover is as large as the
// step is high. Steps are told in the scene's mean radiosity.
constexpr uint32_t kSideContrast = 8, kSideHighContrast = 16;
constexpr float kContrast = 1, kHighContrast = 3;

// The sum of one pixel under way: few distinct values, so a short list beats a map.
struct PixelSum {
  std::vector<uint32_t> value;
  std::vector<float> weight;
  void clear() { value.clear(), weight.clear(); }
  void add(uint32_t v, float w) {
    for (size_t k = value.size(); k-- > 0;)
      if (value[k] == v) {
        weight[k] += w;
        return;
      }
    value.push_back(v), weight.push_back(w);
  }
};

// What the samples of one tile say of one element: where in it they lie, as the moments that its corners
// need.
struct Moments {
  uint32_t element = kNone;
  float count = 0, s = 0, t = 0, st = 0;
};

// Adds the samples' shares to the corners of the element, or to the element.
void add_moments(PixelSum& sum, const Scenery& s, const Moments& m, float share, bool smooth) {
  if (!smooth) return sum.add(m.element, share * m.count);
  const auto& corner = s.mesh.element_vertices.leaf_vertex[m.element];
  if (s.surfaces.frames.triangle[s.mesh.elements.face[m.element]]) {
    sum.add(corner[0], share * std::max(m.count - m.s - m.t, 0.0f));
    sum.add(corner[1], share * m.s);
    sum.add(corner[2], share * m.t);
    return;
  }
  sum.add(corner[0], share * std::max(m.count - m.s - m.t + m.st, 0.0f));
  sum.add(corner[1], share * std::max(m.s - m.st, 0.0f));
  sum.add(corner[2], share * m.st);
  sum.add(corner[3], share * std::max(m.t - m.st, 0.0f));
}

// Adds a tile of samples, each of weight `share`. Neighbouring samples mostly show the same element.
void add_tile(PixelSum& sum, const Scenery& s, const Seen& seen, float share, bool smooth) {
  float across[kPacketSize], along[kPacketSize];
  for (uint32_t first = 0; first < kPacketSize;) {
    const uint32_t element = seen.element[first];
    uint32_t last = first + 1;
    while (last < kPacketSize && seen.element[last] == element) ++last;
    if (element != kNone) {
      const bool triangle = s.surfaces.frames.triangle[s.mesh.elements.face[element]];
      const CellFrame cell =
          make_cell_frame(triangle, s.mesh.elements.cell[element], s.mesh.elements.level[element]);
      // Rounding may put a point a hair outside its cell: no negative weights.
      for (uint32_t k = first; k < last; ++k) {
        across[k] = std::clamp((seen.u[k] - cell.origin.x) / cell.size, 0.0f, 1.0f);
        along[k] = std::clamp((seen.v[k] - cell.origin.y) / cell.size, 0.0f, 1.0f);
      }
      Moments m{element};
      for (uint32_t k = first; k < last; ++k) {
        Vec2 st(across[k], along[k]);
        if (triangle && st.x + st.y > 1) st /= st.x + st.y;
        m.count += 1, m.s += st.x, m.t += st.y, m.st += st.x * st.y;
      }
      add_moments(sum, s, m, share, smooth);
    }
    first = last;
  }
}

// Marks the pixels of a box, a pixel wider, unless it is large or lies outside.
void add_small_box(std::vector<uint8_t>& pixels, Vec2 low, Vec2 high, const Lens& lens, const View& view) {
  constexpr float kSmallLamp = 32;  // pixels
  const float left = low.x, right = high.x, top = low.y, bottom = high.y;
  const float width = lens.width, height = lens.height;
  if (right < 0 || bottom < 0 || left > width || top > height ||
      std::max(right - left, bottom - top) > kSmallLamp)
    return;
  const auto x_end = static_cast<uint32_t>(std::min(right + 2, width));
  const auto y_end = static_cast<uint32_t>(std::min(bottom + 2, height));
  for (auto y = static_cast<uint32_t>(std::max(top - 1, 0.0f)); y < y_end; ++y)
    for (auto x = static_cast<uint32_t>(std::max(left - 1, 0.0f)); x < x_end; ++x)
      pixels[size_t{y} * view.width + x] = 1;
}

// Pixels that the bounding boxes of small lamps cover, a pixel wider: sixteen samples might miss what is
// small and bright.
std::vector<uint8_t> find_lamp_pixels(const FaceTable& faces, const Lens& lens, const View& view) {
  std::vector<uint8_t> pixels(size_t{view.width} * view.height, 0);
  for (size_t f = 0; f < faces.size(); ++f) {
    if (largest(faces.emission[f]) == 0) continue;
    Vec2 low(std::numeric_limits<float>::max()), high(-std::numeric_limits<float>::max());
    bool behind = false;
    for (size_t k = 0; k < 4; ++k) {
      Vec2 at(0);
      behind |= !lens.find_place(faces.corners[f][k], at);
      low = min(low, at), high = max(high, at);
    }
    if (!behind) add_small_box(pixels, low, high, lens, view);
  }
  return pixels;
}

// Pixels that a small sun covers, as above.
void add_sun_pixels(std::vector<uint8_t>& pixels, const Sky& sky, const Lens& lens, const View& view) {
  if (!sky.has_sun()) return;
  const Frame frame = make_frame(sky.sun_direction);
  const float radius = std::tan(sky.sun_radius);
  Vec2 low(std::numeric_limits<float>::max()), high(-std::numeric_limits<float>::max());
  for (const Vec2& corner : {Vec2(-1, -1), Vec2(-1, 1), Vec2(1, -1), Vec2(1, 1)}) {
    Vec2 at(0);
    if (!lens.find_place(
            lens.eye + frame.normal + radius * (corner.x * frame.tangent + corner.y * frame.bitangent), at))
      return;
    low = min(low, at), high = max(high, at);
  }
  add_small_box(pixels, low, high, lens, view);
}

// What the samples of one pixel show of the sky.
struct SkySum {
  float share = 0, sun_share = 0;
  Rgb emission{0};  // summed over its samples
};

// Adds a tile of samples of weight `share`; widens the range of brightness.
void add_sky_tile(SkySum& sum, const Seen& seen, const Vec2 (&at)[kPacketSize], const Prospect& prospect,
                  float share, float& least, float& most) {
  if (seen.left == 0) return;
  const Sky& sky = prospect.surfaces.sky;
  Vec3 above(0), below(0);  // sums of directions
  float above_count = 0, below_count = 0, sun_count = 0;
  for (uint32_t rest = seen.left; rest != 0; rest &= rest - 1) {
    const Vec3 direction = prospect.lens.find_direction(at[static_cast<uint32_t>(std::countr_zero(rest))]);
    direction.y < 0 ? (below += direction, below_count += 1) : (above += direction, above_count += 1);
    sun_count += sky.has_sun() && is_in_sun(sky, direction);
  }
  // On each side of the horizon it is smooth: the middle of the samples tells their mean.
  for (const auto& [direction, count] : {std::pair{above, above_count}, {below, below_count}}) {
    if (count == 0) continue;
    const Rgb emission = find_sky_emission(sky, normalize(direction));
    sum.share += share * count, sum.emission += share * count * emission;
    least = std::min(least, largest(emission)), most = std::max(most, largest(emission));
  }
  sum.sun_share += share * sun_count;
  if (sun_count > 0) most = std::max(most, largest(sky.sun_emission));
}

// How much of each pixel the lines between elements cover: samples whose right or lower neighbour one pixel
// on shows another element lie on a line one pixel wide.
std::vector<float> find_line_cover(const View& view, const Prospect& prospect) {
  const size_t columns = size_t{view.width} * kSide, rows = size_t{view.height} * kSide;
  std::vector<uint32_t> shown(columns * rows);
  for_rows(size_t{view.width} * view.height, 256, [&](size_t begin, size_t end) {
    Seen seen;
    uint32_t guess = kNone;
    Vec2 at[kPacketSize];
    for (size_t pixel = begin; pixel < end; ++pixel) {
      const size_t x = pixel % view.width, y = pixel / view.width;
      for (uint32_t k = 0; k < kPacketSize; ++k)
        at[k] = Vec2(static_cast<float>(x), static_cast<float>(y)) +
                (Vec2(static_cast<float>(k % kSide), static_cast<float>(k / kSide)) + 0.5f) / float{kSide};
      find_seen(seen, guess, at, prospect);
      for (uint32_t k = 0; k < kPacketSize; ++k)
        shown[(y * kSide + k / kSide) * columns + x * kSide + k % kSide] = seen.element[k];
    }
  });
  std::vector<float> cover(size_t{view.width} * view.height, 0);
  for_rows(cover.size(), 1024, [&](size_t begin, size_t end) {
    for (size_t pixel = begin; pixel < end; ++pixel) {
      uint32_t count = 0;
      for (uint32_t k = 0; k < kPacketSize; ++k) {
        const size_t x = pixel % view.width * kSide + k % kSide, y = pixel / view.width * kSide + k / kSide;
        const size_t right = std::min(x + kSide, columns - 1), down = std::min(y + kSide, rows - 1);
        const uint32_t here = shown[y * columns + x];
        count += here != shown[y * columns + right] || here != shown[down * columns + x];
      }
      cover[pixel] = static_cast<float>(count) / kPacketSize;
    }
  });
  return cover;
}

}  // namespace

FilmTable make_film(const Scenery& s, const View& view, const FilmSettings& settings) {
  assert(s.mesh.frozen || !settings.smooth);
  assert(view.width > 0 && view.height > 0);
  const Prospect prospect{make_lens(view), s.surfaces, s.mesh.elements};
  const Sky& sky = s.surfaces.sky;
  std::vector<uint8_t> lamp_pixels = find_lamp_pixels(s.surfaces.faces, prospect.lens, view);
  add_sun_pixels(lamp_pixels, sky, prospect.lens, view);
  const size_t pixel_count = size_t{view.width} * view.height;
  struct Chunk {
    std::vector<uint32_t> value;
    std::vector<float> weight;
  };
  // Chunks of whole pixels, joined in order: the rows of pixels are of different lengths.
  constexpr size_t kChunk = 512;
  std::vector<Chunk> chunks((pixel_count + kChunk - 1) / kChunk);
  FilmTable film;
  film.width = view.width, film.height = view.height;
  film.pixel_first.assign(pixel_count + 1, 0);
  const bool has_sky = !sky.is_dark();
  film.sky_share.resize(has_sky ? pixel_count : 0);
  film.sun_share.resize(film.sky_share.size()), film.sky.resize(film.sky_share.size());
  film.sun = sky.sun_emission;
  std::atomic<uint64_t> ray_count{0};
  for_rows(chunks.size(), 1, [&](size_t begin, size_t end) {
    PixelSum sum;
    SkySum sky_sum;
    Seen seen;
    uint32_t guess = kNone;
    Vec2 at[kPacketSize];
    uint64_t rays = 0;
    for (size_t c = begin; c < end; ++c)
      for (size_t pixel = c * kChunk; pixel < std::min((c + 1) * kChunk, pixel_count); ++pixel) {
        const Vec2 corner(static_cast<float>(pixel % view.width), static_cast<float>(pixel / view.width));
        const uint64_t key = make_ray_key(settings.seed, static_cast<uint32_t>(pixel), 0, 0, 0);
        // side x side samples, a tile of 4 x 4 at a time.
        const auto take = [&](uint32_t side) {
          float least = std::numeric_limits<float>::max(), most = 0;
          sum.clear();
          sky_sum = {};
          const uint32_t tiles = side / 4;
          const float step = 1 / static_cast<float>(side), share = step * step;
          for (uint32_t tile = 0; tile < tiles * tiles; ++tile) {
            for (uint32_t k = 0; k < kPacketSize; ++k) {
              const Vec2 stratum(static_cast<float>(tile % tiles * 4 + k % 4),
                                 static_cast<float>(tile / tiles * 4 + k / 4));
              at[k] = corner + (stratum + make_jitter(key, tile * kPacketSize + k)) * step;
            }
            rays += find_seen(seen, guess, at, prospect);
            add_tile(sum, s, seen, share, settings.smooth);
            if (has_sky) add_sky_tile(sky_sum, seen, at, prospect, share, least, most);
            for (uint32_t k = 0; k < kPacketSize; ++k) {
              if (has_sky && seen.left >> k & 1u) continue;
              const float value = seen.element[k] == kNone ? 0 : s.brightness[seen.element[k]];
              least = std::min(least, value), most = std::max(most, value);
            }
          }
          return most - least;
        };
        const float contrast = lamp_pixels[pixel] ? std::numeric_limits<float>::infinity() : take(kSide);
        if (contrast > kHighContrast * s.mean_brightness)
          take(kSideHighContrast);
        else if (contrast > kContrast * s.mean_brightness)
          take(kSideContrast);
        if (has_sky) {
          film.sky_share[pixel] = sky_sum.share, film.sun_share[pixel] = sky_sum.sun_share;
          film.sky[pixel] = sky_sum.share > 0 ? sky_sum.emission / sky_sum.share : Rgb(0);
        }
        film.pixel_first[pixel + 1] = sum.value.size();
        chunks[c].value.insert(chunks[c].value.end(), sum.value.begin(), sum.value.end());
        chunks[c].weight.insert(chunks[c].weight.end(), sum.weight.begin(), sum.weight.end());
      }
    ray_count += rays;
  });
  for (size_t k = 0; k < pixel_count; ++k) film.pixel_first[k + 1] += film.pixel_first[k];
  film.value.resize(film.pixel_first.back());
  film.weight.resize(film.pixel_first.back());
  for_rows(chunks.size(), 16, [&](size_t begin, size_t end) {
    for (size_t c = begin; c < end; ++c) {
      const auto first = static_cast<std::ptrdiff_t>(film.pixel_first[c * kChunk]);
      std::copy(chunks[c].value.begin(), chunks[c].value.end(), film.value.begin() + first);
      std::copy(chunks[c].weight.begin(), chunks[c].weight.end(), film.weight.begin() + first);
      chunks[c] = {};
    }
  });
  film.ray_count = ray_count;
  if (settings.mesh_lines) film.line_cover = find_line_cover(view, prospect);
  return film;
}

CentreTable find_centres(const Surfaces& surfaces, const PatchTable& elements, const View& view) {
  const Prospect prospect{make_lens(view), surfaces, elements};
  const Lens& lens = prospect.lens;
  const size_t pixel_count = size_t{view.width} * view.height;
  CentreTable centres;
  centres.element.assign(pixel_count, kNone);
  centres.depth.assign(pixel_count, std::numeric_limits<float>::infinity());
  for_rows((pixel_count + kPacketSize - 1) / kPacketSize, 16, [&](size_t begin, size_t end) {
    Seen seen;
    uint32_t guess = kNone;
    Vec2 at[kPacketSize];
    for (size_t packet = begin; packet < end; ++packet) {
      const size_t first = packet * kPacketSize, last = std::min(first + kPacketSize, pixel_count);
      for (size_t k = 0; k < kPacketSize; ++k) {
        const size_t pixel = std::min(first + k, last - 1);
        at[k] = Vec2(static_cast<float>(pixel % view.width), static_cast<float>(pixel / view.width)) + 0.5f;
      }
      find_seen(seen, guess, at, prospect);
      for (size_t k = 0; first + k < last; ++k) {
        if (seen.element[k] == kNone) continue;
        centres.element[first + k] = seen.element[k];
        centres.depth[first + k] = seen.distance[k] * dot(lens.find_direction(at[k]), lens.forward);
      }
    }
  });
  return centres;
}

std::vector<Rgb> expose(const FilmTable& film, std::span<const Rgb> values) {
  std::vector<Rgb> pixels(size_t{film.width} * film.height);
  for_rows(pixels.size(), 4096, [&](size_t begin, size_t end) {
    for (size_t pixel = begin; pixel < end; ++pixel) {
      Rgb sum(0);
      for (uint64_t k = film.pixel_first[pixel]; k < film.pixel_first[pixel + 1]; ++k)
        sum += film.weight[k] * values[film.value[k]];
      pixels[pixel] = sum;
    }
  });
  return pixels;
}

SkyValues find_sky_values(const FilmTable& film) {
  SkyValues values{film.sky, film.sky};
  for (Rgb& value : values.with_sun) value += film.sun;
  return values;
}

void add_sky(std::span<Rgb> pixels, const FilmTable& film, const SkyValues& shown) {
  if (film.sky_share.empty()) return;
  for_rows(pixels.size(), 4096, [&](size_t begin, size_t end) {
    for (size_t pixel = begin; pixel < end; ++pixel)
      pixels[pixel] += (film.sky_share[pixel] - film.sun_share[pixel]) * shown.plain[pixel] +
                       film.sun_share[pixel] * shown.with_sun[pixel];
  });
}

}  // namespace patchlight
