#pragma once
#include "common/contact/response.hpp"
#include "common/dynamics/dynamic_model.hpp"
#include "common/dynamics/elastic_mesh.hpp"

namespace palpate {

/// How far a force that lasts for one semi-implicit step moves a point of moving tissue within that step: by dt^2/m of
/// its nodes alone, what is elastic answers later.
class InertialResponse : public Response {
 public:
  /// Both outlive this object.
  InertialResponse(const ElasticMesh& mesh, const DynamicModel& model) : mesh_(mesh), model_(model) {}

  /// For steps of `dt` [s] of the model as it is now.
  void follow(double dt);

  Eigen::Matrix3d block(const Anchor& at, const Anchor& under) const override;
  double typical() const override { return typical_; }

  /// [m/N] of a node, per axis; zero along fixed axes and for nodes that have left.
  Eigen::Vector3d of_node(int node) const { return of_mass(node, model_.mass(node)); }
  /// The same if it had this mass [kg].
  Eigen::Vector3d of_mass(int node, double mass) const;

 private:
  const ElasticMesh& mesh_;
  const DynamicModel& model_;
  double squared_dt_ = 0, typical_ = 1;
};

}  // namespace palpate
