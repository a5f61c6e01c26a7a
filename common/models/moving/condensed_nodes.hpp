#pragma once
#include <vector>

#include "common/dynamics/condensed_part.hpp"
#include "common/models/moving/tissue_nodes.hpp"

namespace palpate {

/// Those of a hybrid body: nodes of its quasi-static part give way at once by its compliance, and draw the connection
/// nodes along, which give way by their mass.
class CondensedNodes final : public TissueNodes {
 public:
  /// For so many patches. All else outlives this object.
  CondensedNodes(DynamicModel& model, const InertialResponse& response, CondensedPart& part, int patches);

  Eigen::Vector3d displacement(int node) const override;
  void add_give(std::span<const int> nodes, std::vector<NodeGive>& give) const override;
  void release(int patch) override;
  void push(int patch, std::span<const PatchForce> forces, double dt) override;
  void resume(int patch, std::span<const PatchForce> forces) override;

 private:
  Eigen::Vector3d inertia(int connection) const;

  CondensedPart& part_;
  mutable std::vector<double> inertia_;  ///< [m/N] per connection dof
  std::vector<double> drawn_;            ///< [N] per connection dof
};

}  // namespace palpate
