// Rays that leave, and the edges that they pass.
#include "engine/solve/leaks.h"

#include "engine/base/parallel.h"
#include "engine/mesh/cell_rays.h"

#include <algorithm>
#include <limits>

namespace patchlight {
namespace {

// Between these shares of light that leaves, a scene was perhaps to be closed.
constexpr double kEscapedLeast = 0.005, kEscapedMost = 0.3;
constexpr float kNearEdge = 0.03f;      // of its length
constexpr double kCrackShare = 0.6;     // of the rays that pass an edge nearest
constexpr size_t kWorkMax = 1'000'000;  // pairs of a ray and an edge
constexpr size_t kPatchesMost = 4096;   // that cast rays
constexpr size_t kEscapesLeast = 200, kEscapesMost = 4000;

struct Escape {
  Vec3 origin, direction;
  float weight;  // the area that it stands for
};

// One packet of rays from each of some patches all over the scene, evenly over its directions; those that hit
// nothing.
std::vector<Escape> find_escapes(const Solution& s, double& escaped) {
  const RayGrid grid = make_ray_grid(kPacketSize);
  const size_t stride = std::max<size_t>((s.mesh.patches.size() + kPatchesMost - 1) / kPatchesMost, 1);
  std::vector<std::vector<Escape>> escapes_of((s.mesh.patches.size() + stride - 1) / stride);
  for_rows(escapes_of.size(), 64, [&](size_t begin, size_t end) {
    HitPacket packet;
    for (size_t row = begin; row < end; ++row) {
      const size_t p = row * stride;
      if (s.mesh.patches.exposed[p] < 1) continue;
      const CellRays rays =
          make_cell_rays(s.surfaces->faces, name_cell(s.mesh.patches, p), kLeakRays, s.settings.seed, grid);
      make_ray_packet(packet, rays, s.surfaces->frames, 0);
      find_hits(s.surfaces->tracer, packet, 0xffff);
      const RayPacket& r = packet.ray;
      for (uint32_t k = 0; k < kPacketSize; ++k)
        if (packet.face[k] == kNone)
          escapes_of[row].push_back({{r.origin_x[k], r.origin_y[k], r.origin_z[k]},
                                     {r.direction_x[k], r.direction_y[k], r.direction_z[k]},
                                     s.mesh.patches.area[p] / kPacketSize});
    }
  });
  double area = 0;
  for (size_t p = 0; p < s.mesh.patches.size(); p += stride)
    if (s.mesh.patches.exposed[p] == 1) area += double{s.mesh.patches.area[p]};
  std::vector<Escape> escapes;
  for (const auto& list : escapes_of)
    for (const Escape& escape : list) {
      escapes.push_back(escape);
      escaped += double{escape.weight} / area;
    }
  return escapes;
}

struct BorderEdge {
  uint32_t face, edge;
  Vec3 start, along;
  float length;
};

std::vector<BorderEdge> find_border(const Surfaces& surfaces) {
  const FaceTable& faces = surfaces.faces;
  std::vector<BorderEdge> border;
  for (uint32_t f = 0; f < faces.size(); ++f)
    for (uint32_t k = 0; k < faces.corner_count[f]; ++k) {
      if (surfaces.links.edge[f][k].face != kNone) continue;
      const Vec3 start = faces.corners[f][k], end = faces.corners[f][(k + 1) % faces.corner_count[f]];
      border.push_back({f, k, start, end - start, distance(start, end)});
    }
  return border;
}

// The least distance of a half line and a segment, lengths (Ericson: Real-Time Collision Detection, 2005,
// section 5.1.9).
float find_distance(const Escape& ray, const BorderEdge& edge) {
  const Vec3 apart = ray.origin - edge.start;
  const float a = dot(ray.direction, ray.direction), e = dot(edge.along, edge.along);
  const float b = dot(ray.direction, edge.along), c = dot(ray.direction, apart), f = dot(edge.along, apart);
  const float parallel = a * e - b * b;
  float s = parallel > 1e-6f * a * e ? std::max((b * f - c * e) / parallel, 0.0f) : 0;
  const float t = std::clamp((b * s + f) / e, 0.0f, 1.0f);
  s = std::max((b * t - c) / a, 0.0f);
  return length(apart + s * ray.direction - t * edge.along);
}

}  // namespace

LeakReport find_leaks(const Solution& s) {
  const WorkersScope scope(s.workers);
  LeakReport report;
  const std::vector<Escape> escapes = find_escapes(s, report.escaped);
  if (report.escaped < kEscapedLeast || report.escaped > kEscapedMost) return report;
  const std::vector<BorderEdge> border = find_border(*s.surfaces);
  const size_t most = std::min(kWorkMax / std::max<size_t>(border.size(), 1), kEscapesMost);
  if (border.empty() || most < kEscapesLeast) return report;

  // An even choice of the rays, each with its nearest edge.
  const size_t stride = (escapes.size() + most - 1) / most, count = (escapes.size() + stride - 1) / stride;
  std::vector<uint32_t> nearest(count);
  std::vector<uint8_t> is_near(count);
  for_rows(count, 8, [&](size_t begin, size_t end) {
    for (size_t k = begin; k < end; ++k) {
      float least = std::numeric_limits<float>::max();
      for (uint32_t e = 0; e < border.size(); ++e)
        if (const float gap = find_distance(escapes[k * stride], border[e]); gap < least)
          least = gap, nearest[k] = e;
      is_near[k] = least < kNearEdge * border[nearest[k]].length;
    }
  });
  std::vector<double> passed(border.size(), 0), closely(border.size(), 0);
  double all = 0;
  for (size_t k = 0; k < count; ++k) {
    const auto weight = double{escapes[k * stride].weight};
    all += weight;
    passed[nearest[k]] += weight;
    if (is_near[k]) closely[nearest[k]] += weight;
  }
  double worst = 0;
  for (uint32_t e = 0; e < border.size(); ++e) {
    if (closely[e] <= kCrackShare * passed[e]) continue;
    report.through_cracks += closely[e] / all * report.escaped;
    if (closely[e] > worst) worst = closely[e], report.face = border[e].face, report.edge = border[e].edge;
  }
  return report;
}

}  // namespace patchlight
