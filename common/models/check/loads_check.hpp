#pragma once
#include <Eigen/Core>

#include "common/models/check/check.hpp"

namespace palpate {

/// What presses and pulls a body all the time, and for one that is solved beforehand how far that moves it, where its
/// archive is there and good.
void say_loads(const MeshedSpec& body, const Eigen::Vector3d& gravity, const CheckSettings& settings,
               CheckReport& report);

}  // namespace palpate
