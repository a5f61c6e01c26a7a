#pragma once
#include <vector>

namespace palpate {

/// Material and thickness of a shell, one for a body.
struct ShellMaterial {
  double young = 0;      ///< [Pa]
  double poisson = 0;    ///< [1]
  double density = 0;    ///< [kg/m^3]
  double thickness = 0;  ///< [m]
};

/// Numbers the free degrees of freedom of a shell: six a node, displacements along the world's x, y, z [m], then
/// rotations about them [rad]. Fixed ones are eliminated. All free translations come first, then all free rotations,
/// each by node and axis: so the condensation of the rotations (BHS01 eq. 15) splits the matrices at translations().
class ShellDofs {
 public:
  static constexpr int kFixed = -1, kUnused = -2;

  /// Every dof of the nodes with used[n] free. Fix with fix(), then number().
  explicit ShellDofs(const std::vector<char>& used);
  void fix(int node, int dof);  ///< dof 0..2 translation, 3..5 rotation
  void number();

  int index(int node, int dof) const { return index_[6 * node + dof]; }  ///< free number, kFixed or kUnused
  int nodes() const { return static_cast<int>(index_.size()) / 6; }
  int translations() const { return translations_; }
  int size() const { return static_cast<int>(dof_.size()); }
  int dof(int index) const { return dof_[index]; }  ///< 6 * node + dof of a free number

 private:
  std::vector<int> index_, dof_;
  int translations_ = 0;
};

}  // namespace palpate
