// What a scene's faces and its sky are to the solver: checked, with all that is derived from them. It never
// changes.
#pragma once

#include "engine/sky.h"
#include "engine/tables.h"
#include "engine/trace/tracer.h"

#include <memory>

namespace patchlight {

// What lies before a place counts as so many times as large as it is far away in the middle.
inline constexpr float kReachPerDistance = 8;

struct Surfaces {
  FaceTable faces;
  FaceFrameTable frames;
  FaceLinkTable links;         // within polygons
  FaceLinkTable smooth_links;  // and across smooth edges between them
  Tracer tracer;
  float scale = 0;  // lengths: find_scene_scale()
  // A row a face: 1: it reflects nothing, and others do. Where all is black, as in scenes of heat, what each
  // receives is what is asked for.
  std::vector<uint8_t> black;
  std::vector<float> reach;  // a row a face, lengths: the same for what lies before it, at most `scale`
  float reach_least = 0;     // lengths: no narrow gap has less
  Sky sky;
};

// Does any face reflect light, in any channel?
bool reflects_light(const FaceTable& faces);

// The scale, or that over a power of two, down to what lies within `wanted` lengths; not below reach_least.
float find_reach_step(const Surfaces& surfaces, float wanted);

// Throws std::invalid_argument, with the column and the row, where faces are not what tables.h says.
void check_faces(const FaceTable& faces);

// Checks the faces and the sky and prepares them. Throws what check_faces(), check_sky() and make_tracer()
// throw.
std::shared_ptr<const Surfaces> make_surfaces(FaceTable faces, Sky sky = {});

}  // namespace patchlight
