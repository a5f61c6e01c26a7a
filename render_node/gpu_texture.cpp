#include "render_node/gpu_texture.hpp"

#include <algorithm>
#include <bit>

namespace palpate {

GpuTexture::~GpuTexture() {
  if (texture_) gl_->DeleteTextures(1, &texture_);
}

void GpuTexture::hold(const TextureView& texture) {
  if (pixels_ == texture.rgba.data()) return;
  pixels_ = texture.rgba.data();
  if (texture_) gl_->DeleteTextures(1, &texture_);
  gl_->CreateTextures(GL_TEXTURE_2D, 1, &texture_);
  const auto longest = static_cast<unsigned>(std::max(texture.width, texture.height));
  gl_->TextureStorage2D(texture_, std::bit_width(longest), GL_SRGB8_ALPHA8, texture.width, texture.height);
  gl_->PixelStorei(GL_UNPACK_ALIGNMENT, 1);
  gl_->TextureSubImage2D(texture_, 0, 0, 0, texture.width, texture.height, GL_RGBA, GL_UNSIGNED_BYTE,
                         texture.rgba.data());
  gl_->GenerateTextureMipmap(texture_);
  gl_->TextureParameteri(texture_, GL_TEXTURE_MIN_FILTER, GL_LINEAR_MIPMAP_LINEAR);
  gl_->TextureParameteri(texture_, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
}

}  // namespace palpate
