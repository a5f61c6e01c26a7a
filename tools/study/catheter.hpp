#pragma once
#include "tools/study/method.hpp"

namespace palpate::study {

/// A catheter held at its tail whose tip is pulled aside: particles, integrator, tick; against many more
/// particles in smaller ticks. Walls, sleeve and gravity are left out.
std::unique_ptr<Method> make_catheter(const Scene& scene, int body, bool quick);

}  // namespace palpate::study
