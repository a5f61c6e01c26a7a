#include "tools/study/insertion.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "common/mesh/shell_file.hpp"
#include "common/models/modal_shell/precompute.hpp"
#include "tools/rig/duct.hpp"

namespace palpate::study {
namespace {

constexpr double kHeldAt = 1.5;     // of the way that it is led in, behind the tip
constexpr double kShareLed = 0.15;  // of the catheter's length that is led in
constexpr double kAsideRadii = 4;
constexpr double kSoftness = 1e-4;  // [m/N] of the hold

double smooth(double s) {
  s = std::min(1.0, s);
  return s * s * s * (10 - 15 * s + 6 * s * s);
}

double force_on_wall(const CatheterBody& catheter) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const WallForce& w : catheter.wall_forces()) sum += w.force;
  return sum.norm();
}

}  // namespace

CatheterSettings catheter_settings(const Scene& scene, int catheter, double tick) {
  const auto& of = std::get<CatheterSpec>(scene.bodies[catheter]);
  return {.shape = of.catheter,
          .young = of.material.young,
          .density = of.material.density,
          .step = tick,
          .friction = scene.contact.friction};
}

Insertion::Insertion(const Scene& scene, int catheter) : catheter_(catheter) {
  const Catheter& shape = std::get<CatheterSpec>(scene.bodies[catheter]).catheter;
  const auto name = [](const Body& body) { return name_of(body); };
  duct_ = static_cast<int>(std::ranges::find(scene.bodies, shape.inside, name) - scene.bodies.begin());
  const auto& duct = std::get<ModalShellSpec>(scene.bodies[duct_]);
  archive_ = precompute(duct, load_shell_mesh(duct.mesh, duct.scale));
  feed_ = kShareLed * (shape.tip - shape.tail).norm();
}

std::vector<std::array<double, 2>> Insertion::course(const Scene& scene, double tick, double interval,
                                                     std::vector<double>* times) const {
  ModalBody duct(archive_, std::get<ModalShellSpec>(scene.bodies[duct_]),
                 StepSettings{scene.contact, scene.tools, tick});
  CatheterBody catheter(catheter_settings(scene, catheter_, tick), &duct);
  const Catheter& shape = std::get<CatheterSpec>(scene.bodies[catheter_]).catheter;
  const Eigen::Vector3d along = (shape.tip - shape.tail).normalized(), side = along.unitOrthogonal();
  std::array jaw{Eigen::Isometry3d::Identity()};
  const Eigen::Vector3d held = shape.tip - kHeldAt * feed_ * along;
  jaw[0].translation() = held;
  catheter.grasp(0, jaw[0], catheter.nearest(held), 0, kSoftness);
  std::vector<std::array<double, 2>> path;
  const auto each = std::lround(interval / tick);
  for (long i = 1; static_cast<double>(i) * tick < kSeconds + 1e-9; ++i) {
    const double share = smooth(static_cast<double>(i) * tick / kFeedSeconds);
    jaw[0].translation() = held + share * (feed_ * along + kAsideRadii * shape.radius * side);
    const double seconds = tick_in_duct(catheter, duct, jaw);
    if (times) times->push_back(seconds);
    if (i % each == 0) path.push_back({force_on_wall(catheter), catheter.inserted()});
  }
  return path;
}

}  // namespace palpate::study
