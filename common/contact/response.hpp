#pragma once
#include <Eigen/Core>

#include "common/archive/compliance.hpp"
#include "common/geometry/anchor.hpp"

namespace palpate {

/// How the points of a surface give way to forces: all that sets the contacts of one body apart from another's.
class Response {
 public:
  virtual ~Response() = default;

  /// [m/N] displacement of the point `at` per force on the point `under`; the transpose of the reverse.
  virtual Eigen::Matrix3d block(const Anchor& at, const Anchor& under) const = 0;
  /// [m/N] of a typical node under its own force.
  virtual double typical() const = 0;
};

/// That of tissue at rest under its loads, or of a step of its modes: a dense compliance among surface nodes.
class CompliantResponse : public Response {
 public:
  /// `compliance` outlives this object; what moves beside its touchable nodes is rigid.
  explicit CompliantResponse(const Compliance<double>& compliance);

  Eigen::Matrix3d block(const Anchor& at, const Anchor& under) const override;
  double typical() const override { return typical_; }

 private:
  const Compliance<double>& compliance_;
  double typical_;
};

}  // namespace palpate
