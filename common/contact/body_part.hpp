#pragma once
#include <Eigen/Geometry>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "common/contact/body_message.hpp"
#include "common/contact/contact_law.hpp"
#include "common/describe/state.hpp"
#include "common/tool/grip.hpp"
#include "common/tool/moving_tool.hpp"
#include "common/tool/spec.hpp"

namespace palpate {

class DuctWall;

/// What the bodies do to one tool in a step. Linear and corrected forces share their direction of press.
struct ToolLoad {
  Eigen::Vector3d press = Eigen::Vector3d::Zero();   ///< unit or zero: common direction of the press on the tissue
  Eigen::Vector3d force = Eigen::Vector3d::Zero();   ///< [N] on the tool, after the non-linear correction
  Eigen::Vector3d torque = Eigen::Vector3d::Zero();  ///< [N m] on the tool about its tip, likewise
  std::uint32_t flags = 0;                           ///< ForceFlag bits

  /// The direction of press is the first body's.
  void add(const ToolLoad& other) {
    if (press.isZero(0)) press = other.press;
    force += other.force;
    torque += other.torque;
    flags |= other.flags;
  }
};

/// The jaws of one forceps as they look for something to hold.
struct OpenJaws {
  int tool;
  const ForcepsShape& shape;
  Eigen::Isometry3d pose;  ///< tip frame, world
  double opening;          ///< [rad]
  double compliance;       ///< [m/N] of the instrument
};

/// What lies between jaws: the opening [rad] at which they touch it, and how far [m] it is from their hinge.
struct BetweenJaws {
  double opening = 0, distance = 0;
};

/// The tools as a step of the bodies sees them.
struct ToolsInStep {
  std::span<const MovingTool> tools;
  std::uint64_t step = 0;  ///< number of the haptic step
};

/// One body's part in the haptic step; what a body does not do is left as it is here. Within a step: jaws work,
/// surfaces are brought up to date, bodies that move by themselves move, then tools touch the surfaces, one body after
/// another. Nothing allocates after construction.
class BodyPart {
 public:
  virtual ~BodyPart() = default;

  /// Once all parts of a scene are made: `find` gives that of another body by its name, null if there is none.
  using FindPart = std::function<BodyPart*(const std::string& body)>;
  virtual void join(const FindPart& /*find*/) {}
  /// The wall that another body may be led into; null if it is none.
  virtual DuctWall* wall() { return nullptr; }

  /// Brings the surface up to date, near the tools at least.
  virtual void update_surface(std::span<const MovingTool>) {}
  /// Moves by itself against walls and tools, and adds what it does to them. False if it is lost.
  virtual bool move(std::span<const MovingTool>, std::span<ToolLoad>) { return true; }
  /// Finds what the tools touch, solves for the contacts' forces and adds them to the loads, one entry per tool.
  virtual LawOutcome touch(const ToolsInStep&, std::span<ToolLoad>) { return {}; }
  /// After the hands' forces are known: the largest of them [N]. `time` [s]: when the step ends.
  virtual void finish(double /*max_force*/, double /*time*/) {}

  /// Depth [m] to which a part of a tool reaches into the rest shape; 0 if it does not touch it.
  virtual double penetration(const Segment&, double /*radius*/) const { return 0; }
  /// Whether all contacts of one tool that a peer kept can be of this body at rest, beside those that it has.
  virtual bool fits(const MovingTool&, std::span<const TouchContact> kept) const { return kept.empty(); }
  /// Takes them up, if they fit.
  virtual void adopt(std::span<const TouchContact>) {}
  /// Comes to rest under what it has taken up, while the tools stand; before the first step, and not in its time.
  virtual void settle(std::span<const MovingTool>) {}

  // Jaws.
  /// Jaws that close hold what is between them as displacement constraints until let_go().
  virtual void pinch(int /*tool*/, const Eigen::Isometry3d& /*pose*/, const ClosingJaws&) {}
  virtual BetweenJaws between(const OpenJaws&) { return {}; }
  /// The jaws take hold of what is between them, until let_go().
  virtual void grasp(const OpenJaws&) {}
  virtual void let_go(int /*tool*/) {}
  virtual double grasp_load(int /*tool*/) const { return 0; }  ///< [N] by which the jaws hold the body
  /// Before a forceps' grip works, and what came of it.
  virtual void before_grip(int /*tool*/) {}
  virtual void after_grip(int /*tool*/, GripEvent) {}

  /// The law of its contacts; null for a body that keeps them to itself.
  virtual const ContactLaw* held() const { return nullptr; }
  /// Visits every contact that others are told of.
  using VisitContact = std::function<void(const TouchContact& contact)>;
  virtual void for_each_contact(const VisitContact&) const {}
  /// Visits the forces [N] on the tissue at its nodes, with the tool that each is of.
  using VisitForce = std::function<void(int tool, int node, const Eigen::Vector3d& force)>;
  virtual void for_each_force(const VisitForce&) const {}
  /// The most that these two visits can come to.
  struct Capacity {
    std::size_t contacts = 0, forces = 0;
  };
  virtual Capacity capacity() const { return {}; }
  /// Whether its shape follows from the contacts' forces alone.
  virtual bool superposed() const { return false; }
  /// The reduced coordinates from which its shape follows; empty where it follows from the contacts, or is told by
  /// others.
  virtual std::span<const double> coordinates() const { return {}; }

  /// What it tells others beside its contacts: messages with room for whatever they will hold.
  virtual std::vector<BodyNews> news() const { return {}; }
  /// Fills one of those messages after a step, all but body, run, seq, step and time. Allocates nothing.
  virtual void tell(BodyMessage&) {}
  /// What a person may want to know of it when the loop begins; empty: nothing.
  virtual std::string introduction() const { return {}; }

  virtual void forget_factor() {}
  /// What it remembers. `tools`: as they are, where it restores.
  virtual void state(State&, std::span<const MovingTool> /*tools*/) {}
};

using BodyParts = std::span<const std::unique_ptr<BodyPart>>;

}  // namespace palpate
