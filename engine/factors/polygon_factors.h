// A scene's polygons to the matrix of form factors between them.
#pragma once

#include "engine/factors/shaft.h"
#include "engine/trace/tracer.h"

namespace patchlight {

struct FactorSettings {
  double error = 1e-3;  // smaller: more rays. No factor's estimated error is larger, three standard errors
  uint64_t seed = 1;    // another seed, other samples
};

// The matrix as it grows. F_ij is the share of the power that leaves the lit side of polygon i evenly and
// reaches the lit side of polygon j without a bounce; A_i F_ij = A_j F_ji is one number and kept once.
struct FactorTable {
  std::vector<double> area;           // a row a polygon, lengths squared; 0: it has no faces
  std::vector<double> exchange;       // A_i F_ij for i <= j, row by row, lengths squared
  std::vector<float> exchange_error;  // the same shape: three standard errors, or what rounding may change;
                                      // 0 where no rays were needed and rounding is far below 1e-6
  uint32_t row_done = 0;              // rows 0 .. row_done - 1 are known
  uint64_t clear_count = 0;           // pairs with nothing between them, found by integrals alone
  uint64_t hidden_count = 0;          // pairs of which one polygon hides all
  uint64_t sampled_count = 0;         // pairs whose visibility was found by rays
  uint64_t rough_count = 0;           // of these, those whose rays ran out before the error was reached
  uint64_t ray_count = 0;
  size_t size() const { return area.size(); }
};

// The scene prepared for it.
struct FactorScene {
  PartTable parts;
  Bvh tree;
};
FactorScene make_factor_scene(const FaceTable& faces, size_t polygon_count, const FineCorners& fine = {});

// Bytes that the table and its making take, an upper estimate.
uint64_t forecast_factor_bytes(size_t polygon_count, size_t face_count);

FactorTable make_factor_table(const FactorScene& scene, size_t polygon_count);

// Finds the next few rows of the table. Returns false when all are known. The result depends on the seed
// and not on threads. Pairs with nothing between them are exact to 1e-6 (contour.h); of the others the exact
// unoccluded exchange is multiplied by a ratio estimate of what passes (pair_rays.h), with as many rays as
// the error takes. Surfaces that touch (PartTable::touch) exchange nothing; where the two face each other and
// it is only their corners' being off one plane that lets them touch, the error is all that they may
// exchange. Throws Cancelled.
bool extend_factors(FactorTable& table, const FactorScene& scene, const FaceTable& faces,
                    const Tracer& tracer, const FactorSettings& settings);

// These hold for rows that are known. The exchange area A_i F_ij, lengths squared.
double find_exchange(const FactorTable& table, size_t i, size_t j);
double find_factor(const FactorTable& table, uint32_t i, uint32_t j);
double find_factor_error(const FactorTable& table, uint32_t i, uint32_t j);

}  // namespace patchlight
