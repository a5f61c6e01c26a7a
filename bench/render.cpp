// How long does a frame take: upload of the vertices, drawing with all shading, read back into memory?
// The scene is the usual one: an organ that moves, a still backdrop, an instrument, the overlay.
#include <cmath>
#include <numbers>

#include "bench/report.hpp"
#include "common/geometry/direction.hpp"
#include "common/mesh/normals.hpp"
#include "render_node/renderer.hpp"

namespace {
using namespace palpate;

struct Shape {
  std::vector<Eigen::Vector3f> rest, position, normal;
  std::vector<std::array<int, 3>> triangles;
};

/// A closed, smooth, lobed body of 2 * around * (rings - 1) triangles, about 0.2 m wide.
Shape make_organ(int rings, int around) {
  Shape s;
  const float pi = std::numbers::pi_v<float>;
  for (int i = 0; i <= rings; ++i)
    for (int j = 0; j < around; ++j) {
      const float t = pi * static_cast<float>(i) / static_cast<float>(rings);
      const float p = 2 * pi * static_cast<float>(j) / static_cast<float>(around);
      const float x = std::sin(t) * std::cos(p), y = std::sin(t) * std::sin(p), z = std::cos(t);
      s.rest.emplace_back(0.10f * x, 0.065f * y * (1 - 0.3f * x), 0.040f * z * (1 - 0.35f * x));
    }
  for (int i = 0; i < rings; ++i)
    for (int j = 0; j < around; ++j) {
      const int a = i * around + j, b = i * around + (j + 1) % around;
      if (i > 0) s.triangles.push_back({a, a + around, b});
      if (i + 1 < rings) s.triangles.push_back({b, a + around, b + around});
    }
  s.position = s.rest;
  s.normal.resize(s.position.size());
  vertex_normals(s.position, s.triangles, s.normal);
  return s;
}

void press(Shape& s, float depth) {
  for (std::size_t i = 0; i < s.rest.size(); ++i) {
    const float r2 = (s.rest[i] - Eigen::Vector3f(0.02f, -0.01f, 0.035f)).squaredNorm();
    s.position[i] = s.rest[i] - Eigen::Vector3f(0, 0, depth * std::exp(-r2 / 4e-4f));
  }
  vertex_normals(s.position, s.triangles, s.normal);
}

Frame make_frame(const Shape& organ, const Shape& wall) {
  Frame frame;
  frame.camera = {.eye = {0.03, -0.15, 0.15}, .target = {0, 0, 0}, .up = {0, 0, 1}, .field_of_view = 50};
  frame.meshes.push_back({.id = 0,
                          .rest = organ.rest,
                          .position = organ.position,
                          .normal = organ.normal,
                          .scalar = {},
                          .triangles = organ.triangles});
  frame.meshes.push_back({.id = 1,
                          .finish = Finish::bone,
                          .rest = wall.rest,
                          .position = wall.position,
                          .normal = wall.normal,
                          .scalar = {},
                          .triangles = wall.triangles,
                          .moving = false});
  InstrumentView tool;
  tool.tip.translation() = Eigen::Vector3d(0.02, -0.01, 0.034);
  tool.tip.linear() = turn_between(Eigen::Vector3d::UnitZ(), Eigen::Vector3d(-0.5, 0.2, -0.8)).toRotationMatrix();
  frame.instruments.push_back(tool);
  frame.overlay =
      Overlay{{"haptic 1000 Hz   visual 60 Hz", "tool to picture 9.1 ms (p99 12.3)", "probe  1.83 N"}, Gauge{1.83, 5}};
  return frame;
}

void measure(const char* name, int width, int height, int samples, int count) {
  Shape organ = make_organ(84, 84), wall = make_organ(12, 24);
  for (auto& p : wall.position) p = 1.5f * p + Eigen::Vector3f(0, 0.12f, -0.08f);
  const Frame frame = make_frame(organ, wall);
  Renderer renderer(width, height, samples);
  Image image;
  bench::Samples times;
  for (int i = -10; i < count; ++i) {
    press(organ, 0.006f + 0.006f * std::sin(0.1f * static_cast<float>(i)));
    bench::Samples one;
    one.measure(0, 1, [&](int) { renderer.draw(frame, image); });
    if (i >= 0) times.add(one.median());
  }
  bench::keep(image.rgba.front());
  bench::report("render", name, "p50", 1e3 * times.median(), "ms");
  bench::report("render", name, "p99", 1e3 * times.p99(), "ms");
}

}  // namespace

int main(int argc, char** argv) {
  const int count = palpate::bench::quick(argc, argv) ? 60 : 300;
  measure("tri14000_1024x768", 1024, 768, 1, count);
  measure("tri14000_1024x768_4samples", 1024, 768, 4, count / 3);
  measure("tri14000_1920x1080", 1920, 1080, 1, count / 3);
}
