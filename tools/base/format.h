// Numbers as people read them, the same in every locale.
#pragma once

#include "engine/solve/solvers.h"

#include <cstdint>
#include <string>
#include <string_view>

namespace patchlight {

std::string format_count(uint64_t count);    // 1234567 as "1.23 million"
std::string format_bytes(uint64_t bytes);    // "84.3 MB"
std::string format_seconds(double seconds);  // "0.8 s", "12 minutes", "3 days"
std::string format_watts(double watts);      // "1.23 kW"

// More than one step of a solver: passes, shots.
std::string name_steps(std::string_view step);

// The names of all solvers that can do that: "shooting", "a or b".
std::string name_solvers(bool Solver::*able);

// An id as a field of CSV: names of repeated parts hold commas, lamps[0,1,0].
std::string quote_csv(const std::string& id);

}  // namespace patchlight
