#pragma once
#include <span>

#include "common/view/draw_list.hpp"
#include "render_node/gl.hpp"
#include "render_node/overlay.hpp"

namespace palpate {

/// Buffers of one mesh in OpenGL. The context must be current and outlive it.
class GpuMesh {
 public:
  explicit GpuMesh(GlContext& context) : gl_(&context.gl) {}
  ~GpuMesh();
  GpuMesh(GpuMesh&& other) noexcept;
  GpuMesh(const GpuMesh&) = delete;

  /// True if the buffers fit this mesh's shape and lengths, so that update() suffices.
  bool holds(const MeshView& mesh) const;
  void build(const MeshView& mesh);   ///< everything, into new buffers
  void update(const MeshView& mesh);  ///< positions, normals and scalars, into the same buffers
  void draw() const;
  void draw_edges() const;

 private:
  enum Buffer { position, normal, rest, scalar, image, index, wires, buffers };

  void release();

  const GlFunctions* gl_;
  GLuint array_ = 0;
  std::array<GLuint, buffers> buffer_{};
  std::uint64_t shape_ = 0;
  std::size_t vertices_ = 0, triangles_ = 0, scalars_ = 0, edges_ = 0;
};

/// Flat triangles that change every frame; its buffer grows and never shrinks.
class GpuQuads {
 public:
  explicit GpuQuads(GlContext& context);
  ~GpuQuads();
  GpuQuads(const GpuQuads&) = delete;

  void draw(std::span<const FlatVertex> vertices);

 private:
  const GlFunctions* gl_;
  GLuint array_ = 0, buffer_ = 0;
  std::size_t capacity_ = 0;
};

}  // namespace palpate
