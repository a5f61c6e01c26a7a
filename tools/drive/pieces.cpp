#include "tools/drive/pieces.hpp"

#include <algorithm>
#include <vector>

namespace palpate::drive {

Pieces pieces_of(const DynamicOrgan& organ) {
  const CutMesh& topology = organ.topology();
  std::vector<int> part_of;
  std::vector<int> size(topology.parts(part_of), 0);
  std::vector<char> hangs(size.size(), 0);
  for (int t = 0; t < topology.size(); ++t) {
    if (part_of[t] < 0) continue;
    ++size[part_of[t]];
    for (const int node : topology.tetrahedron(t)) hangs[part_of[t]] |= organ.is_joined(node);
  }
  std::vector<int> off;
  for (std::size_t part = 0; part < size.size(); ++part)
    if (!hangs[part]) off.push_back(size[part]);
  std::ranges::sort(off, std::greater());
  // The quasi-static part is the piece that has not come off; of a body without one it is the largest.
  const std::size_t whole = organ.condensed_part() ? 0 : 1;
  return {static_cast<int>(off.size() + 1 - whole), off.size() > whole ? off[whole] : 0};
}

}  // namespace palpate::drive
