#pragma once
#include <memory>
#include <optional>

#include "common/contact/patch/patch_parts.hpp"
#include "common/contact/step_settings.hpp"
#include "common/models/body_shape.hpp"
#include "common/models/quasi_static/column_sum.hpp"
#include "common/models/quasi_static/fine_dents.hpp"
#include "common/models/quasi_static/nonlinear.hpp"

namespace palpate {

/// The shape of a quasi-static body from the contacts: u = sum over contacts of C f (TVCG99 eq. 9 in compliance form)
/// over the whole visible surface, then the quasi non-linear correction per tool (TVCG99 eq. 3-4), and the fine field
/// of the tips that press by patches.
class SuperposedShape : public BodyShape {
 public:
  /// `archive`: read with ArchivePart::surface; it and `settings` are looked at here alone.
  SuperposedShape(const QuasiStaticSpec& body, const Archive& archive, const StepSettings& settings);

  bool superposed() const override { return true; }
  double used_force() const override { return used_force_; }
  std::span<const HertzDent> dents() const override;

 private:
  void displace(const ContactsOnBody& contacts, std::vector<Eigen::Vector3f>& total) override;
  void correct(const ContactsOnBody& contacts, std::vector<Eigen::Vector3f>& total);
  /// One tool's press on the body.
  struct Press {
    QuasiNonlinear law;
    Eigen::Vector3d direction;
    double force;  ///< [N] linear, along it
  };
  Press press_of(const ContactState& tool, std::uint32_t body) const;
  bool by_patch(const ContactState& tool, const HeldContact& contact) const;

  ColumnSum sum_;
  std::optional<BodyNonlinear> nonlinear_;
  std::unique_ptr<FineDents> fine_;  ///< null: no tip presses by a patch
  std::vector<PatchPart> patches_;   ///< parts of tools that press by patches, and hold no node
  std::vector<int> held_;
  std::vector<Eigen::Vector3f> linear_;  ///< sum of the linear displacements, for the nodes that are held
  std::vector<Eigen::Vector3f> of_tool_;
  double used_force_ = 0;
};

/// Unit direction of one tool's press on one body: the sum of the contacts' normal forces; zero without contact.
Eigen::Vector3d press_direction(const ContactState& contacts, std::uint32_t body);

}  // namespace palpate
