#pragma once
#include <memory>
#include <set>
#include <string>

#include "common/bus/bus.hpp"

namespace palpate {

/// Looks whether a replay would speak for nodes that live, or move the motors of a driver.
class ReplayGuard {
 public:
  /// `topics`: what will be played. Before there are writers of them.
  ReplayGuard(Bus& bus, const std::set<std::string>& topics);
  /// For a second, in which nodes find one another: of one that is gone nothing comes any more. Throws
  /// std::runtime_error that names who is there, and what to do.
  void look_first();
  /// The same of drivers that come while it plays; returns at once.
  void look() const;

 private:
  Bus& bus_;
  bool speaks_for_nodes_ = false;  ///< plays what haptic or deform nodes alone write
  bool moves_motors_ = false;      ///< plays forces
  int own_drivers_ = 0;            ///< writers of this bus of what drivers write
  std::unique_ptr<Reader<NodeStatus>> nodes_;
  std::unique_ptr<Reader<DeviceState>> drivers_;
};

}  // namespace palpate
