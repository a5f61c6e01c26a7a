#include "render_node/render_target.hpp"

#include <fmt/format.h>

#include <stdexcept>

namespace palpate {

RenderTarget::RenderTarget(GlContext& context, int width, int height, int samples)
    : gl_(&context.gl), samples_(samples) {
  resize(width, height);
}

RenderTarget::~RenderTarget() {
  release();
}

void RenderTarget::release() {
  for (Layer* layer : {&plain_, &fine_, &backdrop_}) {
    if (!layer->frame) continue;
    gl_->DeleteFramebuffers(1, &layer->frame);
    gl_->DeleteRenderbuffers(1, &layer->colour);
    gl_->DeleteRenderbuffers(1, &layer->depth);
    *layer = {};
  }
}

RenderTarget::Layer RenderTarget::make(int samples) {
  Layer layer;
  gl_->CreateFramebuffers(1, &layer.frame);
  gl_->CreateRenderbuffers(1, &layer.colour);
  gl_->CreateRenderbuffers(1, &layer.depth);
  const int stored = samples > 1 ? samples : 0;
  gl_->NamedRenderbufferStorageMultisample(layer.colour, stored, GL_RGBA8, width_, height_);
  gl_->NamedRenderbufferStorageMultisample(layer.depth, stored, GL_DEPTH_COMPONENT32F, width_, height_);
  gl_->NamedFramebufferRenderbuffer(layer.frame, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, layer.colour);
  gl_->NamedFramebufferRenderbuffer(layer.frame, GL_DEPTH_ATTACHMENT, GL_RENDERBUFFER, layer.depth);
  const bool complete = gl_->CheckNamedFramebufferStatus(layer.frame, GL_FRAMEBUFFER) == GL_FRAMEBUFFER_COMPLETE;
  if (gl_->GetError() != GL_NO_ERROR || !complete)
    throw std::runtime_error(
        fmt::format("OpenGL cannot hold a picture of {} x {} pixels with {} samples", width_, height_, samples));
  return layer;
}

void RenderTarget::resize(int width, int height) {
  if (width < 16 || height < 16 || width > 8192 || height > 8192)
    throw std::runtime_error(fmt::format("a picture has 16 to 8192 pixels a side, not {} x {}", width, height));
  release();
  width_ = width;
  height_ = height;
  plain_ = make(1);
  if (samples_ > 1) fine_ = make(samples_);
  backdrop_ = make(samples_);
  has_backdrop_ = false;
}

void RenderTarget::begin_backdrop() {
  gl_->BindFramebuffer(GL_FRAMEBUFFER, backdrop_.frame);
  gl_->Viewport(0, 0, width_, height_);
  gl_->ClearColor(0, 0, 0, 1);
  gl_->Clear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
  has_backdrop_ = true;
}

void RenderTarget::begin() {
  const Layer& layer = samples_ > 1 ? fine_ : plain_;
  gl_->BlitNamedFramebuffer(backdrop_.frame, layer.frame, 0, 0, width_, height_, 0, 0, width_, height_,
                            GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT, GL_NEAREST);
  gl_->BindFramebuffer(GL_FRAMEBUFFER, layer.frame);
  gl_->Viewport(0, 0, width_, height_);
}

void RenderTarget::resolve() {
  if (samples_ <= 1) return;
  gl_->BlitNamedFramebuffer(fine_.frame, plain_.frame, 0, 0, width_, height_, 0, 0, width_, height_,
                            GL_COLOR_BUFFER_BIT, GL_NEAREST);
  gl_->BindFramebuffer(GL_FRAMEBUFFER, plain_.frame);
}

void RenderTarget::read(Image& image) {
  image.width = width_;
  image.height = height_;
  image.rgba.resize(4 * static_cast<std::size_t>(width_) * height_);
  gl_->BindFramebuffer(GL_FRAMEBUFFER, plain_.frame);
  gl_->PixelStorei(GL_PACK_ALIGNMENT, 4);
  gl_->ReadPixels(0, 0, width_, height_, GL_RGBA, GL_UNSIGNED_BYTE, image.rgba.data());
}

}  // namespace palpate
