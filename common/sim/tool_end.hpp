#pragma once
#include <memory>
#include <span>
#include <vector>

#include "common/contact/body_part.hpp"
#include "common/tool/kinematics.hpp"

namespace palpate {

/// What is at the end of an instrument: its parts for collision, as they are and as they were a step before, and jaws
/// that hold what is between them.
class ToolEnd {
 public:
  virtual ~ToolEnd() = default;

  /// The jaws stand as the handle wants them [rad].
  virtual void start(double /*grip*/) {}
  /// The jaws follow the handle. `pose`: tip frame at the step's begin, as the bodies stand.
  virtual void work(double /*grip*/, const Eigen::Isometry3d& /*pose*/, BodyParts) {}

  virtual bool holding() const { return false; }      ///< the jaws are shut on what is between them
  virtual double opening() const { return 0; }        ///< [rad] between the jaws of a forceps
  virtual double handle() const { return 0; }         ///< [rad] where the handle stands
  virtual double torque() const { return 0; }         ///< [N m] on the handle, opens the jaws
  virtual const char* part_name(int part) const = 0;  ///< as a person calls it
  virtual void state(State&) {}

  std::span<const ToolPart> parts() const { return parts_; }
  std::span<const ToolPart> parts_before() const { return parts_before_; }

 protected:
  explicit ToolEnd(std::vector<ToolPart> parts) : parts_(std::move(parts)), parts_before_(parts_) {}

  std::vector<ToolPart> parts_, parts_before_;
};

/// The tool at whose end it is.
struct EndPlace {
  int index;  ///< of the tool
  const Tool& tool;
  double dt;  ///< [s] of a step
};

}  // namespace palpate
