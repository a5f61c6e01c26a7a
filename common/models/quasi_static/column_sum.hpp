#pragma once
#include <vector>

#include "common/archive/compliance.hpp"
#include "idl/messages.hpp"

namespace palpate {

/// u = C f over the whole visible surface, force by force, in single precision.
class ColumnSum {
 public:
  /// `archive`: read with ArchivePart::surface.
  explicit ColumnSum(const Archive& archive) : compliance_(archive, Compliance<float>::Rows::surface) {}

  void clear();
  /// A force [N] at a node; one where nothing can move has no effect.
  void add(std::uint32_t node, const Eigen::Vector3f& force);
  /// What one tool does to a body.
  void add(const ContactState& contacts, std::uint32_t body);
  bool empty() const { return columns_.empty(); }
  /// Fills the displacement [m] of every surface node.
  void combine(std::vector<Eigen::Vector3f>& displacement) const;

 private:
  Compliance<float> compliance_;
  std::vector<const float*> columns_;
  std::vector<float> coefficients_;
};

}  // namespace palpate
