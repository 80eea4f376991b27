// Where the power went: measured by the rays that patches send, against what patches say that they received.
#include "engine/base/parallel.h"
#include "engine/mesh/buried.h"
#include "engine/mesh/cell.h"
#include "engine/mesh/cell_rays.h"
#include "engine/mesh/quadtree.h"
#include "engine/solve/solve.h"

#include <algorithm>
#include <bit>

namespace patchlight {
namespace {

constexpr uint32_t kEmissionRayCount = 1u << 16;  // for all lamps together
// For the sky and for the sun, from all patches together, and the least and most from one.
constexpr double kSkyRayCount = 1 << 22, kSunRayCount = 1 << 20;
constexpr double kSkyRaysLeast = 16, kSkyRaysMost = 16384, kSunRaysLeast = 64;

struct Shares {
  double nothing = 0, back = 0;  // of what a cell sends; the rest lands on lit sides
};

// Which of the rays that met lit sides end inside of another solid, where nobody counts what is received: a
// bit a ray. That is where lamps shine that dip into solids.
uint32_t find_swallowed(const HitPacket& packet, uint32_t lit, const Solution& s) {
  const Surfaces& surfaces = *s.surfaces;
  uint32_t swallowed = 0;
  for (uint32_t k = 0; k < kPacketSize; ++k) {
    if (!(lit >> k & 1u)) continue;
    const uint32_t face = packet.face[k];
    const RayPacket& r = packet.ray;
    const Vec3 point = Vec3(r.origin_x[k], r.origin_y[k], r.origin_z[k]) +
                       r.far_distance[k] * Vec3(r.direction_x[k], r.direction_y[k], r.direction_z[k]);
    const uint32_t cell =
        find_cell(surfaces.frames.triangle[face], find_face_parameters(surfaces.frames, face, point));
    const float exposed = s.mesh.elements.exposed[find_leaf(s.mesh.elements, face, cell)];
    bool buried = exposed == 0;
    if (exposed > 0 && exposed < 1) {
      const Vec3 normal = surfaces.faces.normal[face], start = point + ray_offset(point) * normal;
      RayPacket probe = r;
      probe.origin_x[k] = start.x, probe.origin_y[k] = start.y, probe.origin_z[k] = start.z;
      buried = find_buried(surfaces, make_frame(normal), probe, 1u << k) != 0;
    }
    if (buried) swallowed |= 1u << k;
  }
  return swallowed;
}

// Where a sender's emission goes. Rays of it alone: a lamp is often a single patch, whose row is short.
Shares find_emission_shares(const CellRays& rays, const Solution& s) {
  const Surfaces& surfaces = *s.surfaces;
  const RayGrid& grid = rays.grid;
  std::vector<uint32_t> nothing(grid.packet_count()), back(grid.packet_count());
  for_rows(grid.packet_count(), 16, [&](size_t begin, size_t end) {
    HitPacket packet;
    for (size_t tile = begin; tile < end; ++tile) {
      make_ray_packet(packet, rays, surfaces.frames, static_cast<uint32_t>(tile));
      find_hits(surfaces.tracer, packet, 0xffff);
      uint32_t hit = 0;
      for (uint32_t k = 0; k < kPacketSize; ++k)
        if (packet.face[k] != kNone) hit |= 1u << k;
      uint32_t backs = find_backs(packet, surfaces.faces, 0xffff);
      backs |= find_swallowed(packet, hit & ~backs, s);
      nothing[tile] = static_cast<uint32_t>(std::popcount(~hit & 0xffff));
      back[tile] = static_cast<uint32_t>(std::popcount(backs));
    }
  });
  Shares shares;
  for (const uint32_t count : nothing) shares.nothing += count;
  for (const uint32_t count : back) shares.back += count;
  shares.nothing /= grid.ray_count();
  shares.back /= grid.ray_count();
  return shares;
}

// Shooting: has the patch sent its emission yet?
bool is_sent(const Solution& s, size_t patch) { return !s.shooting || s.shooting->shots[patch] > 0; }

// Faces whose emission is sent; of those that shots have sent in part, the patches that were.
std::vector<CellName> find_senders(const Solution& s) {
  const FaceTable& faces = s.surfaces->faces;
  std::vector<CellName> senders;
  for (uint32_t f = 0; f < faces.size(); ++f) {
    if (largest(faces.emission[f]) <= 0) continue;
    const uint32_t first = s.mesh.patches.face_first[f], last = s.mesh.patches.face_first[f + 1];
    uint32_t sent = 0;
    for (uint32_t p = first; p < last; ++p) sent += is_sent(s, p);
    if (sent == last - first) {
      senders.push_back({f});
      continue;
    }
    for (uint32_t p = first; p < last; ++p)
      if (is_sent(s, p)) senders.push_back(name_cell(s.mesh.patches, p));
  }
  return senders;
}

// What a patch receives of the sky, from rays of its own in all directions: none of the cells by which
// elements look at it. W/m2, mean over its whole area.
DRgb measure_sky(const CellRays& rays, const Surfaces& surfaces) {
  DRgb sum(0);
  HitPacket packet;
  for (uint32_t tile = 0; tile < rays.grid.packet_count(); ++tile) {
    make_ray_packet(packet, rays, surfaces.frames, tile);
    find_hits(surfaces.tracer, packet, 0xffff);
    const RayPacket& r = packet.ray;
    for (uint32_t k = 0; k < kPacketSize; ++k)
      if (packet.face[k] == kNone)
        sum += DRgb(find_sky_emission(surfaces.sky, {r.direction_x[k], r.direction_y[k], r.direction_z[k]}));
  }
  return sum / double(rays.grid.ray_count());
}

// The same of the sun: rays all over its disc.
DRgb measure_sun(const CellRays& rays, const Surfaces& surfaces) {
  const Sky& sky = surfaces.sky;
  const Frame frame = make_frame(sky.sun_direction);
  const float sine = std::sin(sky.sun_radius);
  double sum = 0;
  HitPacket packet;
  for (uint32_t tile = 0; tile < rays.grid.packet_count(); ++tile) {
    make_ray_packet(packet, rays, surfaces.frames, tile);
    RaySamples samples;
    make_ray_samples(samples, rays.key, rays.grid, tile);
    RayPacket& r = packet.ray;
    double weight[kPacketSize];
    for (uint32_t k = 0; k < kPacketSize; ++k) {
      const Vec3 disc = make_cosine_direction(samples.direction_x[k], samples.direction_y[k]);
      const float x = disc.x * sine, y = disc.y * sine, along = std::sqrt(1 - x * x - y * y);
      const Vec3 way = x * frame.tangent + y * frame.bitangent + along * frame.normal;
      r.direction_x[k] = way.x, r.direction_y[k] = way.y, r.direction_z[k] = way.z;
      weight[k] = double{dot(way, rays.frame.normal)} / double{along};
    }
    uint32_t active = find_positive(weight);
    active &= ~find_blocked(surfaces.tracer, r, active);
    for (uint32_t k = 0; k < kPacketSize; ++k)
      if (active >> k & 1u) sum += weight[k];
  }
  return sum / rays.grid.ray_count() * double{sine} * double{sine} * DRgb(sky.sun_emission);
}

// What enters the scene from the sky and the sun and strikes a lit side, W. What strikes the outside of a
// room is no part of it.
DRgb measure_sky_power(const Solution& s) {
  const Surfaces& surfaces = *s.surfaces;
  const Sky& sky = surfaces.sky;
  const PatchTable& patches = s.mesh.patches;
  if (sky.is_dark()) return DRgb(0);
  // Where rows left the scene here and met something there, more rays are worth more.
  std::vector<double> sky_share(patches.size(), 0), sun_share(patches.size(), 0);
  double sky_sum = 0, sun_sum = 0;
  for (size_t p = 0; p < patches.size(); ++p) {
    if (patches.exposed[p] == 0) continue;
    const size_t receiver = s.transport.receivers.receiver_of[p];
    const double open = double(s.transport.hits.nothing[receiver]) / s.transport.hits.ray_count;
    const double cosine = double{dot(surfaces.faces.normal[patches.face[p]], sky.sun_direction)};
    if (sky.is_lit() || sky.has_ground())
      sky_sum += sky_share[p] = double{patches.area[p]} * std::sqrt(open * (1 - open) + 1e-3);
    if (sky.has_sun() && cosine > -double{sky.sun_radius})
      sun_sum += sun_share[p] = double{patches.area[p]} * std::max(cosine, 0.02);
  }
  std::vector<DRgb> power(patches.size(), DRgb(0));
  for_rows(patches.size(), 16, [&](size_t begin, size_t end) {
    for (size_t p = begin; p < end; ++p) {
      const auto make_rays = [&](double wanted, double least) {
        const auto count = static_cast<uint32_t>(std::clamp(wanted, least, kSkyRaysMost));
        return make_cell_rays(surfaces.faces, name_cell(patches, static_cast<uint32_t>(p)), kSkyRays,
                              s.settings.seed, make_ray_grid(count));
      };
      const double area = double{patches.area[p]};
      if (sky_share[p] > 0)
        power[p] +=
            area * measure_sky(make_rays(kSkyRayCount * sky_share[p] / sky_sum, kSkyRaysLeast), surfaces);
      if (sun_share[p] > 0)
        power[p] +=
            area * measure_sun(make_rays(kSunRayCount * sun_share[p] / sun_sum, kSunRaysLeast), surfaces);
    }
  });
  DRgb sum(0);
  for (const DRgb& value : power) sum += value;
  return sum;
}

}  // namespace

PowerLedger find_power_ledger(const Solution& s) {
  const WorkersScope scope(s.workers);
  const FaceTable& faces = s.surfaces->faces;
  PowerLedger ledger;
  for (uint32_t f = 0; f < faces.size(); ++f)
    ledger.emitted += double{cell_area(s.surfaces->frames, f, 0, 0)} * DRgb(faces.emission[f]);
  const double lamp_sum = sum_channels(ledger.emitted);
  ledger.emitted += measure_sky_power(s);
  const double emitted_sum = sum_channels(ledger.emitted);
  // Emission is sent once the first pass has run.
  if (s.log.passes.empty()) {
    ledger.unshot = ledger.emitted;
    return ledger;
  }
  for (const CellName& sender : find_senders(s)) {
    const double area = double{cell_area(s.surfaces->frames, sender.face, sender.cell, sender.level)};
    const DRgb power = area * DRgb(faces.emission[sender.face]);
    const double share = sum_channels(power) / std::max(lamp_sum, 1e-300);
    const double rays = std::clamp(share * kEmissionRayCount, 256.0, double{kEmissionRayCount});
    const Shares shares = find_emission_shares(make_cell_rays(faces, sender, kEmissionRays, s.settings.seed,
                                                              make_ray_grid(static_cast<uint32_t>(rays))),
                                               s);
    ledger.escaped += shares.nothing * power;
    ledger.absorbed += shares.back * power;
  }
  const std::vector<Rgb> irradiance = element_irradiance(s);
  for (size_t p = 0; p < s.mesh.patches.size(); ++p) {
    const size_t receiver = s.transport.receivers.receiver_of[p];
    const double nothing = s.transport.hits.nothing[receiver], back = s.transport.hits.back[receiver];
    const double valid = s.transport.hits.valid_count(receiver);
    const DRgb rho(faces.reflectance[s.mesh.patches.face[p]]);
    DRgb received(0), unshot(0);
    for (uint32_t row = s.mesh.element_first[p]; row < s.mesh.element_first[p + 1]; ++row) {
      const double area = double{s.mesh.elements.area[row]} * s.mesh.elements.exposed[row];
      received += area * DRgb(irradiance[row]);
      unshot += area * DRgb(s.mesh.elements.unshot[row]);
    }
    ledger.unshot += unshot;
    ledger.absorbed += (DRgb(1) - rho) * received;
    // What is unshot of the light that was received.
    if (!is_sent(s, p))
      unshot -= double{s.mesh.patches.area[p]} * s.mesh.patches.exposed[p] *
                DRgb(faces.emission[s.mesh.patches.face[p]]);
    if (valid > 0) {
      ledger.escaped += (rho * received - unshot) * (nothing / valid);
      ledger.absorbed += (rho * received - unshot) * (back / valid);
    }
  }
  const DRgb miss = ledger.emitted - ledger.absorbed - ledger.escaped - ledger.unshot;
  ledger.closure_error = emitted_sum > 0 ? std::abs(sum_channels(miss)) / emitted_sum : 0;
  return ledger;
}

}  // namespace patchlight
