#include "common/archive/scale_young.hpp"

#include <cmath>

#include "common/archive/compressed_compliance.hpp"

namespace palpate {
namespace {

void multiply(std::vector<double>& values, double factor) {
  for (double& value : values) value *= factor;
}

void stiffen(CondensedTensors& condensed, double factor) {
  condensed.bound *= factor;
  multiply(condensed.stiffness, factor);
  multiply(condensed.sag, 1 / factor);
}

void stiffen(std::vector<PressedPlace>& presses, double factor) {
  for (PressedPlace& place : presses)
    for (PressedPlace::Pair& force : place.force)
      for (double& newtons : force) newtons *= factor;
}

}  // namespace

void scale_young(Archive& archive, double young) {
  const double factor = young / archive.young.at(0);
  if (factor == 1) return;
  multiply(archive.young, factor);
  archive.young[0] = young;
  for (auto* compliance : {&archive.touchable_compliance, &archive.other_compliance, &archive.moving_compliance})
    multiply(*compliance, 1 / factor);
  if (archive.compressed)
    archive.compressed = std::make_shared<CompressedCompliance>(archive.compressed->scaled(1 / factor));
  for (Eigen::Vector3d& u : archive.sag) u /= factor;
  archive.specimen_force_slope *= factor;
  stiffen(archive.presses, factor);
  if (archive.condensed) stiffen(*archive.condensed, factor);
  if (archive.modal) multiply(archive.modal->omega, std::sqrt(factor));
}

}  // namespace palpate
