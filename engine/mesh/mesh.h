// The two meshes of a solution, and how they belong together.
#pragma once

#include "engine/mesh/quadtree.h"

namespace patchlight {

struct Mesh {
  PatchTable patches, elements;
  std::vector<uint32_t> element_first;  // CSR: patch -> its elements, patches + 1
  std::vector<uint32_t> element_patch;  // a row an element
  VertexTable patch_vertices;
  VertexTable element_vertices;  // once the mesh is frozen
  LeafIndex patch_index;
  std::vector<float> patch_reach;    // a row a patch, lengths: find_patch_reach()
  std::vector<SplitReason> reasons;  // a row an element
  std::vector<uint32_t> fresh;       // elements that the last round made
  bool frozen = false;               // it is final
};

}  // namespace patchlight
