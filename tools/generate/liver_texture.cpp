#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>

#include "render_node/image.hpp"
#include "tools/generate/liver.hpp"
#include "tools/generate/liver_visual.hpp"

namespace palpate {
namespace {

using Eigen::Vector3d;

constexpr int kPixelsAround = 512, kPixelsDown = 256;

double at_lattice(int x, int y, int z) {
  std::uint32_t h = static_cast<std::uint32_t>(x) * 0x9e3779b1u ^ static_cast<std::uint32_t>(y) * 0x85ebca77u ^
                    static_cast<std::uint32_t>(z) * 0xc2b2ae3du;
  h = (h ^ (h >> 15)) * 0x7feb352du;
  return (h >> 9) / 8388608.0;
}

/// Smooth noise in [0, 1).
double noise(const Vector3d& p) {
  const Vector3d cell = p.array().floor(), f = p - cell;
  double sum = 0;
  for (int corner = 0; corner < 8; ++corner) {
    double weight = 1;
    std::array<int, 3> at;
    for (int axis = 0; axis < 3; ++axis) {
      const int up = corner >> axis & 1;
      const double smooth = f[axis] * f[axis] * (3 - 2 * f[axis]);
      weight *= up ? smooth : 1 - smooth;
      at[axis] = static_cast<int>(cell[axis]) + up;
    }
    sum += weight * at_lattice(at[0], at[1], at[2]);
  }
  return sum;
}

/// The farthest point of the liver that lies in this direction from the middle.
Vector3d surface_towards(const ImplicitShape& shape, const Vector3d& direction) {
  double inside = 0, outside = 0.2;
  while (outside > 0.001 && shape(outside * direction) > 0) outside -= 0.002;
  inside = outside;
  outside += 0.002;
  for (int step = 0; step < 20; ++step) {
    const double middle = 0.5 * (inside + outside);
    (shape(middle * direction) > 0 ? outside : inside) = middle;
  }
  return inside * direction;
}

/// [sRGB, 0 to 1] Brown red; lighter where fibres and fat lie under the capsule, as at the lower margin.
Vector3d colour_at(const Vector3d& p) {
  const double broad = noise(p / 0.030), patches = noise(p / 0.011 + Vector3d::Constant(2 * broad));
  const double lobules = noise(p / 0.0035);
  const double field = noise(p / 0.022 + Vector3d::Constant(2.5 * noise(p / 0.014)));
  const double vein = std::clamp(1 - 30 * std::abs(field - 0.5), 0.0, 1.0) * std::clamp(3 * broad - 1, 0.0, 1.0);
  const double margin = std::clamp((-p.z() - 0.020) / 0.040, 0.0, 1.0) * std::clamp((-p.y() - 0.02) / 0.05, 0.0, 1.0);
  Vector3d colour(0.54, 0.235, 0.185);
  colour *= 1 + 0.30 * (broad - 0.5) + 0.26 * (patches - 0.5) + 0.14 * (lobules - 0.5);
  colour += 0.10 * std::max(patches - 0.6, 0.0) * Vector3d(1.0, 0.8, 0.55);
  colour += 0.10 * margin * Vector3d(1.0, 0.75, 0.55);
  return colour.cwiseProduct(Vector3d(1 - 0.28 * vein, 1 - 0.36 * vein, 1 - 0.22 * vein));
}

}  // namespace

void write_liver_texture(const std::filesystem::path& file) {
  const ImplicitShape shape = liver_shape();
  Image image{kPixelsAround, kPixelsDown, {}};
  for (int y = 0; y < kPixelsDown; ++y)
    for (int x = 0; x < kPixelsAround; ++x) {
      const double around = 2 * std::numbers::pi * ((x + 0.5) / kPixelsAround - 0.5);
      const double down = std::numbers::pi * (y + 0.5) / kPixelsDown;
      const Vector3d direction(-std::sin(down) * std::sin(around), -std::sin(down) * std::cos(around), std::cos(down));
      const Vector3d colour = colour_at(surface_towards(shape, direction));
      for (const double channel : colour)
        image.rgba.push_back(static_cast<std::uint8_t>(std::lround(255 * std::clamp(channel, 0.0, 1.0))));
      image.rgba.push_back(255);
    }
  write_png(image, file);
}

}  // namespace palpate
