#pragma once
#include <functional>
#include <string_view>

#include "common/dynamics/make_model.hpp"
#include "common/dynamics/spec.hpp"
#include "common/models/solid/check.hpp"

namespace palpate {

/// What tells one kind of moving tissue from another in a check.
struct MovingKind {
  std::string_view name;
  MakeDynamicModel make_model;
  std::function<Archive()> precompute;  ///< where no good archive is on disk
  bool own_mesh = false;                ///< what moves has a mesh beside the body's
};

/// Says what moving tissue consists of, its model, step, tearing and connection; the deformation node's parts are built
/// and measured. Throws std::runtime_error if the scene gives a step that is not stable.
void check_moving(const MovingSpec& body, const MovingKind& kind, const CheckSettings& settings, CheckReport& report);

}  // namespace palpate
