// A catheter's texture runs along it from the tip.
#include "common/models/appearance.hpp"

#include <Eigen/Geometry>

#include "common/archive/archive.hpp"
#include "common/geometry/direction.hpp"
#include "common/models/catheter/spec.hpp"

namespace palpate {

Appearance appearance(const CatheterSpec& body, const SurfaceMap& surface) {
  const Catheter& catheter = body.catheter;
  const Eigen::Quaterniond turn = turn_between(catheter.tip - catheter.tail, Eigen::Vector3d::UnitZ());
  Appearance look{.material = Appearance::Material::plastic};
  for (const Eigen::Vector3d& p : surface.position) look.texture.push_back((turn * (p - catheter.tip)).cast<float>());
  return look;
}

}  // namespace palpate
