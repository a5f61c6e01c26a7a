#pragma once
#include <span>
#include <vector>

#include "common/contact/patch/patch.hpp"
#include "common/dynamics/dynamic_model.hpp"
#include "common/models/moving/inertial_response.hpp"

namespace palpate {

/// How the nodes of a body's surface move, as the patches on it meet them: here those of tissue that moves with
/// inertia. A patch's forces count for one step.
class TissueNodes {
 public:
  /// Both outlive this object.
  TissueNodes(DynamicModel& model, const InertialResponse& response) : model_(model), response_(response) {}
  virtual ~TissueNodes() = default;

  /// [m] from rest, with all that acts and all that push() has put in.
  virtual Eigen::Vector3d displacement(int node) const { return model_.displacement(node); }
  /// Adds how these nodes give way to forces in a step, by their places in the list.
  virtual void add_give(std::span<const int> nodes, std::vector<NodeGive>& give) const;

  /// Before a step's forces of a patch are known: its last ones are out.
  virtual void release(int /*patch*/) {}
  /// Its forces have acted within a step of `dt` [s]: where these put the nodes.
  virtual void push(int /*patch*/, std::span<const PatchForce> forces, double dt) { accelerate(forces, dt); }
  /// A state was restored, in which it had these.
  virtual void resume(int /*patch*/, std::span<const PatchForce> /*forces*/) {}

 protected:
  void accelerate(std::span<const PatchForce> forces, double dt);
  void accelerate(int node, const Eigen::Vector3d& moved, double dt);
  const DynamicModel& model() const { return model_; }
  const InertialResponse& response() const { return response_; }

 private:
  DynamicModel& model_;
  const InertialResponse& response_;
};

}  // namespace palpate
