// Eigen, for the one call that is needed of it.
#include "engine/base/linear_system.h"

#include <Eigen/Cholesky>

#include <cassert>

namespace patchlight {
namespace {

constexpr double kConditionLeast = 1e-6;  // reciprocal

}  // namespace

bool solve_positive_definite(std::vector<double>& matrix, std::span<double> b) {
  const auto n = static_cast<Eigen::Index>(b.size());
  assert(matrix.size() == b.size() * b.size());
  Eigen::Map<Eigen::MatrixXd> lower(matrix.data(), n, n);
  Eigen::Map<Eigen::VectorXd> x(b.data(), n);
  // In place: a second matrix would double the memory.
  const Eigen::LLT<Eigen::Ref<Eigen::MatrixXd>, Eigen::Lower> factors(lower);
  if (factors.info() != Eigen::Success || factors.rcond() < kConditionLeast) return false;
  factors.solveInPlace(x);
  return true;
}

}  // namespace patchlight
