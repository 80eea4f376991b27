// A solution under way -> the pixels of its pictures.
#pragma once

#include "tools/base/talk.h"
#include "tools/image/picture.h"
#include "tools/render/run.h"

#include <span>
#include <vector>

namespace patchlight {

// False colours stand on this where nothing is hit.
inline const Rgb kNothingColor{0.02f};

View make_view(const Camera& camera);

// Once the mesh is final: the films, and what all pictures of the run have in common, so that a finished one
// stays right whatever comes later: the exposure and the scale of false colours.
PictureState start_pictures(const Task& task, const Solution& solution);

// Do films show values at vertices, or one an element?
bool is_smooth(const Task& task);

// Before pass 1, and after every pass: keeps of its light what later pictures need.
void keep_light(LightHistory& light, const Task& task, const Solution& solution);

// Radiosity after the passes so far, at the values of the films, W/m2.
std::vector<Rgb> find_radiosity(const Task& task, const Solution& solution);
// Warns of values that are negative or no numbers: pictures hide the first and show the second in magenta.
void check_values(std::span<const Rgb> radiosity, size_t pass_count, const std::string& scene_file,
                  Talk& talk);
// Values as a display shows them, in the look that is asked for. lit: the part of the light that pictures
// show.
std::vector<Rgb> show_values(const Task& task, const PictureState& pictures, const Solution& solution,
                             std::span<const Rgb> lit);

// Is the sky behind the scene a part of the light that is shown? It is direct light, as lamps are.
bool shows_sky(const Plan& plan);

// The picture of a film for displays, with lines and a legend where they are asked for.
Picture show_film(const Task& task, const PictureState& pictures, size_t camera, std::span<const Rgb> shown);

// Adds what layered formats hold beside R, G, B: direct and indirect light, Z (depth in the scene's units,
// infinite where nothing is seen) and id (the row in S-patches.csv from 1, 0 for nothing), both at pixel
// centres.
void add_layers(Picture& picture, const Task& task, const PictureState& pictures, size_t camera,
                std::span<const Rgb> radiosity);

}  // namespace patchlight
