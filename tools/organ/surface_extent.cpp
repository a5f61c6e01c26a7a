#include "tools/organ/surface_extent.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <stdexcept>

#include "tools/organ/finding.hpp"

namespace palpate {

void check_extent(const TriangleMesh& surface) {
  constexpr double kSmallest = 1e-6, kLargest = 1e3;  // [m]
  constexpr double kFarthest = 1000;                  // of its size
  Eigen::AlignedBox3d box;
  for (const auto& t : surface.triangles)
    for (const int n : t) box.extend(surface.nodes[n]);
  const double size = box.sizes().maxCoeff();
  if (!(size >= kSmallest && size <= kLargest))
    throw std::runtime_error(fmt::format(
        "it is {:.3g} m across, and a body has 1 um to 1 km: is --unit right, or a coordinate wrong?", size));
  const Eigen::Vector3d middle = box.center();
  if (middle.norm() > kFarthest * size)
    throw std::runtime_error(fmt::format(
        "it lies at {}, more than {} times its size of {:.3g} mm from the origin, where its shape is lost in rounding: "
        "move it there",
        place_in_mm(middle), kFarthest, 1e3 * size));
}

}  // namespace palpate
