#pragma once
#include <memory>

#include "common/view/draw_list.hpp"
#include "render_node/image.hpp"

namespace palpate {

/// Draws frames off screen: the one home of OpenGL. Not for two threads at once. The same frame gives the
/// same bytes. After the first frame of a set of meshes nothing is allocated but the caller's image, if it
/// grows.
class Renderer {
 public:
  /// `samples` per pixel: 1 is fast, 4 smooths edges and costs two to three times. Throws std::runtime_error.
  Renderer(int width, int height, int samples = 1);
  ~Renderer();

  void resize(int width, int height);
  /// Throws std::runtime_error if the frame is not drawable (unequal spans, too many instruments) or OpenGL
  /// fails.
  void draw(const Frame& frame, Image& image);

  int width() const;
  int height() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace palpate
