#pragma once
#include <vector>

#include "common/contact/patch/patch.hpp"

namespace palpate {

/// How the patches on one moving body lie in each other's dents, which the nodes' own motion does not show. What the
/// others' dents and their forces' K - C (TissuePatches) do, a patch knows as they are pressed in the same step, since
/// known a step late they would feed the tissue's swing; but by no more than a small part of what the patches give way
/// by: they would answer one another's change with a larger one.
class NeighbourPatches {
 public:
  /// Outlives this object, as the patches and their nodes do.
  void use(const NearField& near_field) { near_field_ = &near_field; }
  /// Numbers go up from 0. `nodes`: those under it.
  void add(Patch& patch, const std::vector<int>& nodes);

  /// Before a step of this patch: lays it in what the others press in.
  void meet(int number);
  /// [m] What the others do to each node under it beyond C, seen from rest.
  const std::vector<Eigen::Vector3d>& beside(int number) const { return all_[number].beside; }
  void lift(int number) { all_[number].sunk = 0; }
  void state(int number, State& s) { s.value(all_[number].sunk); }

 private:
  struct One {
    Patch& patch;
    const std::vector<int>& nodes;
    double sunk = 0;                      ///< [1] by all others, of what it gives way by, were it by all of it
    std::vector<Eigen::Vector3d> beside;  ///< [m] per node
    Patch::OfCells dents{};               ///< [m] this one's, in the patch that is looked at
    std::vector<Eigen::Vector3d> moved;   ///< [m] likewise, of that one's nodes
  };

  static bool meets(const One& own, const One& other);
  double find_met(const One& own, One& other) const;

  const NearField* near_field_ = nullptr;
  std::vector<One> all_;
};

}  // namespace palpate
