#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <vector>

#include "common/bus/messages.hpp"
#include "common/models/nonlinear.hpp"
#include "common/scene/scene.hpp"
#include "common/tensors/archive.hpp"
#include "common/tensors/compliance.hpp"

namespace palpate {

/// The visible surface of one body under contacts.
struct DeformedSurface {
  std::vector<Eigen::Vector3f> position;      ///< [m] world, per surface node
  std::vector<Eigen::Vector3f> displacement;  ///< [m]
  std::vector<Eigen::Vector3f> normal;        ///< unit, outward
};

/// Rebuilds the shape of all quasi-static bodies (others stay at rest) from contact information: u = sum over contacts of C f
/// (TVCG99 eq. 9 in compliance form) over the whole visible surface, in single precision, then the quasi
/// non-linear correction per tool (TVCG99 eq. 3-4) and normals.
class Deformer {
 public:
  /// One archive per body, read with ArchivePart::surface.
  Deformer(const Scene& scene, const std::vector<Archive>& archives);

  /// Keeps the newest contacts of each tool of the newest run. Returns false (and keeps nothing) if the sample names a body or
  /// a node that this scene does not have.
  bool take(const ContactState& contacts);
  /// Superposes what was taken last.
  void deform();

  int bodies() const { return static_cast<int>(bodies_.size()); }
  const SurfaceMap& map(int body) const { return bodies_[body].map; }
  const DeformedSurface& surface(int body) const { return bodies_[body].surface; }
  /// The contacts that the surfaces show, by tool.
  const std::map<std::uint32_t, ContactState>& contacts() const { return contacts_; }
  std::uint64_t run() const { return run_; }            ///< 0 before any contact was taken
  std::uint64_t step() const { return step_; }          ///< newest haptic step shown
  std::int64_t sense_ns() const { return sense_ns_; }   ///< its sense time

 private:
  struct DeformableBody {
    SurfaceMap map;
    std::optional<Compliance<float>> compliance;  ///< none: moving tissue, which is not this one's to shape
    std::optional<QuasiNonlinear> nonlinear;
    DeformedSurface surface;
    std::vector<const float*> columns;
    std::vector<float> coefficients;
    std::vector<Eigen::Vector3f> linear;  ///< sum of the linear displacements, for the nodes that are held
    std::vector<Eigen::Vector3f> of_tool;
  };
  void superpose(DeformableBody& body, std::uint32_t index);
  static void add_columns(DeformableBody& body, std::uint32_t index, const ContactState& contacts);

  std::vector<DeformableBody> bodies_;
  std::map<std::uint32_t, ContactState> contacts_;
  std::uint64_t run_ = 0, step_ = 0;
  std::int64_t sense_ns_ = 0;
};

/// Unit direction of one tool's press on one body: the sum of the contacts' normal forces; zero without contact.
Eigen::Vector3d press_direction(const ContactState& contacts, std::uint32_t body);

}  // namespace palpate
