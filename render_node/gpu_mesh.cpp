#include "render_node/gpu_mesh.hpp"

#include <cstddef>
#include <utility>

namespace palpate {

static_assert(sizeof(Eigen::Vector3f) == 12 && sizeof(std::array<int, 3>) == 12);

GpuMesh::GpuMesh(GpuMesh&& other) noexcept
    : gl_(other.gl_),
      array_(std::exchange(other.array_, 0)),
      buffer_(std::exchange(other.buffer_, {})),
      shape_(other.shape_),
      vertices_(other.vertices_),
      triangles_(other.triangles_),
      scalars_(other.scalars_),
      edges_(other.edges_) {}

GpuMesh::~GpuMesh() {
  release();
}

void GpuMesh::release() {
  if (!array_) return;
  gl_->DeleteVertexArrays(1, &array_);
  gl_->DeleteBuffers(buffers, buffer_.data());
}

bool GpuMesh::holds(const MeshView& mesh) const {
  return array_ && shape_ == mesh.shape && vertices_ == mesh.position.size() && triangles_ == mesh.triangles.size() &&
         scalars_ == mesh.scalar.size();
}

void GpuMesh::build(const MeshView& mesh) {
  release();
  shape_ = mesh.shape;
  vertices_ = mesh.position.size();
  triangles_ = mesh.triangles.size();
  scalars_ = mesh.scalar.size();
  edges_ = mesh.edges.size();
  gl_->CreateVertexArrays(1, &array_);
  gl_->CreateBuffers(buffers, buffer_.data());
  const GLenum usage = mesh.moving ? GL_STREAM_DRAW : GL_STATIC_DRAW;
  gl_->NamedBufferData(buffer_[position], mesh.position.size_bytes(), mesh.position.data(), usage);
  gl_->NamedBufferData(buffer_[normal], mesh.normal.size_bytes(), mesh.normal.data(), usage);
  gl_->NamedBufferData(buffer_[rest], mesh.rest.size_bytes(), mesh.rest.data(), GL_STATIC_DRAW);
  gl_->NamedBufferData(buffer_[scalar], mesh.scalar.size_bytes(), mesh.scalar.data(), usage);
  gl_->NamedBufferData(buffer_[image], mesh.image.size_bytes(), mesh.image.data(), GL_STATIC_DRAW);
  gl_->NamedBufferData(buffer_[index], mesh.triangles.size_bytes(), mesh.triangles.data(), GL_STATIC_DRAW);
  gl_->NamedBufferData(buffer_[wires], mesh.edges.size_bytes(), mesh.edges.data(), GL_STATIC_DRAW);
  for (const GLuint slot : {position, normal, rest, scalar, image}) {
    if ((slot == scalar && mesh.scalar.empty()) || (slot == image && mesh.image.empty())) continue;
    const int components = slot == scalar ? 1 : slot == image ? 2 : 3;
    gl_->EnableVertexArrayAttrib(array_, slot);
    gl_->VertexArrayAttribFormat(array_, slot, components, GL_FLOAT, GL_FALSE, 0);
    gl_->VertexArrayAttribBinding(array_, slot, slot);
    gl_->VertexArrayVertexBuffer(array_, slot, buffer_[slot], 0, components * static_cast<int>(sizeof(float)));
  }
  gl_->VertexArrayElementBuffer(array_, buffer_[index]);
}

void GpuMesh::update(const MeshView& mesh) {
  gl_->NamedBufferSubData(buffer_[position], 0, mesh.position.size_bytes(), mesh.position.data());
  gl_->NamedBufferSubData(buffer_[normal], 0, mesh.normal.size_bytes(), mesh.normal.data());
  if (!mesh.scalar.empty()) gl_->NamedBufferSubData(buffer_[scalar], 0, mesh.scalar.size_bytes(), mesh.scalar.data());
}

void GpuMesh::draw() const {
  gl_->BindVertexArray(array_);
  gl_->DrawElements(GL_TRIANGLES, static_cast<GLsizei>(3 * triangles_), GL_UNSIGNED_INT, nullptr);
}

void GpuMesh::draw_edges() const {
  gl_->VertexArrayElementBuffer(array_, buffer_[wires]);
  gl_->BindVertexArray(array_);
  gl_->DrawElements(GL_LINES, static_cast<GLsizei>(2 * edges_), GL_UNSIGNED_INT, nullptr);
  gl_->VertexArrayElementBuffer(array_, buffer_[index]);
}

GpuQuads::GpuQuads(GlContext& context) : gl_(&context.gl) {
  gl_->CreateVertexArrays(1, &array_);
  gl_->CreateBuffers(1, &buffer_);
  const struct {
    int components;
    std::size_t offset;
  } attributes[] = {{2, offsetof(FlatVertex, x)}, {2, offsetof(FlatVertex, u)}, {4, offsetof(FlatVertex, red)}};
  for (GLuint slot = 0; slot < 3; ++slot) {
    gl_->EnableVertexArrayAttrib(array_, slot);
    gl_->VertexArrayAttribFormat(array_, slot, attributes[slot].components, GL_FLOAT, GL_FALSE,
                                 static_cast<GLuint>(attributes[slot].offset));
    gl_->VertexArrayAttribBinding(array_, slot, 0);
  }
  gl_->VertexArrayVertexBuffer(array_, 0, buffer_, 0, sizeof(FlatVertex));
}

GpuQuads::~GpuQuads() {
  gl_->DeleteVertexArrays(1, &array_);
  gl_->DeleteBuffers(1, &buffer_);
}

void GpuQuads::draw(std::span<const FlatVertex> vertices) {
  if (vertices.size() > capacity_) {
    capacity_ = 2 * vertices.size();
    gl_->NamedBufferData(buffer_, static_cast<GLsizeiptr>(capacity_ * sizeof(FlatVertex)), nullptr, GL_STREAM_DRAW);
  }
  gl_->NamedBufferSubData(buffer_, 0, vertices.size_bytes(), vertices.data());
  gl_->BindVertexArray(array_);
  gl_->DrawArrays(GL_TRIANGLES, 0, static_cast<GLsizei>(vertices.size()));
}

}  // namespace palpate
