#pragma once
#include <cmath>

#include "common/archive/archive.hpp"

namespace palpate::testing {

/// A flat square patch of n x n touchable nodes, h [m] apart, in the plane z = 0 with outward normal +z, and a
/// symmetric positive definite compliance that falls with distance: exp(-r/2h) * (I + 0.2 zz^T) * softness [m/N].
/// No mesh stands behind it: it serves tests of the contact law alone.
inline Archive flat_patch(int n, double h, double softness) {
  Archive a;
  a.body = "patch";
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i) {
      a.surface.position.emplace_back(h * (i - 0.5 * (n - 1)), h * (j - 0.5 * (n - 1)), 0);
      a.surface.node_number.push_back(j * n + i);
      a.surface.fixed.push_back({false, false, false});
    }
  for (int j = 0; j + 1 < n; ++j)
    for (int i = 0; i + 1 < n; ++i) {
      const int v = j * n + i;
      a.surface.triangles.push_back({v, v + 1, v + n + 1});
      a.surface.triangles.push_back({v, v + n + 1, v + n});
    }
  a.surface.touchable = n * n;
  for (int node = 0; node < n * n; ++node)
    for (int axis = 0; axis < 3; ++axis) a.touchable_dofs.push_back({node, axis});
  const int dofs = 3 * n * n;
  a.touchable_compliance.reserve(dofs * (dofs + 1) / 2);
  for (int i = 0; i < dofs; ++i)
    for (int j = 0; j <= i; ++j) {
      const Dof p = a.touchable_dofs[i], q = a.touchable_dofs[j];
      const double r = (a.surface.position[p.node] - a.surface.position[q.node]).norm();
      const double axis = p.axis != q.axis ? 0.0 : p.axis == 2 ? 1.2 : 1.0;
      a.touchable_compliance.push_back(softness * axis * std::exp(-r / (2 * h)));
    }
  return a;
}

}  // namespace palpate::testing
