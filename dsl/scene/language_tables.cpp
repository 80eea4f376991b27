// All tables of keys: those of the language, of shapes and of cameras.
#include "dsl/scene/language_tables.h"

#include "dsl/scene/cameras.h"
#include "dsl/shapes/object_keys.h"
#include "dsl/shapes/shapes.h"

#include <vector>

namespace patchlight {
namespace {

std::vector<const KeyTable*> join_tables() {
  std::vector<const KeyTable*> tables = {&kSceneKeys,    &kIncludeKeys,   &kMaterialKeys,
                                         &object_keys(), &kTransformKeys, &kRotateKeys};
  for (const ShapeRow& shape : shape_rows())
    if (shape.keys) tables.push_back(shape.keys);
  for (const ShapeRow& shape : shape_rows())
    for (const KeyTable& table : shape.inner) tables.push_back(&table);
  for (const KeyTable* table :
       {&kSkyKeys, &kSunKeys, &kSunDirectionKeys, &camera_keys(), &kSolverKeys, &kOutputKeys, &kExpectKeys})
    tables.push_back(table);
  return tables;
}

}  // namespace

std::span<const KeyTable* const> language_tables() {
  static const std::vector<const KeyTable*> tables = join_tables();
  return tables;
}

}  // namespace patchlight
