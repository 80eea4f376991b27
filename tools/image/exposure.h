// Radiosity -> how bright the pictures of a run are.
#pragma once

#include "engine/film/film.h"
#include "engine/solve/solve.h"
#include "tools/image/srgb.h"
#include "tools/image/tone.h"

#include <span>
#include <vector>

namespace patchlight {

// Appends the brightness (largest channel, W/m2) of every pixel that shows the scene but no lamp, or, where
// all that is seen are lamps, of every pixel that shows the scene, or, where none does, of the sky without
// the sun; `values` are what the film was made for
// (smooth: vertices of the elements; else elements), W/m2.
void collect_brightness(std::vector<float>& brightness, const FilmTable& film, std::span<const Rgb> values,
                        const Solution& solution, const FaceTable& faces, bool smooth);

// The EV, in steps of 0.01, at which nine tenths of the pixels stay below display-linear 0.7: bright spots
// of the sun may clip, rooms may not be dark. By the largest channel, since a coloured wall that clips loses
// its colour. 0 where all is black. Reorders its input.
double pick_exposure_ev(std::span<float> brightness);

// Values as the display will show them: times 2^ev, then through the curve of `tone`, if any, and clipped to
// 0..1. This comes before the film's sums, so that the edge of a bright lamp is as smooth as any other. What
// is not a number is magenta.
std::vector<Rgb> expose_values(std::span<const Rgb> values, double ev, const Tone* tone = nullptr);

// Adds the sky behind all that the film shows, exposed as expose_values() does.
void show_sky(std::span<Rgb> pixels, const FilmTable& film, double ev, const Tone* tone = nullptr);

// Puts a colour where the film shows nothing of the scene, in parts of pixels, too. keep_sky: nor of the sky.
void fill_nothing(std::span<Rgb> pixels, const FilmTable& film, Rgb color, bool keep_sky = false);

// Blends the lines of the mesh into display-linear pixels: darker on bright ground, bluish on dark.
void draw_mesh_lines(std::span<Rgb> pixels, std::span<const float> line_cover);

}  // namespace patchlight
