#pragma once
#include <algorithm>
#include <cmath>
#include <map>
#include <random>
#include <set>
#include <string>
#include <vector>

#include "common/mesh/cut_mesh.hpp"
#include "common/mesh/generators.hpp"
#include "common/mesh/surface.hpp"

namespace palpate {

/// Meshes of many kinds, by number; interior nodes of blocks are a little off their places.
inline TetMesh cut_case(unsigned kind, std::mt19937& random) {
  const auto size = [&] { return 2 + static_cast<int>(random() % 4); };
  TetMesh mesh;
  switch (kind % 5) {
    case 0:
      return make_block({0, 0, 0}, {0.03, 0.03, 0.03}, {size(), size(), size()});
    case 1:
      return make_graded_block(graded_axis(0, 0.04, size(), 1.4), centred_axis(0, 0.03, 4, 1.3),
                               graded_axis(0, 0.02, size(), 0.7));
    case 2:
      return make_cylinder(0.02, 0.03, 2 + random() % 2, size());
    case 3: {
      mesh = make_block_of_five({0, 0, 0}, {0.04, 0.03, 0.03}, {size() + 1, size(), size()});
      std::uniform_real_distribution<double> off(-0.0005, 0.0005);
      for (auto& x : mesh.nodes) x += Eigen::Vector3d(off(random), off(random), off(random));
      return mesh;
    }
    default:  // nothing but tetrahedra on their own
      std::uniform_real_distribution<double> at(0, 0.05);
      for (int t = 0; t < 20; ++t) {
        const Eigen::Vector3d corner(at(random), at(random), at(random));
        mesh.nodes.push_back(corner);
        for (int axis = 0; axis < 3; ++axis) mesh.nodes.push_back(corner + 0.01 * Eigen::Vector3d::Unit(axis));
        mesh.tetrahedra.push_back({4 * t, 4 * t + 1, 4 * t + 2, 4 * t + 3});
      }
      return mesh;
  }
}

/// The order in which a case is cut to nothing: where the next removal is aimed at.
class Cutter {
 public:
  Cutter(const TetMesh& mesh, unsigned seed) : mesh_(mesh), random_(seed), way_(seed % 3) {
    std::uniform_real_distribution<double> any(-1, 1);
    along_ = Eigen::Vector3d(any(random_), any(random_), any(random_)).normalized();
  }

  /// A living tetrahedron: any one, one at the surface, or the next along a plane that sweeps over the mesh.
  int aim(const CutMesh& cut) {
    if (way_ == 1) return cut.visible()[random_() % cut.visible().size()] / 4;
    if (way_ == 0) {
      int t;
      do t = static_cast<int>(random_() % cut.size());
      while (!cut.alive(t));
      return t;
    }
    int foremost = -1;
    double least = 0;
    for (int t = 0; t < cut.size(); ++t) {
      if (!cut.alive(t)) continue;
      const auto& n = cut.tetrahedron(t);
      const double at = along_.dot(mesh_.nodes[n[0]] + mesh_.nodes[n[1]] + mesh_.nodes[n[2]] + mesh_.nodes[n[3]]);
      if (foremost < 0 || at < least) foremost = t, least = at;
    }
    return foremost;
  }

 private:
  const TetMesh& mesh_;
  std::mt19937 random_;
  unsigned way_;
  Eigen::Vector3d along_;
};

/// The living part as a mesh of its own, with the same nodes; `number` receives the place of each
/// tetrahedron.
inline TetMesh living(const CutMesh& cut, std::vector<int>* number = nullptr) {
  TetMesh mesh;
  mesh.nodes.resize(cut.nodes());
  for (int t = 0; t < cut.size(); ++t) {
    if (!cut.alive(t)) continue;
    mesh.tetrahedra.push_back(cut.tetrahedron(t));
    if (number) number->push_back(t);
  }
  return mesh;
}

}  // namespace palpate
