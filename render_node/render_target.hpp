#pragma once
#include "render_node/gl.hpp"
#include "render_node/image.hpp"

namespace palpate {

/// The picture in OpenGL: with more than one sample the scene is drawn into a second, finer picture first.
/// The backdrop is a picture with depth that many frames begin with.
class RenderTarget {
 public:
  /// Throws std::runtime_error if OpenGL cannot hold such a picture.
  RenderTarget(GlContext& context, int width, int height, int samples);
  ~RenderTarget();
  RenderTarget(const RenderTarget&) = delete;

  void resize(int width, int height);
  int width() const { return width_; }
  int height() const { return height_; }

  void begin_backdrop();  ///< clears; what is drawn next becomes the backdrop, kept until the next resize
  bool has_backdrop() const { return has_backdrop_; }
  void begin();             ///< copies the backdrop, with its depth; what is drawn next lands in it
  void resolve();           ///< merges the samples; what is drawn next lands on top of them
  void read(Image& image);  ///< waits for the picture

 private:
  struct Layer {
    GLuint frame = 0, colour = 0, depth = 0;
  };
  Layer make(int samples);
  void release();

  const GlFunctions* gl_;
  int width_, height_, samples_;
  bool has_backdrop_ = false;
  Layer plain_, fine_, backdrop_;
};

}  // namespace palpate
