// Where the power went: measured by the rays that patches send, against what patches say that they received.
#include "gather.h"
#include "parallel.h"
#include "solve.h"

namespace patchlight {
namespace {

constexpr uint32_t kEmissionRays = 1u << 16;  // for all lamps together

struct Shares {
  double nothing = 0, back = 0;  // of what a cell sends; the rest lands on lit sides
};

// What sends emission: a face, or a part of it.
struct Sender {
  uint32_t face, cell, level;
};

// Where a sender's emission goes. Rays of it alone: a lamp is often a single patch, whose row is short.
Shares find_emission_shares(const Sender& sender, uint32_t rays, const FaceTable& faces,
                            const FaceFrameTable& frames, const Tracer& tracer, uint64_t seed) {
  const uint32_t face = sender.face, cell = sender.cell, level = sender.level;
  const RowGrid grid = make_row_grid(rays);
  const Frame frame = make_frame(faces.normal[face]);
  const uint64_t key = make_row_key(seed, face, cell, level, kRowEmission);
  std::vector<uint32_t> nothing(grid.packet_count()), back(grid.packet_count());
  for_rows(grid.packet_count(), 16, [&](size_t begin, size_t end) {
    HitPacket packet;
    for (size_t tile = begin; tile < end; ++tile) {
      make_row_packet(packet, frames, frame, face, cell, level, key, grid, static_cast<uint32_t>(tile));
      find_hits(tracer, packet, 0xffff);
      for (uint32_t k = 0; k < kPacketSize; ++k) {
        const RayPacket& r = packet.ray;
        if (packet.face[k] == kNone) {
          ++nothing[tile];
        } else if (dot(Vec3(r.direction_x[k], r.direction_y[k], r.direction_z[k]),
                       faces.normal[packet.face[k]]) >= 0) {
          ++back[tile];
        }
      }
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
bool is_sent(const Solution& s, size_t patch) { return s.shots.empty() || s.shots[patch] > 0; }

// Faces whose emission is sent; of those that shots have sent in part, the patches that were.
std::vector<Sender> find_senders(const Solution& s, const FaceTable& faces) {
  std::vector<Sender> senders;
  for (uint32_t f = 0; f < faces.size(); ++f) {
    if (largest(faces.emission[f]) <= 0) continue;
    const uint32_t first = s.patches.face_first[f], last = s.patches.face_first[f + 1];
    uint32_t sent = 0;
    for (uint32_t p = first; p < last; ++p) sent += is_sent(s, p);
    if (sent == last - first) {
      senders.push_back({f, 0, 0});
      continue;
    }
    for (uint32_t p = first; p < last; ++p)
      if (is_sent(s, p)) senders.push_back({f, s.patches.cell[p], s.patches.level[p]});
  }
  return senders;
}

}  // namespace

PowerLedger find_power_ledger(const Solution& s, const FaceTable& faces, const Tracer& tracer,
                              const SolverSettings& settings) {
  PowerLedger ledger;
  for (uint32_t f = 0; f < faces.size(); ++f)
    ledger.emitted += double{cell_area(s.frames, f, 0, 0)} * DRgb(faces.emission[f]);
  const double emitted_sum = sum_channels(ledger.emitted);
  // Emission is sent once the first pass has run.
  if (s.passes.empty()) {
    ledger.unshot = ledger.emitted;
    return ledger;
  }
  for (const Sender& sender : find_senders(s, faces)) {
    const auto [face, cell, level] = sender;
    const DRgb power = double{cell_area(s.frames, face, cell, level)} * DRgb(faces.emission[face]);
    const double share = sum_channels(power) / std::max(emitted_sum, 1e-300);
    const auto rays = static_cast<uint32_t>(std::clamp(share * kEmissionRays, 256.0, double{kEmissionRays}));
    const Shares shares = find_emission_shares(sender, rays, faces, s.frames, tracer, settings.seed);
    ledger.escaped += shares.nothing * power;
    ledger.absorbed += shares.back * power;
  }
  const std::vector<Rgb> irradiance = element_irradiance(s);
  for (size_t p = 0; p < s.patches.size(); ++p) {
    const size_t receiver = s.receivers.receiver_of[p];
    const double nothing = s.hits.nothing[receiver], back = s.hits.back[receiver];
    const double valid = s.hits.valid_count(receiver);
    const DRgb rho(faces.reflectance[s.patches.face[p]]);
    DRgb received(0), unshot(0);
    for (uint32_t row = s.element_first[p]; row < s.element_first[p + 1]; ++row) {
      const double area = double{s.elements.area[row]} * s.elements.exposed[row];
      received += area * DRgb(irradiance[row]);
      unshot += area * DRgb(s.elements.unshot[row]);
    }
    ledger.unshot += unshot;
    ledger.absorbed += (DRgb(1) - rho) * received;
    // What is unshot of the light that was received.
    if (!is_sent(s, p))
      unshot -= double{s.patches.area[p]} * s.patches.exposed[p] * DRgb(faces.emission[s.patches.face[p]]);
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
