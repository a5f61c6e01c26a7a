#pragma once
#include <Eigen/Core>
#include <algorithm>
#include <functional>
#include <numbers>

#include "tools/rig/press_rig.hpp"

namespace palpate::testing {

/// Work [J] that a tip has put into the tissue so far: the least and the most.
struct WorkOfCycles {
  double least = 0, most = 0;
};

/// Three rounds of a motion of 400 ticks; `tip`: where it has the tip [m], by the angle of the round.
inline WorkOfCycles work_of_cycles(PressRig& rig, Eigen::Vector3d at,
                                   const std::function<Eigen::Vector3d(double turn)>& tip) {
  WorkOfCycles work;
  double sum = 0;
  rig.press(at);
  for (int i = 0; i < 1200; ++i) {
    const Eigen::Vector3d next = tip(2 * std::numbers::pi * (i % 400) / 400), before = rig.force();
    rig.press(next);
    sum += 0.5 * (before + rig.force()).dot(next - at);
    at = next;
    work.least = std::min(work.least, sum);
    work.most = std::max(work.most, sum);
  }
  return work;
}

}  // namespace palpate::testing
