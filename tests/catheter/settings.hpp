#pragma once
#include "common/models/catheter/catheter_body.hpp"

namespace palpate {

/// A soft plastic catheter of 2.5 mm, straight along z with its tip at the origin, free of gravity and
/// damping.
inline CatheterSettings plain_catheter(double length = 0.12, int particles = 41) {
  CatheterSettings s;
  s.shape.tail = {0, 0, -length};
  s.shape.tip = {0, 0, 0};
  s.shape.particles = particles;
  s.shape.damping = 0;
  s.young = 1e7;
  return s;
}

}  // namespace palpate
