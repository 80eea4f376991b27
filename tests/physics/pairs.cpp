// Form factors of polygon pairs with known answers, measured through the solver: a emits, b receives.
#include "tests/form_factor_cases.h"
#include "tests/scenes.h"

#include <doctest/doctest.h>

using namespace patchlight;

namespace {

struct Factor {
  double value;
  double row_rays;  // how many rays of rows took part; 0: all light came by Lambert's formula and aimed rays
};

// The share of its own hemisphere that `to` sees of `from`: its irradiance where `from` emits 1.
Factor find_factor(const Corners& to, const Corners& from, const std::vector<Corners>& blockers) {
  FaceTable faces;
  add_polygon(faces, from, make_surface(1, 0));
  add_polygon(faces, to, make_surface(0, 0));
  for (const Corners& blocker : blockers) add_two_sided(faces, blocker, {}, {});
  fit_scene(faces);
  const Solution run = solve_scene(faces, {}, 1);
  const Solution& s = run;
  const double power = polygon_power(s, faces, 1, 2, element_irradiance(s)).g;
  double rays = 0;
  for (uint32_t row = s.mesh.patches.face_first[1]; row < s.mesh.patches.face_first[2]; ++row)
    if (s.light.smooth[row].g > 0) rays += s.transport.hits.ray_count;
  return {power / face_area(faces, 1), rays};
}

// What the project promises, 1e-4 by Lambert's formula and 1e-3 where blockers are sampled; and, where the
// lamp fills the sky so that rows see it, four standard errors of as many random rays.
double find_limit(const KnownPair& pair, const Factor& factor, double exact) {
  const double noise = factor.row_rays > 0 ? 4 * std::sqrt(exact * (1 - exact) / factor.row_rays) : 0;
  return (pair.blockers.empty() ? 1e-4 : 1e-3) + noise;
}

double find_area(const Corners& corners) {
  FaceTable faces;
  add_polygon(faces, corners, {});
  return face_area(faces, 0);
}

void check_pairs(const std::vector<KnownPair>& pairs) {
  for (const KnownPair& pair : pairs) {
    CAPTURE(pair.name);
    const double ratio = find_area(pair.a) / find_area(pair.b), factor_ba = ratio * pair.factor_ab;
    const Factor ab = find_factor(pair.a, pair.b, pair.blockers),
                 ba = find_factor(pair.b, pair.a, pair.blockers);
    const double limit_ab = find_limit(pair, ab, pair.factor_ab), limit_ba = find_limit(pair, ba, factor_ba);
    CHECK(std::abs(ab.value - pair.factor_ab) <= limit_ab);
    CHECK(std::abs(ba.value - factor_ba) <= limit_ba);
    // Reciprocity: A_a F_ab = A_b F_ba.
    CHECK(std::abs(ratio * ab.value - ba.value) <= ratio * limit_ab + limit_ba);
  }
}

}  // namespace

TEST_CASE("pass 1 carries the known form factors of pairs without blockers, whichever of the two emits") {
  check_pairs(kFreePairs);
}

TEST_CASE("pass 1 carries the known form factors of pairs with blockers, whichever of the two emits") {
  check_pairs(kBlockedPairs);
}
