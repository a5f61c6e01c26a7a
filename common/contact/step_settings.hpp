#pragma once
#include <span>

#include "common/contact/spec.hpp"
#include "common/tool/spec.hpp"

namespace palpate {

/// What a body's part in the haptic step needs to know besides the body; the tools are looked at
/// only while the part is made.
struct StepSettings {
  ContactSpec contact;
  std::span<const Tool> tools;
  double dt = 1e-3;  ///< [s] of a step
};

}  // namespace palpate
