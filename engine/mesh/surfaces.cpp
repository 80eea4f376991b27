// Faces to surfaces.
#include "engine/mesh/surfaces.h"

#include "engine/base/parallel.h"
#include "engine/mesh/cell.h"
#include "engine/mesh/cell_rays.h"
#include "engine/mesh/face_links.h"

#include <algorithm>
#include <array>
#include <limits>
#include <stdexcept>
#include <string>

namespace patchlight {

bool reflects_light(const FaceTable& faces) {
  return std::any_of(faces.reflectance.begin(), faces.reflectance.end(),
                     [](const Rgb& reflectance) { return largest(reflectance) > 0; });
}

float find_reach_step(const Surfaces& surfaces, float wanted) {
  wanted = std::max(wanted, surfaces.reach_least);
  float reach = surfaces.scale;
  while (reach > wanted && reach > 1e-6f * surfaces.scale) reach /= 2;
  return reach;
}

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

// What a face sees is as large as the scene, or smaller by powers of two: a room on a wide ground is meshed
// as if it stood alone. In a room alone the median distance is about a quarter of the scale. A narrow gap
// does not count: none is smaller than what half of the area sees, of all that looks into the scene and not
// out of it, nor at a black dome that is there for a sky.
void find_reach(Surfaces& surfaces) {
  constexpr uint32_t kRays = 32;
  constexpr float kInside = 0.75f;
  std::vector<float>& reach = surfaces.reach;
  reach.resize(surfaces.faces.size());
  std::vector<float> inside(reach.size());
  const RayGrid grid = make_ray_grid(kRays);
  for_rows(reach.size(), 64, [&](size_t begin, size_t end) {
    HitPacket packet;
    for (auto face = static_cast<uint32_t>(begin); face < end; ++face) {
      const CellRays rays = make_cell_rays(surfaces.faces, {face, 0, 0}, kReachRays, 1, grid);
      std::array<float, kRays> seen;  // distances
      float hits = 0;
      for (uint32_t k = 0; k < grid.packet_count(); ++k) {
        make_ray_packet(packet, rays, surfaces.frames, k);
        find_hits(surfaces.tracer, packet, 0xffff);
        for (uint32_t ray = 0; ray < kPacketSize; ++ray) {
          const bool hit = packet.face[ray] != kNone;
          seen[k * kPacketSize + ray] =
              hit ? std::min(packet.ray.far_distance[ray], surfaces.scale) : surfaces.scale;
          hits += hit && largest(surfaces.faces.reflectance[packet.face[ray]]) > 0 ? 1.0f : 0.0f;
        }
      }
      // The median: a sky far behind an open front makes a room no larger.
      std::nth_element(seen.begin(), seen.begin() + kRays / 2, seen.end());
      reach[face] = kReachPerDistance * seen[kRays / 2];
      inside[face] = hits / kRays;
    }
  });
  std::vector<std::pair<float, double>> seen;  // distance, area
  double area = 0;
  for (uint32_t face = 0; face < reach.size(); ++face) {
    if (inside[face] < kInside) continue;
    seen.emplace_back(reach[face], double{cell_area(surfaces.frames, face, 0, 0)});
    area += seen.back().second;
  }
  std::sort(seen.begin(), seen.end());
  float typical = surfaces.scale;
  for (double before = 0; const auto& [distance, own] : seen) {
    typical = distance;
    if ((before += own) >= area / 2) break;
  }
  surfaces.reach_least = typical;
  for (float& own : reach) own = find_reach_step(surfaces, own);
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
    require(faces.patch_size_min[f] >= 0 && faces.patch_size_min[f] <= kLargest, "patch_size_min", f,
            "finite, at least 0");
  }
}

std::shared_ptr<const Surfaces> make_surfaces(FaceTable faces, Sky sky) {
  check_faces(faces);
  check_sky(sky);
  FaceFrameTable frames = make_face_frames(faces);
  FaceLinkTable links = make_face_links(faces);
  FaceLinkTable smooth_links = make_smooth_links(links, faces);
  Tracer tracer = make_tracer(faces);
  const float scale = find_scene_scale(faces, frames);
  const auto surfaces = std::make_shared<Surfaces>(Surfaces{std::move(faces),
                                                            std::move(frames),
                                                            std::move(links),
                                                            std::move(smooth_links),
                                                            std::move(tracer),
                                                            scale,
                                                            {},
                                                            {},
                                                            0,
                                                            std::move(sky)});
  surfaces->black.assign(surfaces->faces.size(), 0);
  if (reflects_light(surfaces->faces))
    for (size_t f = 0; f < surfaces->black.size(); ++f)
      surfaces->black[f] = largest(surfaces->faces.reflectance[f]) == 0;
  find_reach(*surfaces);
  return surfaces;
}

}  // namespace patchlight
