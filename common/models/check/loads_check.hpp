#pragma once
#include <Eigen/Core>

#include "common/models/check/check.hpp"

namespace palpate {

/// What presses and pulls a body all the time, and for one that is solved beforehand how far that moves it, where its
/// archive is there and good.
void say_loads(const MeshedSpec& body, const Eigen::Vector3d& gravity, const CheckSettings& settings,
               CheckReport& report);

/// How far its loads and weight move a body: at the mesh node that goes farthest.
struct Sag {
  double most;  ///< [m]
  int node;
  double diagonal;  ///< [m] of the mesh's box
};
/// Says it, and warns of one that is beyond what linear elasticity is for. `by`: ends the sentence.
void say_sag(const std::string& body, const Sag& sag, std::string_view by, CheckReport& report);

}  // namespace palpate
