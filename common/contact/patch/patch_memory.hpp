#pragma once
#include <Eigen/Core>
#include <array>
#include <span>
#include <vector>

#include "common/contact/creep.hpp"
#include "common/describe/state.hpp"

namespace palpate {

class PatchGrid;

/// What the past of one patch does under its squares beyond what its forces do as loads on the surface's nodes
/// (displacements by those are known from elsewhere): the part of the dent that the mesh cannot resolve. It belongs to
/// the tissue: as the patch slips over it, it falls behind, and fresh tissue comes in.
class PatchMemory {
 public:
  PatchMemory(const PatchGrid& grid, const CreepStep& step);

  /// [1] By how much softer than the archive's all compliances are that the patch computes with.
  double instant() const { return step_.instant(); }
  /// [m] into the tissue, of square p as the next step finds it without new forces.
  double dent(int p) const { return dent_[p]; }
  /// [m] of the tissue along the surface, likewise.
  Eigen::Vector3d bent() const;

  /// Ends a step. `dent` [m]: what its forces do to each square in elastic tissue beyond the nodes' share; `bent` [m]:
  /// likewise along the surface.
  void follow(std::span<const double> dent, const Eigen::Vector3d& bent);
  /// The patch has moved on over the tissue: by `slip` [m] along its own two axes, while it presses over `width` [m].
  void slip(const Eigen::Vector2d& slip, double width);
  void forget();

  void state(State& s);

 private:
  /// Of one retardation: the displacements [m] that are left for the next step.
  struct Term {
    std::vector<double> dent;  ///< per square
    Eigen::Vector3d bent;
  };
  /// Places of the squares beside each: towards + and - along the two axes; -1: none.
  using Beside = std::array<int, 4>;

  std::span<Term> terms() { return std::span(terms_).first(step_.terms().size()); }
  void shift(std::vector<double>& dent, int direction, double share);
  void sum_up();

  const CreepStep step_;
  double edge_;
  std::vector<Beside> beside_;
  std::array<Term, Relaxation::kMaxTerms> terms_;
  std::vector<double> dent_, shifted_;
};

}  // namespace palpate
