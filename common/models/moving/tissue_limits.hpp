#pragma once
#include <Eigen/Geometry>
#include <cstdint>
#include <span>
#include <vector>

#include "common/archive/archive.hpp"
#include "idl/messages.hpp"

namespace palpate {

/// What the moving bodies of a scene can do to a tool, by what the haptic node itself knows of them. A node held alone
/// is at its stiffest while all others stand still, as its elements say; what is cut only makes it softer.
class TissueLimits {
 public:
  /// `moving`: one entry per body of the scene; `gravity` [m/s^2] likewise. An archive without tetrahedra, as of a body
  /// of which nothing is known here, limits nothing.
  TissueLimits(const std::vector<Archive>& archives, std::span<const std::uint8_t> moving,
               std::span<const Eigen::Vector3d> gravity);

  bool any() const { return any_; }                            ///< some body moves
  double contact_modulus() const { return contact_modulus_; }  ///< [Pa] E / (1 - nu^2), the largest
  double weight() const { return weight_; }                    ///< [N] of all that moves
  /// Whether a part of a tool can have been in a body when the node began, about [m] how deep.
  double reach_at_start(const Eigen::Vector3d& at, double radius) const;

  /// The stiffness [N/m] against a tool that the tissue near it has at most; negative if the model cannot be of this
  /// scene: it names a body that does not move, a node that a body lacks, or tissue far from where the body is. What
  /// stiffness it tells itself does not count: of a node that is held or cut off it may be any.
  double stiffness_of(const LocalContactModel& model) const;
  /// [Pa] E / (1 - nu^2) of the bodies whose surface is in a model of this scene, the largest; infinite where one is
  /// not known.
  double modulus_of(const LocalContactModel& model) const;

 private:
  struct OfBody {
    bool moves = false, known = false;
    std::vector<double> stiffness;   ///< [N/m] per surface node, 0: not among the moving elements
    double most = 0;                 ///< [N/m] of all nodes
    double modulus = 0;              ///< [Pa] E / (1 - nu^2) of its first material, as patches take it
    Eigen::AlignedBox3d rest, near;  ///< at rest, and where its tissue may come to
  };
  const OfBody* of(std::uint32_t body) const;

  std::vector<OfBody> bodies_;
  bool any_ = false;
  double contact_modulus_ = 0, weight_ = 0;
};

}  // namespace palpate
