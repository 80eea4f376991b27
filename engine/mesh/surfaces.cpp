// Faces to surfaces.
#include "engine/mesh/surfaces.h"

#include "engine/mesh/cell.h"
#include "engine/mesh/face_links.h"

#include <limits>
#include <stdexcept>
#include <string>

namespace patchlight {
namespace {

constexpr float kNormalSlack = 1e-3f;  // of its length

void require(bool right, const char* column, size_t row, const char* expected) {
  if (right) return;
  throw std::invalid_argument(std::string("faces: ") + column + " of row " + std::to_string(row) + ": " +
                              expected);
}

void check_lengths(const FaceTable& faces) {
  for_each_column(
      [&](const char* name, const auto& column) {
        if (column.size() != faces.size())
          throw std::invalid_argument(std::string("faces: ") + name + " has " +
                                      std::to_string(column.size()) + " rows, normal has " +
                                      std::to_string(faces.size()));
      },
      faces);
}

bool is_between(Rgb value, float low, float high) {
  for (int k = 0; k < 3; ++k)
    if (!(value[k] >= low && value[k] <= high)) return false;  // nor is it NaN
  return true;
}

}  // namespace

void check_faces(const FaceTable& faces) {
  check_lengths(faces);
  constexpr float kLargest = std::numeric_limits<float>::max();
  for (size_t f = 0; f < faces.size(); ++f) {
    for (const Vec3& corner : faces.corners[f])
      for (int k = 0; k < 3; ++k)
        require(std::abs(corner[k]) <= kTracedCoordinateMax, "corners", f,
                "finite, and near enough to trace");
    require(faces.corner_count[f] == 3 || faces.corner_count[f] == 4, "corner_count", f, "3 or 4");
    require(std::abs(length(faces.normal[f]) - 1) <= kNormalSlack, "normal", f, "of length 1");
    require(is_between(faces.emission[f], 0, kLargest), "emission", f, "finite, at least 0");
    require(is_between(faces.reflectance[f], 0, 1), "reflectance", f, "from 0 to 1");
    require(f == 0 || faces.polygon[f] >= faces.polygon[f - 1], "polygon", f, "ascending");
    require(faces.polygon[f] != kNone, "polygon", f, "a polygon");
    require(faces.twin[f] == kNone || (faces.twin[f] < faces.size() && faces.twin[f] != f), "twin", f,
            "another face, or none");
    require(faces.patch_size[f] >= 0 && faces.patch_size[f] <= kLargest, "patch_size", f,
            "finite, at least 0");
  }
}

std::shared_ptr<const Surfaces> make_surfaces(FaceTable faces) {
  check_faces(faces);
  FaceFrameTable frames = make_face_frames(faces);
  FaceLinkTable links = make_face_links(faces);
  FaceLinkTable smooth_links = make_smooth_links(links, faces);
  Tracer tracer = make_tracer(faces);
  const float scale = find_scene_scale(faces, frames);
  return std::make_shared<const Surfaces>(Surfaces{std::move(faces), std::move(frames), std::move(links),
                                                   std::move(smooth_links), std::move(tracer), scale});
}

}  // namespace patchlight
