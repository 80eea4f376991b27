// The solver `matrix`: all at once.
#pragma once

#include "engine/factors/polygon_factors.h"
#include "engine/solve/solve.h"

namespace patchlight {

// Form factors between the elements, each a polygon of its own.
FactorTable find_element_factors(const Solution& solution);

// The converged solution; freezes the mesh if that was not done. Throws std::domain_error where light never
// dies, as in a closed room of reflectance 1.
const PassReport& solve_matrix(Solution& solution);

bool is_solved(const Solution& solution);

}  // namespace patchlight
