#pragma once
#include "common/models/body_shape.hpp"
#include "common/models/quasi_static/column_sum.hpp"

namespace palpate {

/// The shape of a quasi-static body that relaxes: u = C (f + loads), f the contacts' forces and the loads those that
/// stand for the past.
class RelaxingShape : public ShapeFrom<CreepState> {
 public:
  /// `archive`: read with ArchivePart::surface.
  explicit RelaxingShape(const Archive& archive) : ShapeFrom(archive.surface), sum_(archive) {}

  bool superposed() const override { return true; }

 private:
  bool is_mine(const CreepState& state) const override;
  void displace(const ContactsOnBody& contacts, std::vector<Eigen::Vector3f>& displacement) override;

  ColumnSum sum_;
};

}  // namespace palpate
