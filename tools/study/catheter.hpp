#pragma once
#include "tools/study/method.hpp"

namespace palpate::study {

/// A catheter: particles, integrator, tick; against many more particles in smaller ticks. It is held at its tail while
/// its tip is pulled aside, without walls, sleeve and gravity; and with a duct it is also led into that.
std::unique_ptr<Method> make_catheter(const Scene& scene, int body, bool quick);

}  // namespace palpate::study
