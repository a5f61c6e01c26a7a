#pragma once
#include "common/archive/archive.hpp"
#include "common/dynamics/spec.hpp"
#include "common/fem/direct.hpp"
#include "common/models/check/check.hpp"
#include "common/models/moving/dynamic_organ.hpp"
#include "common/models/moving_kind.hpp"

namespace palpate {

/// Says in how many steps the tissue goes on in a tick, what a tick takes on this machine, and up to which stiffness it
/// fits; warns where it takes longer than it lasts. Ticks are made and timed: with a ball of the scene's, where there
/// is one, that stands in the tissue where this lies farthest from what holds it.
void say_steps(const MovingSpec& body, DynamicOrgan& organ, const Archive& archive, const CheckSettings& settings,
               CheckReport& report);

/// Says how far the body sinks under its loads and weight, by a static solve of its own elements; nothing without.
void say_sag(const MovingSpec& body, const StaticProblem& problem, CheckReport& report);

/// Says where contact with tissue like this has been tried, or that it has not, and warns of what lies beyond it.
/// `edge` [m]: mean of the surface; `steps`: of the tissue in a tick, under tools.
void say_tried_contact(const MovingSpec& body, const MovingKind& kind, const CheckSettings& settings, double edge,
                       int steps, CheckReport& report);

}  // namespace palpate
