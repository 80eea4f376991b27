// A small solved scene for the tests of what is written of it: a box, a lamp, a skewed plate that throws a
// shadow with many hanging corners, and two facets of one smooth surface.
#pragma once

#include "dsl/scene/scene.h"
#include "tests/scenes.h"
#include "tools/export/exporters.h"

#include <utility>

namespace patchlight::testing {

struct LitScene {
  Scene scene;
  Solution solution;
  PassRecord record;
  RunReport report;
  FinishedRun finished() const { return {scene, solution, record, report, "lit"}; }
};

inline void name_polygons(Scene& scene, std::vector<std::string> ids) {
  scene.polygons.id = std::move(ids);
  scene.polygons.line.assign(scene.polygons.size(), 1);
  scene.polygons.face_first.assign(1, 0);
  for (uint32_t polygon = 0, face = 0; polygon < scene.polygons.size(); ++polygon) {
    while (face < scene.faces.size() && scene.faces.polygon[face] == polygon) ++face;
    scene.polygons.face_first.push_back(face);
  }
}

// Solves with `pass_count` passes, records them, and makes the file's units centimetres.
inline void solve_scene(LitScene& lit, uint32_t pass_count) {
  Scene& scene = lit.scene;
  fit_scene(scene.faces);
  scene.units = "cm";
  scene.metres_per_unit = 0.01;
  scene.units_per_length = 250;
  scene.origin = DVec3(1000, 0, -50);
  lit.report.exposure_ev = -1;
  Camera camera;
  camera.eye = DVec3(0.2, 0.1, 0.3), camera.target = DVec3(0.2, 0.1, 0), camera.up = DVec3(0, 1, 0);
  scene.cameras = {camera};
  lit.solution = make_solution(make_surfaces(scene.faces, scene.sky), scene.solver);
  while (refine(lit.solution)) {
  }
  freeze(lit.solution);
  while (lit.solution.log.passes.size() < pass_count) {
    advance(lit.solution);
    record_pass(lit.record, lit.solution, Rgb(0), *lit.report.exposure_ev,
                lit.solution.log.passes.size() == pass_count);
  }
}

inline LitScene make_lit_scene() {
  LitScene lit;
  FaceTable& faces = lit.scene.faces;
  add_box_inward(faces, Vec3(0), Vec3(2, 1, 2), make_box_surfaces({Rgb(0), Rgb(0.6f, 0.5f, 0.4f)}));
  add_quad(faces, Vec3(0.8f, 0.95f, 0.8f), Vec3(1.2f, 0.95f, 0.8f), Vec3(1.2f, 0.95f, 1.2f),
           Vec3(0.8f, 0.95f, 1.2f), {Rgb(9, 8, 7), Rgb(0)});
  const uint32_t plate = next_polygon(faces);
  const FaceTable mixed = make_mixed_polygon({});
  for (size_t f = 0; f < mixed.size(); ++f) {
    std::vector<Vec3> corners;
    for (uint32_t k = 0; k < mixed.corner_count[f]; ++k) {
      const Vec3 p = mixed.corners[f][k];
      corners.emplace_back(0.7f + 0.4f * p.x, 0.5f, 1.2f - 0.4f * p.y);
    }
    add_face(faces, corners, plate, make_surface(0, 0.7f));
  }
  for (const auto& [left, right] : {std::pair(Vec3(0.2f, 0.1f, 0.3f), Vec3(0.5f, 0.2f, 0.3f)),
                                    std::pair(Vec3(0.5f, 0.2f, 0.3f), Vec3(0.8f, 0.25f, 0.3f))}) {
    const Vec3 depth(0, 0, 0.4f);
    add_quad(faces, left, left + depth, right + depth, right, make_surface(0, 0.5f));
    faces.surface.back() = 0;
  }
  name_polygons(lit.scene, {"hall.floor", "hall.ceiling", "hall.left", "hall.right", "hall.front",
                            "hall.back", "lamps[0]", "plate", "bowl.0", "bowl.1"});
  lit.scene.solver.rays = 64;
  lit.scene.solver.patch_count_max = 3000;
  solve_scene(lit, 3);
  return lit;
}

}  // namespace patchlight::testing
