#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <vector>

#include "idl/messages.hpp"

namespace palpate::testing {

/// What one tool's hand is given, step by step, as the haptic node says it.
class FeltForce {
 public:
  /// A step that came late after the one before it.
  struct Late {
    std::int64_t from_ns, to_ns;  ///< the sense times of the two
    std::int64_t lost_ns;         ///< beyond the loop's period
  };

  void add(const ForceState& force);
  void begin_anew();                                    ///< what is told below is from now on
  void keep_undisturbed() { undisturbed_ = newest(); }  ///< what it is now is what it should be

  bool finite() const { return finite_; }
  double max_force() const { return max_force_; }    ///< [N]
  double max_rise() const { return max_rise_; }      ///< [N] of its size from one step to the next
  double max_change() const { return max_change_; }  ///< [N] of the vector from one step to the next
  /// [N] the farthest that it was from undisturbed(), or from a share of it: what has faded.
  double max_off() const { return max_off_; }
  const Eigen::Vector3d& undisturbed() const { return undisturbed_; }
  Eigen::Vector3d newest() const { return vector(newest_); }  ///< [N]
  const ForceState& state() const { return newest_; }
  const std::optional<ForceState>& first() const { return first_; }
  const std::vector<Late>& late() const { return late_; }

 private:
  static Eigen::Vector3d vector(const ForceState& f) { return {f.force[0], f.force[1], f.force[2]}; }

  ForceState newest_;
  std::optional<ForceState> first_;
  std::vector<Late> late_;
  Eigen::Vector3d undisturbed_ = Eigen::Vector3d::Zero();
  double max_force_ = 0, max_rise_ = 0, max_change_ = 0, max_off_ = 0;
  bool finite_ = true;
};

}  // namespace palpate::testing
