// Faces that are wrong are told by column and row, and all that is derived from right ones fits them.
#include "engine/mesh/surfaces.h"

#include "tests/scenes.h"

#include <doctest/doctest.h>

#include <functional>
#include <limits>
#include <stdexcept>
#include <string>

using namespace patchlight;

namespace {

FaceTable make_pair() {
  FaceTable faces;
  add_quad(faces, {0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, make_surface(1, 0.5f));
  add_triangle(faces, {0, 0, 1}, {0, 1, 1}, {1, 0, 1}, make_surface(0, 0.5f));
  return faces;
}

std::string find_fault(const std::function<void(FaceTable&)>& spoil) {
  FaceTable faces = make_pair();
  spoil(faces);
  try {
    make_surfaces(faces);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "";
}

template <typename Table>
constexpr size_t kColumnCount = std::tuple_size_v<decltype(list_columns(static_cast<const Table*>(nullptr)))>;

}  // namespace

TEST_CASE("tables: no column is missing from the list of its table") {
  constexpr size_t kBytes = sizeof(std::vector<float>);
  static_assert(sizeof(FaceTable) == kBytes * kColumnCount<FaceTable>);
  static_assert(sizeof(FaceFrameTable) == kBytes * kColumnCount<FaceFrameTable>);
  static_assert(sizeof(FaceLinkTable) == kBytes * kColumnCount<FaceLinkTable>);
  static_assert(sizeof(PatchTable) == kBytes * kColumnCount<PatchTable>);
  static_assert(sizeof(VertexTable) == kBytes * kColumnCount<VertexTable>);
  static_assert(sizeof(SightTable) == kBytes * kColumnCount<SightTable>);
  static_assert(sizeof(ReceiverTable) == kBytes * kColumnCount<ReceiverTable>);
  // And one number, the rays of a row.
  static_assert(sizeof(HitTable) == kBytes * kColumnCount<HitTable> + alignof(HitTable));
  FaceTable faces = make_pair();
  for_each_row_column([&](const char* name, auto& column) { CHECK_MESSAGE(column.size() == 2, name); },
                      faces);
}

TEST_CASE("surfaces: what is wrong with faces is told, with the column and the row") {
  CHECK(find_fault([](FaceTable&) {}) == "");
  constexpr float kInfinite = std::numeric_limits<float>::infinity();
  constexpr float kNoNumber = std::numeric_limits<float>::quiet_NaN();
  struct Fault {
    const char* told;
    std::function<void(FaceTable&)> spoil;
  };
  const Fault faults[] = {
      {"faces: twin has 1 rows, normal has 2", [](FaceTable& f) { f.twin.pop_back(); }},
      {"faces: corners of row 1: ", [](FaceTable& f) { f.corners[1][2].y = kNoNumber; }},
      {"faces: corners of row 0: ", [](FaceTable& f) { f.corners[0][3].x = 1e19f; }},
      {"faces: corner_count of row 1: 3 or 4", [](FaceTable& f) { f.corner_count[1] = 5; }},
      {"faces: normal of row 0: of length 1", [](FaceTable& f) { f.normal[0] *= 1.01f; }},
      {"faces: emission of row 0: ", [](FaceTable& f) { f.emission[0].b = kInfinite; }},
      {"faces: emission of row 1: ", [](FaceTable& f) { f.emission[1].r = -1e-6f; }},
      {"faces: reflectance of row 1: from 0 to 1", [](FaceTable& f) { f.reflectance[1].g = 1.001f; }},
      {"faces: reflectance of row 0: from 0 to 1", [](FaceTable& f) { f.reflectance[0].r = kNoNumber; }},
      {"faces: polygon of row 1: ascending",
       [](FaceTable& f) {
         f.polygon = {1, 0};
       }},
      {"faces: twin of row 0: ", [](FaceTable& f) { f.twin[0] = 2; }},
      {"faces: patch_size of row 1: ", [](FaceTable& f) { f.patch_size[1] = -1; }},
  };
  for (const Fault& fault : faults) {
    const std::string told = find_fault(fault.spoil);
    CHECK_MESSAGE(told.starts_with(fault.told), fault.told, " | ", told);
  }
}

TEST_CASE("surfaces: a row of each table for every face, and none for no faces") {
  const auto surfaces = make_surfaces(make_pair());
  CHECK(surfaces->frames.size() == 2);
  CHECK(surfaces->links.size() == 2);
  CHECK(surfaces->smooth_links.size() == 2);
  // A square of 1 and a triangle of a half.
  CHECK(surfaces->scale == doctest::Approx(std::sqrt(1.5)).epsilon(1e-6));
  CHECK(make_surfaces({})->scale == 0);
}
