#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <vector>

#include "common/archive/archive.hpp"
#include "common/archive/compliance.hpp"
#include "common/mesh/tube.hpp"
#include "common/models/modal_shell/modal_shape.hpp"
#include "common/models/quasi_static/nonlinear.hpp"
#include "common/scene/scene.hpp"
#include "idl/messages.hpp"

namespace palpate {

/// The visible surface of one body as it is now.
struct DeformedSurface {
  std::vector<Eigen::Vector3f> position;      ///< [m] world, per surface node
  std::vector<Eigen::Vector3f> displacement;  ///< [m]; of a catheter, from its rest shape
  std::vector<Eigen::Vector3f> normal;        ///< unit, outward
};

/// Rebuilds the shape of the bodies that the haptic node owns, in single precision, from what it says of them:
/// - quasi-static ones from contacts: u = sum over contacts of C f (TVCG99 eq. 9 in compliance form) over the whole
/// visible
///   surface, then the quasi non-linear correction per tool (TVCG99 eq. 3-4);
/// - modal shells from their modal coordinates and forces;
/// - catheters, as smooth tubes, from their particles.
/// Bodies of moving tissue stay at rest.
class Deformer {
 public:
  /// One archive per body, read with ArchivePart::surface.
  Deformer(const Scene& scene, const std::vector<Archive>& archives);

  /// Keep the newest state of each tool, or body, of the newest run. A run that another has followed does not come
  /// back. False (and nothing kept) if the sample is of such a run, or names a body or a node that this scene does
  /// not have, or has other modes or particles.
  bool take(const ContactState& contacts);
  bool take(const ModalState& state);
  bool take(const CatheterState& state);
  /// Something was taken that the surfaces do not show yet.
  bool fresh() const;
  /// Rebuilds the bodies of which something was taken.
  void deform();
  bool changed(int body) const { return bodies_[body].changed; }  ///< by the last deform()

  int bodies() const { return static_cast<int>(bodies_.size()); }
  bool has_modal_shells() const;
  bool has_catheters() const;
  const SurfaceMap& map(int body) const { return bodies_[body].map; }
  const DeformedSurface& surface(int body) const { return bodies_[body].surface; }
  /// The newest contacts, by tool.
  const std::map<std::uint32_t, ContactState>& contacts() const { return contacts_; }
  std::uint64_t run() const { return run_; }           ///< 0 before anything was taken
  std::uint64_t step() const { return step_; }         ///< newest haptic step shown
  std::int64_t sense_ns() const { return sense_ns_; }  ///< its sense time

 private:
  struct DeformableBody {
    SurfaceMap map;
    // At most one of these; none for moving tissue, which is not this one's to shape.
    std::optional<Compliance<float>> compliance;
    std::optional<ModalShape> modal;
    std::optional<TubeSurface> tube;
    std::optional<QuasiNonlinear> nonlinear;
    std::optional<ModalState> modes;         ///< newest; none: at rest
    std::vector<Eigen::Vector3d> particles;  ///< [m] newest; empty: at rest
    bool fresh = true, changed = false;
    DeformedSurface surface;
    std::vector<const float*> columns;
    std::vector<float> coefficients;
    std::vector<Eigen::Vector3f> linear;  ///< sum of the linear displacements, for the nodes that are held
    std::vector<Eigen::Vector3f> of_tool;
  };
  bool follow(std::uint64_t run, std::int64_t sense_ns);
  void show(std::uint64_t step, std::int64_t sense_ns);
  void superpose(DeformableBody& body, std::uint32_t index);
  static void add_columns(DeformableBody& body, std::uint32_t index, const ContactState& contacts);
  void rebuild(DeformableBody& body, std::uint32_t index);

  std::vector<DeformableBody> bodies_;
  std::map<std::uint32_t, ContactState> contacts_;
  std::uint64_t run_ = 0, step_ = 0;
  std::int64_t sense_ns_ = 0;
  std::vector<std::uint64_t> past_runs_;
};

/// Unit direction of one tool's press on one body: the sum of the contacts' normal forces; zero without contact.
Eigen::Vector3d press_direction(const ContactState& contacts, std::uint32_t body);

}  // namespace palpate
