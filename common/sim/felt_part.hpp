#pragma once
#include <Eigen/Core>
#include <array>
#include <memory>
#include <span>
#include <vector>

#include "common/describe/state.hpp"
#include "common/models/moving/dynamic_organ.hpp"
#include "common/sim/local_stiffness.hpp"
#include "idl/messages.hpp"

namespace palpate {

/// A part of moving tissue as the local contact model tells of it: the surface there, what each of its nodes would
/// resist with, and what tools touch and hold on it.
class FeltPart {
 public:
  virtual ~FeltPart() = default;

  virtual const ContactSurface& surface() const = 0;
  /// Triangles that come within `radius` [m] of a segment, a few others nearby among them; valid until the next call.
  virtual std::span<const int> find(const Segment& axis, double radius) const = 0;
  /// Fills in where a node of the surface is, how it moves, and its static stiffness as far as that is known.
  virtual void fill(int node, LocalNode& out) const = 0;

  virtual std::span<const TouchContact> contacts() const = 0;
  virtual Eigen::Vector3d position(const Anchor& anchor) const = 0;  ///< [m]
  virtual Eigen::Vector3d force(int contact) const = 0;              ///< [N] on the tissue
  /// Works out stiffness() for the contacts as they are.
  virtual void condense() {}
  /// What has been worked out holds no longer: more is known.
  virtual void forget() {}
  virtual Eigen::Matrix3d stiffness(int contact) const = 0;  ///< [N/m] how its force grows as its tool moves

  /// What is remembered from tick to tick.
  virtual void state(State&) {}
};

/// The parts of an organ: what moves with inertia, and the quasi-static part of one that has it. `known`: the answers
/// for this organ. All refer to both, which outlive them.
std::vector<std::unique_ptr<FeltPart>> felt_parts(const DynamicOrgan& organ, const LocalStiffness& known);

}  // namespace palpate
