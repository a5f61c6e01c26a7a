#pragma once
#include <Eigen/Core>
#include <array>
#include <memory>
#include <span>
#include <vector>

#include "common/mesh/visual_binding.hpp"
#include "common/mesh/visual_mesh.hpp"

namespace palpate {

/// A visual surface that follows the nodes of its body. A vertex moves with its cell's point that is nearest, and by
/// what is around each of the cell's nodes k: their deformation H_k,
///     y = sum_k w_k y_k + H_k a_k,   a_k = w_k ((p - X_k) / 2 + o),
/// p being that point at rest, o the way from it to the vertex, X_k the node at rest. So the field is smooth from cell
/// to cell, right to the second order inside of them, and what stands off turns with what is below. y_k are the nodes'
/// positions; with triangles among the cells, in a frame that moves with the best affine map of the triangles' nodes,
/// since a triangle says nothing of what is across it: an affine motion is followed exactly either way.
class VisualShape {
 public:
  /// `nodes`: [m] of the body at rest.
  VisualShape(VisualMesh mesh, VisualBinding binding, std::span<const Eigen::Vector3d> nodes);

  /// Follows the nodes [m]; as many as at rest. Allocates nothing.
  void place(std::span<const Eigen::Vector3f> nodes);
  /// Parts the surface as the body is parted: `piece` per tetrahedron, -1 for one that is gone, 0 for what hangs
  /// together with cells that are triangles. A triangle is left out when the cells of its corners are gone or are of
  /// different pieces.
  void part(std::span<const int> piece);

  const VisualMesh& mesh() const { return *mesh_; }
  const std::vector<Eigen::Vector3f>& position() const { return position_; }  ///< [m] per vertex
  const std::vector<Eigen::Vector3f>& normal() const { return normal_; }      ///< unit, outward, per vertex
  /// That is left of a part of the mesh.
  const std::vector<std::array<int, 3>>& triangles(std::size_t part) const { return triangles_[part]; }
  /// For what is added to positions: unit normals as they follow from them.
  std::vector<Eigen::Vector3f>& positions() { return position_; }
  void find_normals();

 private:
  struct Cell {
    std::array<int, 4> node;
    Eigen::Matrix3f inverse;  ///< of its edges at rest as columns, of a triangle with its unit normal [1/m]
    float weight;             ///< [m^3] its size, of a triangle with a thickness of its own
    bool alive = true;
  };
  struct Tie {
    int cell;
    std::array<int, 4> node;  ///< of the cell; with weight 0 where it has three
    std::array<float, 4> weight;
    std::array<Eigen::Vector3f, 4> arm;  ///< [m]
  };
  /// The affine map that is nearest to what the nodes have done; the identity without triangles.
  class Frame {
   public:
    Frame() = default;
    Frame(std::span<const Cell> cells, std::span<const Eigen::Vector3f> rest);
    void follow(std::span<const Eigen::Vector3f> nodes);
    Eigen::Vector3f from_world(const Eigen::Vector3f& x) const { return inverse_ * (x - shift_); }
    Eigen::Vector3f to_world(const Eigen::Vector3f& y) const { return map_ * y + shift_; }

   private:
    std::vector<int> node_;
    std::vector<Eigen::Vector3f> dual_;  ///< per node: its share in the map [1/m]
    Eigen::Vector3f middle_ = Eigen::Vector3f::Zero();
    Eigen::Matrix3f map_ = Eigen::Matrix3f::Identity(), inverse_ = Eigen::Matrix3f::Identity();
    Eigen::Vector3f shift_ = Eigen::Vector3f::Zero();
  };

  static Eigen::Matrix3f edges(const std::array<int, 4>& node, std::span<const Eigen::Vector3f> at);
  void add_cell(const std::array<int, 4>& node);
  void add_tie(const VisualBinding::Tie& tie, const Eigen::Vector3f& vertex);
  void find_deformation();

  std::shared_ptr<const VisualMesh> mesh_;
  std::vector<Eigen::Vector3f> rest_;  ///< [m] nodes
  int tetrahedra_;
  std::vector<Cell> cells_;
  std::vector<Tie> ties_;
  Frame frame_;
  std::vector<std::vector<std::array<int, 3>>> triangles_;  ///< per part
  std::vector<Eigen::Vector3f> position_, normal_, node_normal_;

  // Per node of the body, as of the last place().
  std::vector<Eigen::Vector3f> moved_;
  std::vector<Eigen::Matrix3f> deformation_;
  std::vector<float> around_;
};

}  // namespace palpate
