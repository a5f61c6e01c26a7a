#include "tools/generate/duct.hpp"

#include <cmath>
#include <numbers>

#include "common/mesh/shell_generators.hpp"

namespace palpate {

Eigen::Vector3d DuctShape::centre(double s) const {
  const double turn = 2 * std::numbers::pi * s;
  return {-length * s, 0, -drop * (s - std::sin(turn) / (2 * std::numbers::pi))};
}

double DuctShape::radius_at(double s) const {
  return radius * (1 + swing * std::sin(3 * std::numbers::pi * s + 0.6));
}

ShellMesh make_duct(const DuctShape& shape) {
  ShellMesh mesh = make_tube([&](double s) { return shape.centre(s); }, [&](double s) { return shape.radius_at(s); },
                             shape.around, shape.along);
  for (auto& x : mesh.nodes)
    for (int axis = 0; axis < 3; ++axis) x[axis] = std::round(x[axis] * 1e7) / 1e7 + 0.0;
  return mesh;
}

}  // namespace palpate
