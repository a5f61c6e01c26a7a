#pragma once
#include "common/view/draw_list.hpp"
#include "render_node/gl.hpp"

namespace palpate {

/// An image in OpenGL, with smaller copies of itself for what is far away. The context must be current and outlive it.
class GpuTexture {
 public:
  explicit GpuTexture(GlContext& context) : gl_(&context.gl) {}
  ~GpuTexture();
  GpuTexture(const GpuTexture&) = delete;

  /// Uploads the pixels unless they are here.
  void hold(const TextureView& texture);
  void bind(GLuint unit) const { gl_->BindTextureUnit(unit, texture_); }

 private:
  const GlFunctions* gl_;
  GLuint texture_ = 0;
  const void* pixels_ = nullptr;
};

}  // namespace palpate
