#pragma once
#include <Eigen/Geometry>
#include <memory>
#include <span>

#include "common/models/catheter/catheter_body.hpp"
#include "common/models/modal_shell/modal_body.hpp"

namespace palpate {

/// One tick of a catheter and of the duct whose wall it touches, in the order of a haptic step; no tool is at the wall.
/// Returns the time [s] that the catheter's own part took.
double tick_in_duct(CatheterBody& catheter, ModalBody& duct, std::span<const Eigen::Isometry3d> jaws);

/// The soft tube of duct_body(), and what a catheter does to it.
class Duct {
 public:
  Duct();
  const DuctWall& wall() const { return *body_; }
  double energy() const { return body_->energy(); }  ///< [J]
  void tick(CatheterBody& catheter, std::span<const Eigen::Isometry3d> jaws) { tick_in_duct(catheter, *body_, jaws); }

 private:
  std::unique_ptr<ModalBody> body_;
};

}  // namespace palpate
