// Radiosity to shared-exponent words, pass by pass.
#include "tools/export/pass_record.h"

#include "tests/tools/export/lit_scene.h"

#include <doctest/doctest.h>

#include <limits>

using namespace patchlight;
using namespace patchlight::testing;

TEST_CASE("shared-exponent words are those of OpenGL") {
  // 1 is 256 / 512 times 2^1; the exponent's bias is 15.
  CHECK(pack_shared_exponent(Rgb(1)) == (16u << 27 | 256u << 18 | 256u << 9 | 256u));
  CHECK(pack_shared_exponent(Rgb(0)) == 0);
  CHECK(pack_shared_exponent(Rgb(511, 1, 0)) == (24u << 27 | 1u << 9 | 511u));
  // 511.75 rounds up to 512, which takes the next exponent.
  CHECK(unpack_shared_exponent(pack_shared_exponent(Rgb(511.75f, 0, 0))) == Rgb(512, 0, 0));
  // The smallest step is 2^-24.
  CHECK(unpack_shared_exponent(1) == Rgb(0x1p-24f, 0, 0));
  CHECK(pack_shared_exponent(Rgb(0x1p-24f, 0, 0)) == 1);
}

TEST_CASE("what a shared-exponent word cannot hold becomes its nearest") {
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  constexpr float kNoNumber = std::numeric_limits<float>::quiet_NaN();
  CHECK(unpack_shared_exponent(pack_shared_exponent(Rgb(kInfinity, 1e9f, 65408))) == Rgb(65408));
  CHECK(unpack_shared_exponent(pack_shared_exponent(Rgb(-1, kNoNumber, 2))) == Rgb(0, 0, 2));
}

TEST_CASE("a shared-exponent word errs by half a step of 2^-8 of its largest at most") {
  for (uint32_t k = 0; k < 2000; ++k) {
    const Vec2 a = make_jitter(7, k), b = make_jitter(8, k);
    const Rgb value = std::exp2(30 * b.y - 14) * Rgb(a.x, a.y, b.x);
    const Rgb back = unpack_shared_exponent(pack_shared_exponent(value));
    // Nine bits for up to twice the largest: steps of at most 2^-8 of it.
    for (int c = 0; c < 3; ++c) CHECK(std::abs(back[c] - value[c]) <= 0x1p-9f * largest(value) * 1.0001f);
  }
}

TEST_CASE("of shots a record keeps the powers of two and the last") {
  LitScene lit;
  add_box_inward(lit.scene.faces, Vec3(0), Vec3(1), make_box_surfaces(make_surface(1, 0.5f)));
  name_polygons(lit.scene, {"a.0", "a.1", "a.2", "a.3", "a.4", "a.5"});
  lit.scene.solver.rays = 16;
  lit.scene.solver.patch_count_max = 100;
  for (const Solver& solver : solvers())
    if (solver.chooses_steps) lit.record.solver = &solver;
  solve_scene(lit, 21);
  CHECK(lit.record.pass == std::vector<uint32_t>{1, 2, 4, 8, 16, 21});
}

TEST_CASE("a record keeps the first sixteen passes and the last, times two to the EV") {
  LitScene lit;
  add_box_inward(lit.scene.faces, Vec3(0), Vec3(1), make_box_surfaces(make_surface(1, 0.5f)));
  name_polygons(lit.scene, {"a.0", "a.1", "a.2", "a.3", "a.4", "a.5"});
  lit.scene.solver.rays = 16;
  lit.scene.solver.patch_count_max = 600;
  solve_scene(lit, 19);
  CHECK(lit.record.pass == std::vector<uint32_t>{1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16, 19});
  REQUIRE(lit.record.vertex.size() == 17);
  REQUIRE(lit.record.element.size() == 17);
  CHECK(lit.record.vertex[0].size() == lit.solution.mesh.element_vertices.size());
  CHECK(lit.record.element[0].size() == lit.solution.mesh.elements.size());
  // E = 1 and rho = 0.5 in a closed box: 1.5 after pass 1, 1.75 after pass 2, 2 at last; EV -1 halves them.
  for (const auto& [at, value] : {std::pair(0, 0.75f), {1, 0.875f}, {16, 1.0f}}) {
    CHECK(unpack_shared_exponent(lit.record.vertex[at][5]).g == doctest::Approx(value).epsilon(0.003));
    CHECK(unpack_shared_exponent(lit.record.element[at][5]).g == doctest::Approx(value).epsilon(0.003));
  }
}
