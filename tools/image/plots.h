// How a run went -> drawings for pages and slides.
#pragma once

#include "engine/solve/solve.h"

#include <span>
#include <string>
#include <string_view>

namespace patchlight {

struct PlotText {
  std::string title;
  std::string_view step;  // what a step of the solver is called: pass, shot ...
  double metres_per_length = 1;
  double until = 0;  // the share of the first pass below which a run stops; 0: none
};

// SVG: the power that each step added, and what was then unshot where that is another, W, by decades.
std::string plot_convergence(std::span<const PassReport> steps, const PlotText& text);
// SVG: the patches after each round, a bar a round.
std::string plot_rounds(std::span<const RoundReport> rounds, const PlotText& text);

}  // namespace patchlight
