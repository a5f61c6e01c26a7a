#pragma once
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <numbers>

#include "common/mesh/normals.hpp"
#include "common/view/draw_list.hpp"
#include "render_node/image.hpp"
#include "render_node/renderer.hpp"

namespace palpate::testing {

/// A closed surface with its own storage.
struct Ball {
  std::vector<Eigen::Vector3f> rest, position, normal;
  std::vector<float> scalar;
  std::vector<std::array<int, 3>> triangles;

  void update_normals() {
    normal.resize(position.size());
    vertex_normals(position, triangles, normal);
  }
  MeshView view(int id, Finish finish = Finish::tissue) const {
    return {.id = id,
            .finish = finish,
            .rest = rest,
            .position = position,
            .normal = normal,
            .scalar = scalar,
            .triangles = triangles};
  }
};

/// A ball around the origin of 4 * rings * (rings - 1) triangles.
inline Ball make_ball(float radius, int rings) {
  Ball ball;
  const int around = 2 * rings;
  const float pi = std::numbers::pi_v<float>;
  for (int i = 0; i <= rings; ++i)
    for (int j = 0; j < around; ++j) {
      const float t = pi * static_cast<float>(i) / static_cast<float>(rings);
      const float p = 2 * pi * static_cast<float>(j) / static_cast<float>(around);
      ball.rest.emplace_back(radius * std::sin(t) * std::cos(p), radius * std::sin(t) * std::sin(p),
                             radius * std::cos(t));
    }
  for (int i = 0; i < rings; ++i)
    for (int j = 0; j < around; ++j) {
      const int a = i * around + j, b = i * around + (j + 1) % around;
      if (i > 0) ball.triangles.push_back({a, a + around, b});
      if (i + 1 < rings) ball.triangles.push_back({b, a + around, b + around});
    }
  ball.position = ball.rest;
  ball.update_normals();
  return ball;
}

/// Straight down -y at the origin from 0.3 m, z up, 50 degrees.
inline Frame empty_frame() {
  Frame frame;
  frame.camera = {.eye = {0, -0.3, 0}, .target = {0, 0, 0}, .up = {0, 0, 1}, .field_of_view = 50};
  return frame;
}

inline Image picture(const Frame& frame, int width = 320, int height = 240, int samples = 1) {
  Renderer renderer(width, height, samples);
  Image image;
  renderer.draw(frame, image);
  return image;
}

inline double brightness(const Image& image, int x, int y) {
  const std::uint8_t* p = image.pixel(x, y);
  return (p[0] + p[1] + p[2]) / 3.0;
}

/// Share of pixels for which f(pixel) holds.
template <class F>
double share(const Image& image, F&& f) {
  long count = 0;
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) count += f(image.pixel(x, y));
  return static_cast<double>(count) / (static_cast<double>(image.width) * image.height);
}

/// Share of pixels that differ by more than `tolerance` in some colour.
inline double difference(const Image& a, const Image& b, int tolerance = 0) {
  long count = 0;
  for (int y = 0; y < a.height; ++y)
    for (int x = 0; x < a.width; ++x) {
      int most = 0;
      for (int c = 0; c < 3; ++c) most = std::max(most, std::abs(a.pixel(x, y)[c] - b.pixel(x, y)[c]));
      count += most > tolerance;
    }
  return static_cast<double>(count) / (static_cast<double>(a.width) * a.height);
}

/// A folder of this test process, removed at the end.
struct Folder {
  std::filesystem::path path =
      std::filesystem::temp_directory_path() / ("palpate_render_" + std::to_string(::getpid()));
  Folder() { std::filesystem::create_directories(path); }
  ~Folder() { std::filesystem::remove_all(path); }
  long files() const {
    return std::distance(std::filesystem::directory_iterator(path), std::filesystem::directory_iterator());
  }
};

/// The message of the exception that f throws; empty if it throws none.
template <class F>
std::string complaint(F&& f) {
  try {
    f();
  } catch (const std::exception& error) {
    return error.what();
  }
  return {};
}

}  // namespace palpate::testing
