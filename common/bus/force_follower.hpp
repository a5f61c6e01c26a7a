#pragma once
#include <array>
#include <cstdint>

#include "idl/messages.hpp"

namespace palpate {

/// What a device's motors give, whatever a scene asks for: finite numbers above 0.
struct MotorLimits {
  double max_force = 10;        ///< [N]
  double max_torque = 3;        ///< [N m]
  double max_grip = 1;          ///< [N m] on the handle
  double max_force_rate = 500;  ///< [N/s] at which a force rises or turns; torques in the proportion of the limits
};

/// What motors are to give, on the tool.
struct MotorForce {
  std::array<double, 3> force{};   ///< [N] at its tip, world
  std::array<double, 3> torque{};  ///< [N m] about its tip, world
  std::array<double, 4> along{};   ///< [N m, N m, N, N m] the same along yaw, pitch, depth, roll
  double grip = 0;                 ///< [N m] on the handle, opens the jaws
};

/// The hand's end of the bus: what one tool's motors give of the forces that are told. One haptic loop is followed, the
/// first that is heard, and another one only once that has been silent and the motors are limp. Force and torque shrink
/// together to the limits; they rise and turn no faster than these say, come in within kReturn, and fade where nothing
/// comes. They fall as fast as they are told from step to step: the haptic node bounds that, and knows how the hand
/// moves. Where steps are missing, they fall no faster than they rise.
class ForceFollower {
 public:
  static constexpr double kSilence = 0.02;               ///< [s] without a force, after which it fades
  static constexpr double kFade = 0.02, kReturn = 0.05;  ///< [s] from all to nothing, and back
  static constexpr double kAbsurd = 10;                  ///< times the limits: no force for this device, and refused

  /// Throws std::runtime_error with the limit that is no finite number above 0.
  explicit ForceFollower(std::uint32_t tool, const MotorLimits& limits = {});

  /// True if the motors are to follow it: of this tool, of the loop that is followed, and a force that can be.
  bool hear(const ForceState& told, std::int64_t now_ns);
  /// What the motors give from now on: call it once a tick, after what has come was heard. No allocation.
  const MotorForce& give(std::int64_t now_ns);

  bool limp() const { return share_ == 0; }           ///< without force, since none comes
  std::uint64_t strange() const { return strange_; }  ///< forces of other loops
  std::uint64_t refused() const { return refused_; }  ///< forces that are no numbers, or absurd

 private:
  static constexpr std::uint64_t kMissed = 5;    ///< steps that may be missing
  static constexpr double kLongestTick = 0.002;  ///< [s] a driver that was late catches up by no more

  double size(const MotorForce& f) const;

  std::uint32_t tool_;
  MotorLimits limits_;
  bool follows_ = false;
  std::uint64_t run_ = 0;    ///< of the haptic loop
  std::uint64_t step_ = 0;   ///< told last
  bool catches_up_ = false;  ///< with a force of which steps were missing
  std::int64_t heard_ns_ = 0, given_ns_ = 0;
  double share_ = 0;         ///< that the motors give of what was told last
  MotorForce told_, given_;  ///< within the limits of size
  std::uint64_t strange_ = 0, refused_ = 0;
};

}  // namespace palpate
