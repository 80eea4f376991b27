// The table of patches as text.
#include "engine/mesh/cell.h"
#include "tests/folder.h"
#include "tools/export/exporters.h"

#include <doctest/doctest.h>

using namespace patchlight;
using namespace patchlight::testing;

TEST_CASE("a row a patch, in the units of the file, with quoted names") {
  // A unit square in engine lengths; a length is two units of the file, and the file's origin is off by (10,
  // 0, 0).
  Scene scene;
  scene.units_per_length = 2;
  scene.origin = DVec3(10, 0, 0);
  scene.polygons.id = {"lamps[0,1]"};
  FaceTable& faces = scene.faces;
  faces.corners = {{Vec3(0, 0, 0), Vec3(0, 0, 1), Vec3(1, 0, 1), Vec3(1, 0, 0)}};
  faces.corner_count = {4};
  faces.normal.emplace_back(0, 1, 0);
  faces.emission.emplace_back(1, 2, 3);
  faces.reflectance.emplace_back(0.1f);
  faces.polygon = {0};
  faces.surface = {kNone};
  faces.twin = {kNone};
  faces.patch_size = {0};
  faces.patch_size_min = {0};
  faces.level_min = {0};
  Solution solution;
  solution.surfaces = make_surfaces(faces);
  solution.mesh.elements.face = {0};
  solution.mesh.elements.cell = {0};
  solution.mesh.elements.level = {1};
  solution.mesh.elements.area = {0.25f};
  solution.mesh.elements.radiosity.emplace_back(1.5f, 2.5f, 1e-9f);

  const Folder folder;
  NewFile file;
  open_file(file, folder / "p.csv");
  find_exporter("csv").export_run(file, {scene, solution, {}, {}, "room"});
  commit_file(file);
  CHECK(read_bytes(folder / "p.csv") ==
        "polygon,level,x,y,z,nx,ny,nz,area,reflectance_r,reflectance_g,reflectance_b,"
        "emission_r,emission_g,emission_b,radiosity_r,radiosity_g,radiosity_b\n"
        "\"lamps[0,1]\",1,10.5,0,0.5,0,1,0,1,0.1,0.1,0.1,1,2,3,1.5,2.5,1e-09\n");
}
