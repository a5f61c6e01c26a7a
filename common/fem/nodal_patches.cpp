#include "common/fem/nodal_patches.hpp"

#include <algorithm>

namespace palpate {

NodalPatches::NodalPatches(std::span<const Eigen::Vector3d> positions, std::span<const std::array<int, 4>> tetrahedra,
                           std::span<const Material> materials, std::span<const std::uint16_t> material_of,
                           std::span<const char> chosen)
    : tetrahedra_(tetrahedra.begin(), tetrahedra.end()) {
  for (const Material& material : materials) lame_.push_back(palpate::lame(material));
  std::vector<std::array<int, 4>> uses;  // node, material, tetrahedron, corner
  for (int t = 0; t < static_cast<int>(tetrahedra.size()); ++t) {
    const auto& [a, b, c, d] = tetrahedra[t];
    gradients_.push_back(tet_gradients({positions[a], positions[b], positions[c], positions[d]}));
    if (!chosen.empty() && !chosen[t]) continue;
    for (int corner = 0; corner < 4; ++corner)
      uses.push_back({tetrahedra[t][corner], material_of.empty() ? 0 : material_of[t], t, corner});
  }
  std::sort(uses.begin(), uses.end());
  patches_of_.assign(tetrahedra.size(), {-1, -1, -1, -1});
  for (const auto& [node, material, t, corner] : uses) {
    if (patches_.empty() || patches_.back().node != node || patches_.back().material != material)
      patches_.push_back({node, material, {}, {}});
    patches_.back().tetrahedra.push_back(t);
    patches_of_[t][corner] = size() - 1;
  }
  for (Patch& patch : patches_) list_nodes(patch);
}

void NodalPatches::list_nodes(Patch& patch) const {
  for (const int t : patch.tetrahedra)
    patch.nodes.insert(patch.nodes.end(), tetrahedra_[t].begin(), tetrahedra_[t].end());
  std::sort(patch.nodes.begin(), patch.nodes.end());
  patch.nodes.erase(std::unique(patch.nodes.begin(), patch.nodes.end()), patch.nodes.end());
}

std::span<const int> NodalPatches::around(int tetrahedron) const {
  const auto& patches = patches_of_[tetrahedron];
  return patches[0] < 0 ? std::span<const int>() : std::span<const int>(patches);
}

double NodalPatches::sum(int patch, std::span<const char> alive, std::span<Tie> ties) const {
  const Patch& p = patches_[patch];
  std::fill(ties.begin(), ties.end(), Tie(Tie::Zero()));
  double volume = 0;
  for (const int t : p.tetrahedra) {
    if (!alive.empty() && !alive[t]) continue;
    const auto& [gradient, whole] = gradients_[t];
    const auto& corners = tetrahedra_[t];
    const auto own = std::find(corners.begin(), corners.end(), p.node) - corners.begin();
    volume += whole / 4;
    for (int j = 0; j < 4; ++j) {
      Tie& tie = ties[std::lower_bound(p.nodes.begin(), p.nodes.end(), corners[j]) - p.nodes.begin()];
      tie.head<3>() += whole / 4 * gradient.row(j).transpose();
      tie[3] += stabilisation(patch) * whole * gradient.row(own).dot(gradient.row(j));
    }
  }
  return volume;
}

Eigen::Matrix3d patch_stress(const Lame& lame, double stabilisation, double volume, const Eigen::Matrix3d& s) {
  return (lame.lambda * s.trace() * Eigen::Matrix3d::Identity() + lame.mu * (s + s.transpose()) - stabilisation * s) /
         volume;
}

}  // namespace palpate
