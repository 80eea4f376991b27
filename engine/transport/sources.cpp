// Elements and what they send to nodes of their trees.
#include "engine/transport/sources.h"

#include "engine/base/parallel.h"
#include "engine/mesh/cell.h"

#include <algorithm>
#include <queue>

namespace patchlight {
namespace {

// Only places that send more than this many times the scene's mean are aimed at: elsewhere rows do as well,
// and where all send alike they are exact.
constexpr double kBrightOverMean = 3;

}  // namespace

SourceTable make_sources(const PatchTable& elements, const Surfaces& surfaces, std::span<const Rgb> sent,
                         uint32_t count) {
  const FaceTable& faces = surfaces.faces;
  const FaceFrameTable& frames = surfaces.frames;
  std::vector<double> flux_before(elements.size() + 1, 0), square_before(elements.size() + 1, 0);
  double area = 0;
  for (size_t row = 0; row < elements.size(); ++row) {
    const double exposed_area = double{elements.area[row]} * elements.exposed[row];
    const double flux = exposed_area * luminance(sent[row]);
    flux_before[row + 1] = flux_before[row] + flux;
    square_before[row + 1] = square_before[row] + flux * luminance(sent[row]);
    if (largest(faces.reflectance[elements.face[row]]) > 0) area += exposed_area;
  }
  SourceTable sources;
  if (flux_before.back() <= 0 || area <= 0) return sources;
  struct Node {
    double flux;
    uint32_t face, cell, level, first, last;
    bool operator<(const Node& other) const {
      return flux != other.flux   ? flux < other.flux
             : face != other.face ? face > other.face
                                  : cell > other.cell;
    }
  };
  const auto make_node = [&](uint32_t face, uint32_t cell, uint32_t level, uint32_t first, uint32_t last) {
    return Node{flux_before[last] - flux_before[first], face, cell, level, first, last};
  };
  std::priority_queue<Node> queue;
  for (uint32_t f = 0; f < faces.size(); ++f)
    if (const Node root = make_node(f, 0, 0, elements.face_first[f], elements.face_first[f + 1]);
        root.flux > 0)
      queue.push(root);
  const size_t roots = queue.size();
  std::vector<Node> leaves;
  while (!queue.empty() && queue.size() + leaves.size() < roots + count) {
    const Node node = queue.top();
    queue.pop();
    if (node.last - node.first == 1) {
      leaves.push_back(node);
      continue;
    }
    uint32_t first = node.first;
    for (uint32_t child = 0; child < 4; ++child) {
      const uint32_t cell = node.cell | child << (30 - 2 * node.level);
      const uint64_t end_cell = cell + cell_span(node.level + 1);
      const auto end = std::lower_bound(elements.cell.begin() + first, elements.cell.begin() + node.last,
                                        end_cell, [](uint32_t a, uint64_t b) { return a < b; });
      const auto last = static_cast<uint32_t>(end - elements.cell.begin());
      if (const Node part = make_node(node.face, cell, node.level + 1, first, last); part.flux > 0)
        queue.push(part);
      first = last;
    }
  }
  // Of thousands of lit faces the strongest are kept; the rest is left to rows.
  for (; !queue.empty() && leaves.size() < 2 * count; queue.pop()) leaves.push_back(queue.top());
  std::sort(leaves.begin(), leaves.end(), [](const Node& a, const Node& b) {
    return a.face != b.face ? a.face < b.face : a.cell < b.cell;
  });
  const double bright = kBrightOverMean * flux_before.back() / area;
  for (const Node& node : leaves) {
    // As bright as its light sees it: a thin bright strip makes a large dark node worth aiming at.
    if (square_before[node.last] - square_before[node.first] <= bright * node.flux) continue;
    sources.face.push_back(node.face);
    sources.cell.push_back(node.cell);
    sources.level.push_back(static_cast<uint8_t>(node.level));
    sources.element_first.push_back(node.first);
    sources.element_last.push_back(node.last);
    sources.centre.push_back(cell_centre(frames, node.face, node.cell, node.level));
    sources.normal.push_back(faces.normal[node.face]);
    sources.area.push_back(cell_area(frames, node.face, node.cell, node.level));
    sources.flux.push_back(node.flux);
  }
  for (size_t s = 0; s < sources.size(); ++s) {
    const Vec3 centre = sources.centre[s], normal = sources.normal[s];
    sources.x.push_back(centre.x), sources.y.push_back(centre.y), sources.z.push_back(centre.z);
    sources.normal_x.push_back(normal.x), sources.normal_y.push_back(normal.y);
    sources.normal_z.push_back(normal.z);
    sources.share.push_back(static_cast<float>(sources.flux[s] / flux_before.back()));
  }
  sources.guide.resize(elements.size());
  for_rows(sources.size(), 8, [&](size_t begin, size_t end) {
    for (size_t s = begin; s < end; ++s) {
      const uint32_t first = sources.element_first[s], last = sources.element_last[s];
      const double step = (flux_before[last] - flux_before[first]) / (last - first);
      uint32_t element = first;
      for (uint32_t k = 0; k < last - first; ++k) {
        while (element + 1 < last && flux_before[element + 1] <= flux_before[first] + k * step) ++element;
        sources.guide[first + k] = element;
      }
    }
  });
  sources.flux_before = std::move(flux_before);
  return sources;
}

}  // namespace patchlight
