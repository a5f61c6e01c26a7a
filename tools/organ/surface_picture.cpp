#include "tools/organ/surface_picture.hpp"

#include <Eigen/Geometry>
#include <array>
#include <cmath>

namespace palpate {
namespace {

constexpr int kWidth = 600;  // [pixels]

}  // namespace

Colour part_colour(int part) {
  static const std::array<Colour, 6> kColours{Colour{0.75f, 0.35f, 0.3f},  Colour{0.4f, 0.7f, 0.35f},
                                              Colour{0.45f, 0.55f, 0.85f}, Colour{0.85f, 0.75f, 0.35f},
                                              Colour{0.7f, 0.45f, 0.75f},  Colour{0.4f, 0.75f, 0.75f}};
  return kColours[(part - 1) % kColours.size()];
}

Image surface_picture(const PartSurface& surface, const Eigen::Vector3d& low, const Eigen::Vector3d& high) {
  const Eigen::Vector3d away = Eigen::Vector3d(0.4, 1, 0.5).normalized();
  const Eigen::Vector3d right = away.cross(Eigen::Vector3d::UnitZ()).normalized(), down = away.cross(right);
  const Eigen::Vector3d middle = 0.5 * (low + high), size = high - low;
  const double scale = kWidth / right.cwiseAbs().dot(size);
  const int height = static_cast<int>(scale * down.cwiseAbs().dot(size));
  std::vector<Eigen::Vector3d> seen;
  for (const Eigen::Vector3d& node : surface.mesh.nodes) {
    const Eigen::Vector3d x = node - middle;
    seen.emplace_back(0.5 * kWidth + scale * right.dot(x), 0.5 * height + scale * down.dot(x), scale * away.dot(x));
  }
  Canvas canvas(kWidth, height, Colour::Ones());
  const Eigen::Vector3d light = (right * -0.5 - down * 0.6 - away).normalized();
  for (std::size_t t = 0; t < surface.mesh.triangles.size(); ++t) {
    const auto& [a, b, c] = surface.mesh.triangles[t];
    const auto& x = surface.mesh.nodes;
    const Eigen::Vector3d normal = (x[b] - x[a]).cross(x[c] - x[a]).normalized();
    const auto bright = static_cast<float>(0.3 + 0.8 * std::max(0.0, normal.dot(light)));
    canvas.triangle(seen[a], seen[b], seen[c], bright * part_colour(surface.part[t]));
  }
  return canvas.image();
}

}  // namespace palpate
