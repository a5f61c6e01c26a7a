#pragma once
#include "common/models/catheter/catheter_body.hpp"
#include "common/models/modal_shell/modal_body.hpp"
#include "tools/stability/case.hpp"

namespace palpate::stability {

/// What happens to a catheter, tick by tick.
class CatheterWatch {
 public:
  void look(const CatheterBody& body);
  /// Failed if a place or a force was not a number or the catheter went more than 10 m away; max_force is that of a
  /// tool [N].
  Result result(double energy_growth) const;

 private:
  double force_ = 0, reach_ = 0;
};

/// A soft tube, 9 mm wide and 40 mm long from z = 0 on, clamped at its far end, and what a catheter does to it.
class Duct {
 public:
  Duct();
  const CatheterWall& wall() const { return *body_; }
  double energy() const { return body_->energy(); }  ///< [J]
  /// The tick of a catheter whose wall it is, then its own.
  void tick(CatheterBody& catheter, std::span<const Eigen::Isometry3d> jaws);

 private:
  std::unique_ptr<ModalBody> body_;
};

}  // namespace palpate::stability
