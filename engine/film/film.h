// A camera's picture as a gather: each pixel is a weighted sum of vertex (or element) values. The weights
// depend on the view only, so one film serves all passes of a run.
#pragma once

#include "engine/film/lens.h"
#include "engine/mesh/mesh.h"
#include "engine/mesh/surfaces.h"

#include <cstdint>
#include <span>
#include <vector>

namespace patchlight {

// What stands before the camera.
struct Scenery {
  const Surfaces& surfaces;
  const Mesh& mesh;
  std::vector<float> brightness;  // a row an element, W/m2: about what it will show
  float mean_brightness = 0;      // W/m2, of reflected light
};

struct FilmSettings {
  bool smooth = true;       // vertex values, bilinear; false: one value an element
  bool mesh_lines = false;  // also find where the edges of the elements run
  uint64_t seed = 1;
};

// CSR: pixel (row by row from the top left) -> (value, weight). Weights of a pixel sum to its share that
// shows the scene; the rest is background: the sky, or 0.
struct FilmTable {
  uint32_t width = 0, height = 0;
  std::vector<uint64_t> pixel_first;
  std::vector<uint32_t> value;
  std::vector<float> weight;
  std::vector<float> line_cover;  // a row a pixel, 0..1, if asked: how much of it the lines of the mesh cover
  // A row a pixel where there is a sky, else empty: its share that shows the sky, and the part of that where
  // the sun is, 0..1 each; the sky's mean emission there without the sun, W/m2.
  std::vector<float> sky_share, sun_share;
  std::vector<Rgb> sky;
  Rgb sun{0};  // W/m2: what the disc of the sun adds to the sky behind it
  uint64_t ray_count = 0;
};

// Box mean of at least 16 samples a pixel; 64 or 256 where very bright and dark elements share one, such as
// the borders of lamps and sun spots. Looks through back sides, except where the projection hides them.
// Smooth films need the final mesh; others may be made after any round, for the values that elements have
// then.
FilmTable make_film(const Scenery& scenery, const View& view, const FilmSettings& settings);

// What a ray through the centre of each pixel meets; looks through back sides. A row a pixel.
struct CentreTable {
  std::vector<uint32_t> element;  // kNone: nothing
  std::vector<float> depth;       // lengths along the direction of view; infinite where there is nothing
};
CentreTable find_centres(const Surfaces& surfaces, const PatchTable& elements, const View& view);

// One colour a pixel: the weighted sums of `values` (vertices or elements, as the film was made). The sky is
// left out.
std::vector<Rgb> expose(const FilmTable& film, std::span<const Rgb> values);

// What the sky is like in each pixel, without and with the sun, W/m2, for whatever turns values into what is
// shown; empty where there is no sky.
struct SkyValues {
  std::vector<Rgb> plain, with_sun;
};
SkyValues find_sky_values(const FilmTable& film);
// Adds the sky, as it is shown, behind all that the film shows: rows as those of find_sky_values().
void add_sky(std::span<Rgb> pixels, const FilmTable& film, const SkyValues& shown);

}  // namespace patchlight
