#include "common/mesh/visual_shape.hpp"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <set>

namespace palpate {
namespace {

using Eigen::Matrix3f;
using Eigen::Vector3f;

constexpr float kMinVolume = 0.05f;  // that an affine map may leave of a body and still be a frame for it

}  // namespace

VisualShape::VisualShape(VisualMesh mesh, VisualBinding binding, std::span<const Eigen::Vector3d> nodes)
    : mesh_(std::make_shared<const VisualMesh>(std::move(mesh))), tetrahedra_(binding.tetrahedra) {
  for (const Eigen::Vector3d& x : nodes) rest_.push_back(x.cast<float>());
  for (const auto& cell : binding.cells) add_cell(cell);
  for (std::size_t v = 0; v < binding.ties.size(); ++v) add_tie(binding.ties[v], mesh_->position[v]);
  if (tetrahedra_ < static_cast<int>(cells_.size())) frame_ = Frame(std::span(cells_).subspan(tetrahedra_), rest_);
  for (const VisualMesh::Part& part : mesh_->parts) triangles_.push_back(part.triangles);
  position_ = mesh_->position;
  normal_.resize(position_.size());
  node_normal_.resize(mesh_->nodes);
  moved_ = rest_;
  deformation_.resize(rest_.size());
  around_.resize(rest_.size());
  find_normals();
}

Matrix3f VisualShape::edges(const std::array<int, 4>& node, std::span<const Vector3f> at) {
  Matrix3f e;
  e.col(0) = at[node[1]] - at[node[0]];
  e.col(1) = at[node[2]] - at[node[0]];
  e.col(2) = node[3] < 0 ? e.col(0).cross(e.col(1)).normalized() : Vector3f(at[node[3]] - at[node[0]]);
  return e;
}

void VisualShape::add_cell(const std::array<int, 4>& node) {
  const Matrix3f e = edges(node, rest_);
  const float size = std::abs(e.determinant());
  cells_.push_back({node, e.inverse(), node[3] < 0 ? std::pow(size, 1.5f) : size});
}

void VisualShape::add_tie(const VisualBinding::Tie& bound, const Vector3f& vertex) {
  Tie tie{bound.cell, cells_[bound.cell].node, bound.weight, {}};
  if (tie.node[3] < 0) tie.node[3] = tie.node[0];
  Vector3f point = Vector3f::Zero();
  for (int k = 0; k < 4; ++k) point += tie.weight[k] * rest_[tie.node[k]];
  for (int k = 0; k < 4; ++k) tie.arm[k] = tie.weight[k] * (0.5f * (point - rest_[tie.node[k]]) + vertex - point);
  ties_.push_back(tie);
}

// Least squares: the map is the sum of the nodes' places times their share.
VisualShape::Frame::Frame(std::span<const Cell> cells, std::span<const Vector3f> rest) {
  std::set<int> used;
  for (const Cell& cell : cells) used.insert(cell.node.begin(), cell.node.begin() + 3);
  node_.assign(used.begin(), used.end());
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();
  for (const int n : node_) middle += rest[n].cast<double>() / static_cast<double>(node_.size());
  Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
  for (const int n : node_) {
    const Eigen::Vector3d from_middle = rest[n].cast<double>() - middle;
    spread += from_middle * from_middle.transpose();
  }
  middle_ = middle.cast<float>();
  const double size = spread.trace() / 3;
  if (!(spread.determinant() > 1e-9 * size * size * size)) return;  // flat: no map is nearest
  const Eigen::Matrix3d inverse = spread.inverse();
  for (const int n : node_) dual_.push_back((inverse * (rest[n].cast<double>() - middle)).cast<float>());
}

void VisualShape::Frame::follow(std::span<const Vector3f> nodes) {
  if (dual_.empty()) return;
  Vector3f middle = Vector3f::Zero();
  for (const int n : node_) middle += nodes[n] / static_cast<float>(node_.size());
  Matrix3f map = Matrix3f::Zero();
  for (std::size_t i = 0; i < node_.size(); ++i) map += (nodes[node_[i]] - middle) * dual_[i].transpose();
  map_ = map.determinant() > kMinVolume ? map : Matrix3f::Identity();
  inverse_ = map_.inverse();
  shift_ = middle - map_ * middle_;
}

void VisualShape::find_deformation() {
  std::ranges::fill(deformation_, Matrix3f::Zero());
  std::ranges::fill(around_, 0.0f);
  for (const Cell& cell : cells_) {
    if (!cell.alive) continue;
    const Matrix3f weighted = cell.weight * (edges(cell.node, moved_) * cell.inverse);
    for (const int n : cell.node) {
      if (n < 0) continue;
      deformation_[n] += weighted;
      around_[n] += cell.weight;
    }
  }
  for (std::size_t n = 0; n < deformation_.size(); ++n)
    if (around_[n] > 0) deformation_[n] /= around_[n];
}

void VisualShape::place(std::span<const Vector3f> nodes) {
  frame_.follow(nodes);
  for (std::size_t n = 0; n < moved_.size(); ++n) moved_[n] = frame_.from_world(nodes[n]);
  find_deformation();
  for (std::size_t v = 0; v < ties_.size(); ++v) {
    const Tie& tie = ties_[v];
    Vector3f y = Vector3f::Zero();
    for (int k = 0; k < 4; ++k) y += tie.weight[k] * moved_[tie.node[k]] + deformation_[tie.node[k]] * tie.arm[k];
    position_[v] = frame_.to_world(y);
  }
  find_normals();
}

void VisualShape::find_normals() {
  std::ranges::fill(node_normal_, Vector3f::Zero());
  for (std::size_t p = 0; p < triangles_.size(); ++p) {
    const int first = mesh_->parts[p].first;
    for (const auto& [a, b, c] : triangles_[p]) {
      const Vector3f& corner = position_[first + a];
      const Vector3f area = (position_[first + b] - corner).cross(position_[first + c] - corner);
      for (const int v : {a, b, c}) node_normal_[mesh_->node[first + v]] += area;
    }
  }
  for (Vector3f& normal : node_normal_) {
    const float length = normal.norm();
    if (length > 0) normal /= length;
  }
  for (std::size_t v = 0; v < normal_.size(); ++v) normal_[v] = node_normal_[mesh_->node[v]];
}

void VisualShape::part(std::span<const int> piece) {
  for (int t = 0; t < tetrahedra_; ++t) cells_[t].alive = piece[t] >= 0;
  const auto piece_of = [&](int vertex) {
    const int cell = ties_[vertex].cell;
    return cell < tetrahedra_ ? piece[cell] : 0;
  };
  for (std::size_t p = 0; p < triangles_.size(); ++p) {
    const VisualMesh::Part& part = mesh_->parts[p];
    triangles_[p].clear();
    for (const auto& t : part.triangles) {
      const int a = piece_of(part.first + t[0]), b = piece_of(part.first + t[1]), c = piece_of(part.first + t[2]);
      if (a >= 0 && a == b && a == c) triangles_[p].push_back(t);
    }
  }
  find_normals();
}

}  // namespace palpate
