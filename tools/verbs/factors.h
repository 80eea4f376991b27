// The verb factors: a scene -> the form factors between its polygons, on standard output.
#pragma once

#include "engine/factors/polygon_factors.h"
#include "tools/base/options.h"
#include "tools/base/talk.h"

#include <functional>

namespace patchlight {

enum class FactorFormat { kCsv, kJson };

struct FactorOptions {
  FactorFormat format = FactorFormat::kCsv;
  double error = 1e-3;  // of each factor, three standard errors
};

// Returns 0, or 128 and the signal that stopped it. Throws UserError.
int factors(const Options& options, Talk& talk);

// What is told beside the matrix. All polygons are rows of the scene's table.
struct FactorSummary {
  std::vector<double> row_sums;
  std::vector<double> row_errors;  // of the sums: the errors of their terms, which are independent, together
  double error_max = 0;            // the largest estimated error of a factor ...
  uint32_t error_from = 0, error_to = 0;  // ... and where it stands
  double reciprocity_error_max = 0;       // |A_i F_ij - A_j F_ji| over the smaller area
  std::vector<uint32_t> worst;  // rows whose sums are furthest from 1, those of 0 left out; at most five
};
FactorSummary summarize_factors(const FactorTable& table);

// The whole text, in parts, to `put`. Areas are in the scene's units squared.
using PutText = std::function<void(std::string_view)>;
void format_factors_csv(const PutText& put, const Scene& scene, const FactorTable& table,
                        const FactorSummary& summary);
void format_factors_json(const PutText& put, const Scene& scene, const FactorTable& table,
                         const FactorSummary& summary, const FactorSettings& settings);

}  // namespace patchlight
