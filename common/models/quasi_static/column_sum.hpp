#pragma once
#include <vector>

#include "common/archive/load_sum.hpp"
#include "idl/messages.hpp"

namespace palpate {

/// u = C f over the whole visible surface, force by force, in single precision.
class ColumnSum {
 public:
  /// `archive`: read with ArchivePart::surface.
  explicit ColumnSum(const Archive& archive)
      : compliance_(archive, Compliance<float>::Rows::surface), sum_(compliance_) {}
  ColumnSum(const ColumnSum&) = delete;
  ColumnSum& operator=(const ColumnSum&) = delete;

  void clear() { sum_.clear(); }
  /// A force [N] at a node; one where nothing can move has no effect.
  void add(std::uint32_t node, const Eigen::Vector3f& force) { sum_.add(static_cast<int>(node), force); }
  /// What one tool does to a body.
  void add(const ContactState& contacts, std::uint32_t body);
  bool empty() const { return sum_.empty(); }
  /// Fills the displacement [m] of every surface node.
  void combine(std::vector<Eigen::Vector3f>& displacement);

 private:
  const Compliance<float> compliance_;
  LoadSum<float> sum_;
};

}  // namespace palpate
