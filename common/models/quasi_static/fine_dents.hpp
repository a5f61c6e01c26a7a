#pragma once
#include <memory>
#include <span>
#include <vector>

#include "common/archive/archive.hpp"
#include "common/contact/patch/hertz_dent.hpp"
#include "common/contact/patch/near_field.hpp"
#include "common/contact/patch/patch_parts.hpp"
#include "common/models/body_shape.hpp"

namespace palpate {

/// What the mesh is too coarse to show of the dents under tips that press by patches: near each, nodes get
///   G p + (K - C) f
/// beyond C f, as the patch itself does: G is the half-space's kernel (HertzDent), p the tip's pressures, f their
/// forces on the nodes and K what the body has beyond the half-space (NearField). So what is seen is what is felt. p is
/// Hertz's of the contact's force, K being even under a tip.
class FineDents {
 public:
  /// `map`: the archive's, outlives this object; the others are looked at here alone. `resolved`: see NearField.
  FineDents(const SurfaceMap& map, const Archive& archive, const HalfSpace& half_space, std::span<const Tool> tools,
            double resolved);

  /// Finds the dents of the contacts as they are.
  void follow(const ContactsOnBody& contacts);
  std::span<const HertzDent> dents() const { return dents_; }
  /// Adds to each touchable node's displacement [m]; nothing along an axis that is fixed.
  void add(std::vector<Eigen::Vector3f>& displacement) const;

 private:
  struct NodeForce {
    int node;
    Eigen::Vector3d force;  ///< [N]
  };
  void add_dent(const ContactState& state, const HeldContact& contact);
  std::vector<NodeForce> on_nodes(const HertzDent& dent) const;

  const SurfaceMap& map_;
  SmoothSurface surface_;
  HalfSpace half_space_;
  std::vector<PatchPart> tips_;
  std::unique_ptr<NearField> near_field_;  ///< K - C
  double edge_, widest_;                   ///< [m] mean edge; as widest_patch()
  std::vector<HertzDent> dents_;
};

}  // namespace palpate
