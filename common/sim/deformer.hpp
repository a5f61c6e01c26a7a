#pragma once
#include <cstdint>
#include <map>
#include <memory>
#include <vector>

#include "common/archive/archive.hpp"
#include "common/models/body_shape.hpp"
#include "common/scene/scene.hpp"

namespace palpate {

/// Rebuilds the shape of the bodies that the haptic node owns, in single precision, from what it says of them:
/// contacts, and the messages that bodies tell beside them. Bodies of moving tissue stay at rest.
class Deformer {
 public:
  /// One archive per body, read with ArchivePart::surface.
  Deformer(const Scene& scene, const std::vector<Archive>& archives);

  /// Keep the newest state of each tool, or body, of the newest run. A run that another has followed does not come
  /// back. False (and nothing kept) if the sample is of such a run, or names a body or a node that this scene does
  /// not have, or has other modes or particles.
  bool take(const ContactState& contacts);
  bool take(const BodyMessage& message);
  /// Something was taken that the surfaces do not show yet.
  bool fresh() const;
  /// Rebuilds the bodies of which something was taken.
  void deform();
  bool changed(int body) const { return bodies_[body].changed; }  ///< by the last deform()

  int bodies() const { return static_cast<int>(bodies_.size()); }
  /// Whether some body follows from messages of this type.
  bool hears(const BodyMessage& message) const;
  const SurfaceMap& map(int body) const { return bodies_[body].shape->map(); }
  const BodyShape& shape(int body) const { return *bodies_[body].shape; }
  const DeformedSurface& surface(int body) const { return bodies_[body].surface; }
  /// The newest contacts, by tool.
  const std::map<std::uint32_t, ContactState>& contacts() const { return contacts_; }
  std::uint64_t run() const { return run_; }           ///< 0 before anything was taken
  std::uint64_t step() const { return step_; }         ///< newest haptic step shown
  std::int64_t sense_ns() const { return sense_ns_; }  ///< its sense time

 private:
  struct DeformableBody {
    std::unique_ptr<BodyShape> shape;
    DeformedSurface surface;
    bool fresh = true, changed = false;
  };
  bool names_what_is_there(const ContactState& contacts) const;
  bool follow(std::uint64_t run, std::int64_t sense_ns);
  void show(std::uint64_t step, std::int64_t sense_ns);

  std::vector<DeformableBody> bodies_;
  std::map<std::uint32_t, ContactState> contacts_;
  std::size_t tools_;  ///< of the scene; contacts of others are refused. One at least
  std::uint64_t run_ = 0, step_ = 0;
  std::int64_t sense_ns_ = 0;
  std::vector<std::uint64_t> past_runs_;
};

}  // namespace palpate
