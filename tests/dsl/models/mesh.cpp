// Meshes: OBJ faces to polygons, their materials, and what is said of files that are wrong.
#include "dsl/models/mesh_files.h"
#include "tests/dsl/support.h"
#include "tests/folder.h"

#include <doctest/doctest.h>
#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <filesystem>

namespace patchlight::test {
namespace {

namespace fs = std::filesystem;
using testing::Folder;

const std::string kSquare = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

// Loads a scene of `objects` in a folder, beside the files that the test wrote.
Loaded load_in(const Folder& folder, const std::string& objects, const std::string& more = "") {
  testing::write_bytes(folder / "scene.yaml", kHead + kLight + objects + more);
  Loaded loaded;
  try {
    loaded.scene = load_scene(folder / "scene.yaml", loaded.warnings);
  } catch (const UserError& error) {
    loaded.errors = error.diagnostics;
  }
  return loaded;
}

// Loads an OBJ text as object `m` of material white.
Loaded load_obj(const std::string& obj, const std::string& more = "") {
  const Folder folder;
  testing::write_bytes(folder / "m.obj", obj);
  return load_in(folder, "  - {id: m, mesh: m.obj, material: white" + more + "}\n");
}

// Faces behind the lamp's.
size_t mesh_faces(const Loaded& loaded) { return loaded.scene.faces.size() - 1; }

double mesh_area(const Loaded& loaded) {
  double area = 0;
  for (size_t f = 1; f < loaded.scene.faces.size(); ++f) area += face_area(loaded.scene, f);
  return area;
}

// The ids behind the lamp's.
std::vector<std::string> mesh_ids(const Loaded& loaded) {
  const auto& ids = loaded.scene.polygons.id;
  return {ids.begin() + 1, ids.end()};
}

float reflectance_of(const Loaded& loaded, size_t face) { return loaded.scene.faces.reflectance[face].r; }

void check_message(const std::vector<Diagnostic>& list, std::string_view slug, std::string_view file,
                   int line, int column, std::string_view part) {
  CAPTURE(std::string(slug));
  const auto found =
      std::find_if(list.begin(), list.end(), [&](const Diagnostic& row) { return row.slug == slug; });
  REQUIRE(found != list.end());
  CHECK(found->file == file);
  CHECK(found->line == line);
  CHECK(found->column == column);
  INFO(found->message);
  CHECK(found->message.find(part) != std::string::npos);
}

TEST_CASE("a file's suffix tells its format, in upper or lower case; others are taken for the first one") {
  const std::span<const MeshFormat> formats = mesh_formats();
  for (const MeshFormat& format : formats) {
    const std::string suffix(format.suffix);
    CAPTURE(suffix);
    std::string upper = suffix;
    for (char& c : upper) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
    CHECK(suffix != upper);
    CHECK(&format_of_mesh("models/chair" + suffix) == &format);
    CHECK(&format_of_mesh("CHAIR" + upper) == &format);
  }
  for (const char* name : {"chair.txt", "chair", "obj", ""}) {
    CAPTURE(name);
    CHECK(&format_of_mesh(name) == &formats[0]);
  }
}

TEST_CASE("each face of a mesh is a polygon ID.0, ID.1 ..., its lit side as its corners run") {
  const Loaded loaded = load_obj(kSquare + "v 0.5 2 0\nf 1 2 3 4\nf 4 3 5\nf 1 4 3 2\n");
  REQUIRE(loaded.errors.empty());
  CHECK(mesh_ids(loaded) == std::vector<std::string>{"m.0", "m.1", "m.2"});
  REQUIRE(mesh_faces(loaded) == 3);
  CHECK(loaded.scene.faces.normal[1].z == 1);
  CHECK(loaded.scene.faces.normal[2].z == 1);
  CHECK(loaded.scene.faces.normal[3].z == -1);
  CHECK(face_area(loaded.scene, 1) == doctest::Approx(1));
  CHECK(face_area(loaded.scene, 2) == doctest::Approx(0.5));
}

TEST_CASE("all ways to name a corner mean the same") {
  for (const char* face : {"f 1 2 3 4", "f -4 -3 -2 -1", "f 1/9 2/9 3/9 4/9", "f 1//7 2//7 3//7 4//7",
                           "f 1/9/7 2/9/7 3/9/7 4/9/7", "f\t1  2 \\\n 3 4 # four\r", "fo 1 2 3 4"}) {
    CAPTURE(std::string(face));
    const Loaded loaded = load_obj(kSquare + face + "\n");
    REQUIRE(loaded.errors.empty());
    REQUIRE(mesh_faces(loaded) == 1);
    CHECK(corner_in_file(loaded.scene, 1, 2).x == doctest::Approx(1));
    CHECK(mesh_area(loaded) == doctest::Approx(1));
  }
}

TEST_CASE("other statements, comments, odd line ends and a byte order mark are passed over") {
  const Loaded loaded = load_obj(
      "\xef\xbb\xbf# a model\r\nmtllib none.mtl\r\no thing\r\ng a b\r\ns 1\r\nvn 0 0 1\r\nvt 0 0\r\n"
      "v 0 0 0 1.0\r\nv 1 0 0 0.5 0.5 0.5\r\nv +1.0 1e0 0\r\nv 0 1 -0\r\n\r\nusemtl a b\r\nl 1 2\r\np 1\r\n"
      "f 1 2 3 4");
  REQUIRE(loaded.errors.empty());
  CHECK(loaded.warnings.empty());  // the scene says what the mesh is made of: no MTL file is looked for
  CHECK(mesh_area(loaded) == doctest::Approx(1));
}

TEST_CASE("a face may name corners that come later") {
  const Loaded loaded = load_obj("f 1 2 3 4\n" + kSquare);
  REQUIRE(loaded.errors.empty());
  CHECK(mesh_area(loaded) == doctest::Approx(1));
}

TEST_CASE("faces with many corners, bent, concave or with a seam, keep their area") {
  // A U, a hole of 1 x 1 in a square of 3 x 3 that a seam joins to it, and two squares bent by 90 degrees.
  const Loaded u =
      load_obj("v 0 0 0\nv 3 0 0\nv 3 3 0\nv 2 3 0\nv 2 1 0\nv 1 1 0\nv 1 3 0\nv 0 3 0\nf 1 2 3 4 5 6 7 8\n");
  REQUIRE(u.errors.empty());
  CHECK(u.warnings.empty());
  CHECK(mesh_area(u) == doctest::Approx(7));
  CHECK(mesh_ids(u).size() == 1);
  const Loaded seam = load_obj(
      "v 0 0 0\nv 3 0 0\nv 3 3 0\nv 0 3 0\nv 1 1 0\nv 1 2 0\nv 2 2 0\nv 2 1 0\nf 1 2 3 4 1 5 6 7 8 5\n");
  REQUIRE(seam.errors.empty());
  CHECK(seam.warnings.empty());
  CHECK(mesh_area(seam) == doctest::Approx(8));
  const Loaded bent = load_obj("v 0 0 0\nv 1 0 0\nv 1 1 0\nv 1 1 1\nv 0 1 1\nv 0 1 0\nf 1 2 3 4 5 6\n");
  REQUIRE(bent.errors.empty());
  CHECK(mesh_area(bent) == doctest::Approx(2).epsilon(0.3));
  check_message(bent.warnings, "non-planar", "m.obj", 7, 1, "this face");
  // A little bent is usual: two triangles, and no word.
  const Loaded quad = load_obj("v 0 0 0\nv 1 0 0\nv 1 1 0.02\nv 0 1 0\nf 1 2 3 4\n");
  CHECK(mesh_faces(quad) == 2);
  CHECK(quad.warnings.empty());
}

TEST_CASE("faces that cross themselves are cut as well as it can be, with one warning") {
  const Loaded loaded = load_obj(kSquare + "v 2 0.5 0\nf 1 2 3 4\nf 1 3 5 4 2\nf 1 3 5 4 2\n");
  REQUIRE(loaded.errors.empty());
  CHECK(count_slug(loaded.warnings, "self-intersecting") == 1);
  check_message(loaded.warnings, "self-intersecting", "m.obj", 7, 1, "2 faces");
}

TEST_CASE("faces without area are left out, with one warning that counts them; the others keep their ids") {
  const Loaded loaded = load_obj(kSquare + "v 2 0 0\nf 1 2 5\nf 1 2 3 4\nf 1 1 2\nf 1 2\nf 1 2 2 3 3 1\n");
  REQUIRE(loaded.errors.empty());
  CHECK(mesh_ids(loaded) == std::vector<std::string>{"m.1", "m.4"});
  CHECK(count_slug(loaded.warnings, "zero-area") == 1);
  check_message(loaded.warnings, "zero-area", "m.obj", 6, 1, "3 faces");
}

TEST_CASE("what is wrong with an OBJ file is told at its place") {
  struct Wrong {
    const char* text;
    const char* slug;
    int line, column;
    const char* part;
  };
  for (const Wrong& wrong : {
           Wrong{"v nan 0 0", "non-finite", 5, 3, "'nan'"},
           {"v 0 1.#IND 0", "non-finite", 5, 5, "finite"},
           {"v 0 0 1e999", "number-out-of-range", 5, 7, "1e999"},
           {"v 0 0 1e16", "coordinate-too-large", 5, 1, "1e+15"},
           {"v 0 0", "mesh-invalid", 5, 1, "missing"},
           {"v 0 0,5 0", "mesh-invalid", 5, 5, "comma"},
           {"v 0 x 0", "mesh-invalid", 5, 5, "expected a number"},
           {"f 1 2 5", "mesh-invalid", 5, 1, "no vertex 5"},
           {"f 1 2 -5", "mesh-invalid", 5, 7, "no vertex -5"},
           {"f 0 1 2", "mesh-invalid", 5, 3, "counted from 1"},
           {"f 1 2 3.5", "mesh-invalid", 5, 7, "expected a corner"},
           {"f 1 2 3/1/2/4", "mesh-invalid", 5, 7, "expected a corner"},
           {"f 1 2 99999999999999999999", "mesh-invalid", 5, 7, "expected a corner"},
           {"f", "mesh-invalid", 5, 1, "without corners"},
           {"curv 0 1 1 2", "mesh-invalid", 5, 1, "curved"},
           {"patchlight: 1", "mesh-invalid", 5, 1, "no statement"},
           {"\x1b[2Jv", "mesh-invalid", 5, 1, "\\x1b"},
       }) {
    CAPTURE(std::string(wrong.text));
    const Loaded loaded = load_obj(kSquare + wrong.text + "\nf 1 2 3 4\n");
    REQUIRE(loaded.errors.size() == 1);
    check_message(loaded.errors, wrong.slug, "m.obj", wrong.line, wrong.column, wrong.part);
  }
}

TEST_CASE("a file without faces, or with none that has an area, is no mesh") {
  check_message(load_obj("").errors, "mesh-invalid", "m.obj", 1, 1, "no faces");
  check_message(load_obj(kSquare).errors, "mesh-invalid", "m.obj", 1, 1, "4 vertices");
  check_message(load_obj(kSquare + "f 1 2\n").errors, "mesh-invalid", "m.obj", 5, 1, "area");
}

TEST_CASE("many mistakes in a file are told in one go, but not without end") {
  std::string text;
  for (int k = 0; k < 1000; ++k) text += "v 0 0 x\n";
  const Loaded loaded = load_obj(text);
  CHECK(loaded.errors.size() == 20);
  CHECK(loaded.more == 0);
}

TEST_CASE("materials: by the names of the OBJ file, else the mesh's own, else Kd") {
  const Folder folder;
  testing::write_bytes(folder / "m.mtl", "newmtl oak wood\nKd 0.5 0.4 0.3\nnewmtl steel\nKd 0.25\n");
  testing::write_bytes(folder / "m.obj",
                       "mtllib m.mtl\n" + kSquare + "usemtl oak wood\nf 1 2 3 4\nusemtl steel\nf 4 3 2 1\n");
  const Loaded kd = load_in(folder, "  - {mesh: m.obj}\n");
  REQUIRE(kd.errors.empty());
  CHECK(reflectance_of(kd, 1) == doctest::Approx(0.5));
  CHECK(kd.scene.faces.reflectance[1].b == doctest::Approx(0.3));
  CHECK(reflectance_of(kd, 2) == doctest::Approx(0.25));
  const Loaded own = load_in(folder, "  - {mesh: m.obj, material: white}\n");
  CHECK(reflectance_of(own, 1) == doctest::Approx(0.73));
  CHECK(reflectance_of(own, 2) == doctest::Approx(0.73));
  const Loaded mapped = load_in(folder, "  - {mesh: m.obj, materials: {oak wood: white}}\n");
  REQUIRE(mapped.errors.empty());
  CHECK(reflectance_of(mapped, 1) == doctest::Approx(0.73));
  CHECK(reflectance_of(mapped, 2) == doctest::Approx(0.25));
  const Loaded both = load_in(folder, "  - {mesh: m.obj, material: white, materials: {steel: lamp}}\n");
  REQUIRE(both.errors.empty());
  CHECK(reflectance_of(both, 1) == doctest::Approx(0.73));
  CHECK(both.scene.faces.emission[2].r == 15);
  for (const Loaded* loaded : {&kd, &own, &mapped, &both})
    CHECK(count_slug(loaded->warnings, "unused-material") <= 1);
  const Loaded wrong = load_in(folder, "  - {mesh: m.obj, materials: {steal: white, steel: whte}}\n");
  REQUIRE(wrong.errors.size() == 2);
  check_message(wrong.errors, "unknown-material", folder / "scene.yaml", 7, 31, "did you mean 'steel'?");
  CHECK(wrong.errors[1].message.find("did you mean 'white'?") != std::string::npos);
  const Loaded elsewhere =
      load_in(folder, "  - {quad: {size: [1,1]}, material: white, materials: {a: white}}\n");
  check_message(elsewhere.errors, "unknown-key", folder / "scene.yaml", 7, 55, "'mesh'");
}

TEST_CASE("what an MTL file says beyond reflectance, or wrongly, is told once") {
  const Folder folder;
  testing::write_bytes(
      folder / "m.mtl",
      "newmtl a\nKd 1.5 -1 0.5\nmap_Kd a.png\nd 1\nTr 1\nnewmtl b\nKd 1 1 1\nKe 2 2 2\nnewmtl c\nd 0.5\n");
  testing::write_bytes(folder / "m.obj", "mtllib m.mtl\n" + kSquare +
                                             "usemtl a\nf 1 2 3 4\nusemtl b\nf 1 2 3\nusemtl c\nf 1 3 4\n"
                                             "usemtl d\nf 2 3 4\nusemtl e\nf 4 3 2\n");
  const Loaded loaded =
      load_in(folder,
              "  - {mesh: m.obj}\n  - {mesh: m.obj, translate: [3,0,0]}\n"
              "  - {repeat: {count: 3, step: [0,0,1], of: {mesh: ./m.obj, translate: [6,0,0]}}}\n");
  REQUIRE(loaded.errors.empty());
  CHECK(reflectance_of(loaded, 1) == 1);
  CHECK(loaded.scene.faces.reflectance[1].g == 0);
  CHECK(reflectance_of(loaded, 3) == doctest::Approx(kDefaultReflectance));  // c has no Kd
  CHECK(reflectance_of(loaded, 4) == doctest::Approx(kDefaultReflectance));
  check_message(loaded.warnings, "reflectance-range", "m.mtl", 1, 1, "'a'");
  check_message(loaded.warnings, "reflectance-one", "m.mtl", 6, 1, "'b'");
  check_message(loaded.warnings, "mesh-simplified", "m.mtl", 1, 1,
                "textures of 'a', transparency of 'c', light (Ke) of 'b'");
  check_message(loaded.warnings, "unknown-material", "m.obj", 12, 1, "'d', 'e'");
  for (const char* slug : {"reflectance-range", "reflectance-one", "mesh-simplified", "unknown-material"})
    CHECK(count_slug(loaded.warnings, slug) == 1);
}

TEST_CASE("mistakes in an MTL file are told in it, when it is needed") {
  struct Wrong {
    const char* text;
    const char* slug;
    int column;
  };
  for (const Wrong& wrong : {Wrong{"Kd x 0 0", "mesh-invalid", 4},
                             {"Kd 0.5 0.5", "mesh-invalid", 1},
                             {"Kd nan 0 0", "non-finite", 4},
                             {"Kd spectral a.rfl", "mesh-invalid", 4},
                             {"d", "mesh-invalid", 1}}) {
    CAPTURE(std::string(wrong.text));
    const Folder folder;
    testing::write_bytes(folder / "m.mtl", std::string("newmtl a\n") + wrong.text + "\n");
    testing::write_bytes(folder / "m.obj", "mtllib m.mtl\n" + kSquare + "usemtl a\nf 1 2 3 4\n");
    const Loaded loaded = load_in(folder, "  - {mesh: m.obj}\n  - {mesh: m.obj}\n");
    REQUIRE(loaded.errors.size() == 1);
    check_message(loaded.errors, wrong.slug, "m.mtl", 2, wrong.column, "");
    CHECK(load_in(folder, "  - {mesh: m.obj, material: white}\n").errors.empty());
  }
}

TEST_CASE("MTL files that are not there leave a default reflectance and a warning") {
  const Folder folder;
  fs::create_directories(folder / "parts");
  testing::write_bytes(folder / "parts/a.mtl", "newmtl a\nKd 0.5\n");
  testing::write_bytes(folder / "parts/b c.mtl", "newmtl b\nKd 0.25\n");
  const auto with = [&](const std::string& library) {
    testing::write_bytes(folder / "parts/m.obj",
                         library + kSquare + "usemtl a\nf 1 2 3 4\nusemtl b\nf 4 3 2 1\n");
    return load_in(folder, "  - {mesh: parts/m.obj}\n");
  };
  const Loaded both = with("mtllib a.mtl\nmtllib b c.mtl\n");
  REQUIRE(both.errors.empty());
  CHECK(both.warnings.size() == 1);      // the material white is not used
  CHECK(both.scene.faces.twin[1] == 2);  // two faces back to back
  CHECK(reflectance_of(both, 1) == doctest::Approx(0.5));
  CHECK(reflectance_of(both, 2) == doctest::Approx(0.25));
  const Loaded list = with("mtllib .\\a.mtl nope.mtl\n");
  CHECK(reflectance_of(list, 1) == doctest::Approx(0.5));
  check_message(list.warnings, "include-not-found", "parts/m.obj", 1, 1, "'nope.mtl'");
  CHECK(count_slug(list.warnings, "unknown-material") == 0);
  check_message(with("mtllib /etc/passwd\n").warnings, "include-outside-root", "parts/m.obj", 1, 1,
                "relative");
  check_message(with("mtllib ../../x.mtl\n").warnings, "include-outside-root", "parts/m.obj", 1, 1,
                "outside");
  check_message(with("").warnings, "unknown-material", "parts/m.obj", 5, 1, "'a', 'b'");
  testing::write_bytes(folder / "parts/m.obj", kSquare + "f 1 2 3 4\n");
  const Loaded plain = load_in(folder, "  - {mesh: parts/m.obj}\n");
  check_message(plain.warnings, "unknown-material", "parts/m.obj", 1, 1, "without a material");
  CHECK(reflectance_of(plain, 1) == doctest::Approx(kDefaultReflectance));
}

TEST_CASE("meshes lie in the scene's folder, relative to the file that names them") {
  const Folder folder;
  fs::create_directories(folder / "parts");
  testing::write_bytes(folder / "parts/m.obj", kSquare + "f 1 2 3 4\n");
  testing::write_bytes(folder / "parts/p.yaml",
                       "patchlight: 1\nmaterials: {m: {reflectance: 0.5}}\n"
                       "objects:\n  - {id: chair, mesh: m.obj, material: m}\n");
  const Loaded included = load_in(folder, "", "include: [{file: parts/p.yaml, as: p}]\n");
  REQUIRE(included.errors.empty());
  CHECK(included.scene.polygons.id[0] == "p.chair.0");
  fs::create_directory_symlink("/etc", folder / "link");
  for (const char* name : {"/etc/passwd", "../x.obj", "link/passwd"}) {
    const Loaded loaded = load_in(folder, fmt::format("  - {{mesh: {}, material: white}}\n", name));
    check_message(loaded.errors, "include-outside-root", folder / "scene.yaml", 7, 12, name);
  }
  const std::string place = folder / "scene.yaml";
  check_message(load_in(folder, "  - {mesh: nope.obj, material: white}\n").errors, "cannot-open", place, 7,
                12, "no file 'nope.obj'");
  check_message(load_in(folder, "  - {mesh: 'http://x.org/a.obj', material: white}\n").errors, "cannot-open",
                place, 7, 12, "network");
  check_message(load_in(folder, "  - {mesh: parts, material: white}\n").errors, "not-a-regular-file", place,
                7, 12, "");
  check_message(load_in(folder, "  - {mesh: , material: white}\n").errors, "null-value", place, 7, 12, "");
  check_message(load_in(folder, "  - {mesh: [a.obj], material: white}\n").errors, "expected-text", place, 7,
                12, "");
}

TEST_CASE("transforms, copies, groups and settings work on meshes as on other shapes") {
  const Folder folder;
  testing::write_bytes(folder / "m.obj", kSquare + "f 1 2 3\nf 1 3 4\n");
  const Loaded loaded = load_in(folder,
                                "  - id: row\n    repeat: {count: 3, step: [2,0,0], of: {mesh: m.obj, scale: "
                                "[-1, 1, 1], two_sided: true}}\n"
                                "    material: white\n"
                                "  - {id: g, material: white, translate: [0,0,5], group: [{id: m, mesh: "
                                "m.obj, subdivide: 2, patch_size: 0.25}]}\n");
  REQUIRE(loaded.errors.empty());
  const Scene& scene = loaded.scene;
  REQUIRE(scene.polygons.size() == 1 + 12 + 2);
  CHECK(scene.polygons.id[1] == "row[0].0");
  CHECK(scene.polygons.id[2] == "row[0].0.back");
  CHECK(scene.polygons.id[12] == "row[2].1.back");
  CHECK(scene.polygons.id[13] == "g.m.0");
  CHECK(scene.faces.normal[1].z == 1);  // mirrors keep the lit side lit
  CHECK(scene.faces.twin[1] == 2);
  CHECK(corner_in_file(scene, 13, 0).z == doctest::Approx(5));
  CHECK(scene.faces.level_min[13] == 1);
  CHECK(scene.faces.patch_size[13] * scene.units_per_length == doctest::Approx(0.25));
}

TEST_CASE("copies of a mesh beyond the limit are refused before they are made") {
  const Folder folder;
  testing::write_bytes(folder / "m.obj", kSquare + "f 1 2 3\nf 1 3 4\n");
  const Loaded loaded =
      load_in(folder, "  - {repeat: {count: 600000, step: [2,0,0], of: {mesh: m.obj}}, material: white}\n");
  check_message(loaded.errors, "too-many-polygons", folder / "scene.yaml", 7, 56, "1000000");
}

TEST_CASE("50 k triangles load, each in its place") {
  std::string text;
  constexpr int kSide = 159;
  for (int y = 0; y <= kSide; ++y)
    for (int x = 0; x <= kSide; ++x) text += fmt::format("v {} {:.6f} {}\n", x, 0.01 * ((x * y) % 7), y);
  for (int y = 0; y < kSide; ++y)
    for (int x = 0; x < kSide; ++x) {
      const int a = y * (kSide + 1) + x + 1, b = a + 1, c = a + kSide + 1, d = c + 1;
      text += fmt::format("f {0}/{0}/{0} {1}/{1}/{1} {2}/{2}/{2}\nf {1} {3} {2}\n", a, c, b, d);
    }
  const Loaded loaded = load_obj(text);
  REQUIRE(loaded.errors.empty());
  CHECK(mesh_faces(loaded) == 2 * kSide * kSide);
  for (uint32_t k = 0; k < kSide * kSide; k += 997) {
    const uint32_t x = k % kSide, y = k / kSide;
    const DVec3 first = corner_in_file(loaded.scene, 1 + 2 * k, 0);
    // Half a unit of single precision at the scene's size of 159.
    CHECK(glm::length(first - DVec3(x, 0.01 * ((x * y) % 7), y)) < 1e-5);
  }
  CHECK(mesh_ids(loaded).back() == fmt::format("m.{}", 2 * kSide * kSide - 1));
}

TEST_CASE("a closed mesh whose faces look inward is told, unless a lamp or a camera is in it") {
  const std::string corners = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\n";
  const std::string inward = corners + "f 1 2 3 4\nf 8 7 6 5\nf 5 6 2 1\nf 4 3 7 8\nf 1 4 8 5\nf 6 7 3 2\n";
  const std::string outward = corners + "f 4 3 2 1\nf 5 6 7 8\nf 1 2 6 5\nf 8 7 3 4\nf 5 8 4 1\nf 2 3 7 6\n";
  const auto count = [](const std::string& obj, const std::string& more = ", translate: [3, 0, 0]") {
    const Loaded loaded = load_obj(obj, more);
    CHECK(loaded.errors.empty());
    return count_slug(loaded.warnings, "inside-out");
  };
  CHECK(count(inward) == 1);
  CHECK(count(outward) == 0);
  CHECK(count(inward, ", translate: [3, 0, 0], two_sided: true") == 0);
  // Open, it may be a room; and with the lamp at (0.5, 1, 0.5) in it, it is one.
  CHECK(count(inward.substr(0, inward.size() - 10)) == 0);
  CHECK(count(inward, ", scale: 2, translate: [-0.5, 0, -0.5]") == 0);
}

}  // namespace
}  // namespace patchlight::test
