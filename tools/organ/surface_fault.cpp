#include "tools/organ/surface_fault.hpp"

#include <fmt/format.h>

#include <stdexcept>
#include <unordered_map>
#include <vector>

#include "tools/organ/finding.hpp"

namespace palpate {
namespace {

/// Around a node: from the second corner of each of its triangles to the third.
using Turns = std::unordered_map<int, int>;

[[noreturn]] void refuse_surface(const Eigen::Vector3d& place, const char* what) {
  throw std::runtime_error(
      fmt::format("its triangles do not make a surface: {} at {}; mend it in the program that the surface comes from",
                  what, place_in_mm(place)));
}

std::vector<Turns> turns_of(const TriangleMesh& mesh) {
  std::vector<Turns> turns(mesh.nodes.size());
  for (const auto& t : mesh.triangles)
    for (int c = 0; c < 3; ++c) {
      const int n = t[c], next = t[(c + 1) % 3];
      if (!turns[n].emplace(next, t[(c + 2) % 3]).second)
        refuse_surface(0.5 * (mesh.nodes[n] + mesh.nodes[next]), "more than two meet in an edge");
    }
  return turns;
}

/// Whether one way round comes by all of them.
bool hang_together(const Turns& turns) {
  if (turns.empty()) return true;
  std::size_t passed = 0;
  int at = turns.begin()->first;
  do {
    const auto next = turns.find(at);
    if (next == turns.end()) return false;  // at a rim
    at = next->second;
    ++passed;
  } while (at != turns.begin()->first && passed < turns.size());
  return passed == turns.size();
}

}  // namespace

void check_is_surface(const TriangleMesh& mesh) {
  const std::vector<Turns> turns = turns_of(mesh);
  for (std::size_t n = 0; n < turns.size(); ++n)
    if (!hang_together(turns[n])) refuse_surface(mesh.nodes[n], "parts of it meet in a corner alone");
}

}  // namespace palpate
