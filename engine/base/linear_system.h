// The one door to Eigen: dense linear systems.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace patchlight {

// Solves M x = b by Cholesky's method for a symmetric positive definite M with a diagonal of about 1. matrix:
// n x n, of which the lower triangle is read, column by column; overwritten. b: n, becomes x. False, and b
// unchanged, if M is not positive definite, or so nearly singular that x would mean nothing (a condition of
// more than a million).
bool solve_positive_definite(std::vector<double>& matrix, std::span<double> b);

}  // namespace patchlight
