#include "common/dynamics/resection.hpp"

namespace palpate {

Resection::Resection(const Box& marked, const ElasticMesh& mesh) {
  for (const std::array<int, 4>& nodes : mesh.tetrahedra) {
    const Eigen::Vector3d &a = mesh.rest[nodes[0]], &b = mesh.rest[nodes[1]], &c = mesh.rest[nodes[2]],
                          &d = mesh.rest[nodes[3]];
    const Eigen::Vector3d centroid = (a + b + c + d) / 4;
    marked_.push_back((centroid.array() >= marked.min.array()).all() && (centroid.array() <= marked.max.array()).all());
    volume_.push_back((b - a).cross(c - a).dot(d - a) / 6);
  }
}

void Resection::cut(std::size_t tetrahedron) {
  if (tetrahedron >= marked_.size()) return;
  Part& part = marked_[tetrahedron] ? inside_ : outside_;
  ++part.tetrahedra;
  part.volume += volume_[tetrahedron];
}

void Resection::cut(std::span<const int> tetrahedra) {
  for (const int t : tetrahedra) cut(static_cast<std::size_t>(t));
}

void Resection::cut(std::span<const std::uint32_t> tetrahedra) {
  for (const std::uint32_t t : tetrahedra) cut(std::size_t{t});
}

}  // namespace palpate
