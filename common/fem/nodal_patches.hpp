#pragma once
#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "common/fem/elasticity.hpp"

namespace palpate {

/// Linear tetrahedra whose displacement gradient is averaged at their nodes (C. R. Dohrmann et al., Int. J. Numer.
/// Meth. Engng 47, 2000), stabilised by a share of what the mean leaves out (M. A. Puso and J. Solberg, Int. J. Numer.
/// Meth. Engng 67, 2006). A patch is what a node and one material have in common: a quarter of each tetrahedron of that
/// material around it, of volume V in all. With F_e the gradient of tetrahedron e, F its mean over the patch and
/// c = kShare mu, the energy is the sum over the patches of
///   V (lambda/2 (tr F)^2 + mu |sym F|^2) + c/2 sum_e V_e/4 |F_e - F|^2.
/// The second part is zero for every linear field, turns included, and sees no lambda: nothing locks as nu nears 1/2.
/// Strain may jump where materials meet.
///
/// It is summed as V F = sum_j u_j G_j^T with G_j = sum_e V_e/4 grad N_j, and
///   c/2 sum_e V_e |F_e|^2 = -1/2 sum over pairs of w_ij |u_i - u_j|^2,  w_ij = c sum_e V_e grad N_i . grad N_j.
class NodalPatches {
 public:
  /// [1] by measurement (docs/verification.md): less is too soft in bending, more too stiff.
  static constexpr double kShare = 0.25;

  /// What the patch's own node has in common with another of its nodes: G_j [m^2], then w_ij [N/m].
  using Tie = Eigen::Vector4d;

  /// `material_of` per tetrahedron; empty: all have materials[0]. `chosen`: which tetrahedra count; empty: all.
  NodalPatches(std::span<const Eigen::Vector3d> positions, std::span<const std::array<int, 4>> tetrahedra,
               std::span<const Material> materials, std::span<const std::uint16_t> material_of,
               std::span<const char> chosen = {});

  int size() const { return static_cast<int>(patches_.size()); }
  int node(int patch) const { return patches_[patch].node; }
  const Lame& lame(int patch) const { return lame_[patches_[patch].material]; }
  double stabilisation(int patch) const { return kShare * lame(patch).mu; }  ///< c [Pa]
  /// The patch's nodes, its own among them; ascending.
  std::span<const int> nodes(int patch) const { return patches_[patch].nodes; }
  /// The patches of a tetrahedron's corners; none of one that does not count.
  std::span<const int> around(int tetrahedron) const;

  /// Sums over the patch's tetrahedra that are alive (empty: all), in one fixed order: the ties to nodes(patch) go to
  /// `ties`; returns V [m^3].
  double sum(int patch, std::span<const char> alive, std::span<Tie> ties) const;

 private:
  struct Patch {
    int node, material;
    std::vector<int> tetrahedra, nodes;
  };
  void list_nodes(Patch& patch) const;

  std::vector<std::array<int, 4>> tetrahedra_;
  std::vector<TetGradients> gradients_;
  std::vector<Lame> lame_;                      // per material
  std::vector<Patch> patches_;                  // by node, then by material
  std::vector<std::array<int, 4>> patches_of_;  // per tetrahedron; -1 where it does not count
};

/// What the means of a patch exert, less the share that its stabilisation gives back [Pa]: for s = V F [m^3],
/// (lambda tr(s) I + mu (s + s^T) - c s) / V. On node i it acts with the force -stress G_i [N].
Eigen::Matrix3d patch_stress(const Lame& lame, double stabilisation, double volume, const Eigen::Matrix3d& s);

}  // namespace palpate
