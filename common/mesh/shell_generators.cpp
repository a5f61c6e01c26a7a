#include "common/mesh/shell_generators.hpp"

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>
#include <stdexcept>

namespace palpate {
namespace {

void add_cells(ShellMesh& mesh, int around, int along) {
  for (int i = 0; i < along; ++i)
    for (int j = 0; j < around; ++j) {
      const int a = i * around + j, b = i * around + (j + 1) % around, c = a + around, d = b + around;
      if ((i + j) % 2 == 0) {
        mesh.triangles.push_back({a, b, d});
        mesh.triangles.push_back({a, d, c});
      } else {
        mesh.triangles.push_back({a, b, c});
        mesh.triangles.push_back({b, d, c});
      }
    }
}

}  // namespace

ShellMesh make_tube(const std::function<Eigen::Vector3d(double)>& centre, const std::function<double(double)>& radius,
                    int around, int along) {
  if (around < 3 || along < 1) throw std::runtime_error("a tube needs three nodes around and one cell along at least");
  ShellMesh mesh;
  Eigen::Vector3d x = Eigen::Vector3d::UnitX();  // towards node 0 of a ring
  for (int i = 0; i <= along; ++i) {
    const double s = static_cast<double>(i) / along, step = 1e-4;
    const double before = std::max(0.0, s - step), behind = std::min(1.0, s + step);
    const Eigen::Vector3d z = (centre(behind) - centre(before)).normalized();
    if (i == 0 && std::abs(z.x()) > 0.9) x = Eigen::Vector3d::UnitY();
    x = (x - z * z.dot(x)).normalized();
    const Eigen::Vector3d y = z.cross(x);
    const double r = radius(s);
    if (!(r > 0)) throw std::runtime_error("a tube's radius must be positive");
    for (int j = 0; j < around; ++j) {
      const double angle = 2 * std::numbers::pi * j / around;
      mesh.nodes.push_back(centre(s) + r * (std::cos(angle) * x + std::sin(angle) * y));
      if (i == 0) mesh.groups["end0"].nodes.push_back(j);
      if (i == along) mesh.groups["end1"].nodes.push_back(i * around + j);
    }
  }
  add_cells(mesh, around, along);
  return mesh;
}

ShellMesh make_tube(double radius, double length, int around, int along) {
  return make_tube([&](double s) { return Eigen::Vector3d(0, 0, s * length); }, [&](double) { return radius; }, around,
                   along);
}

}  // namespace palpate
