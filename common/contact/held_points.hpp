#pragma once
#include <Eigen/Core>
#include <cstddef>
#include <span>
#include <vector>

#include "common/contact/contact_side.hpp"
#include "common/contact/response.hpp"
#include "common/geometry/anchor.hpp"
#include "common/kernels/kernels.hpp"

namespace palpate {

/// What is prescribed at a held point.
enum class Hold : unsigned char {
  none,    ///< nothing: its force is zero
  normal,  ///< the displacement along the normal; the rest of the force is given
  all,     ///< all three displacements
};

/// The compliance among a few surface points, and the Cholesky factor of what is held of it.
///
/// Displacements of the points are u = A f, A = J C J^T + c I (3n x 3n), with J C J^T the body's response and c each
/// point's own softness: what holds it gives way by c f, so that the tissue itself moves by u - c f. Where another body
/// holds points, its response to them stands in place of c I. Fully held points
/// come first in the factor and stay there while they are held, so that a new contact costs one append and a lost one a
/// rank-three update; rows held along a normal are appended anew each time since normals turn. Nothing is allocated
/// after construction.
class HeldPoints {
 public:
  /// Pivots below this share of the point's own compliance (or of a typical node's) are raised to it: coincident
  /// or nearly dependent points become soft by 2 % of a node's compliance in place of singular, and the force
  /// between contradictory ones stays bounded by 50 times a single point's.
  static constexpr double kPivotShare = 0.02;

  /// `by`: of the body that holds points, if one does. Both outlive this object.
  HeldPoints(const Response& response, int capacity, const Response* by = nullptr);

  int size() const { return static_cast<int>(anchors_.size()); }
  int capacity() const { return capacity_; }
  const Anchor& anchor(int point) const { return anchors_[point]; }

  /// Becomes the last point, held by a side of softness >= 0 or by a point of the other body.
  void add(const Anchor& anchor, const ContactSide& by = ToolPoint{});
  void remove(int point);  ///< the points after it move down by one
  void clear();
  /// The body gives way otherwise than it did: after a cut, or for another step.
  void follow_response();
  /// Forgets the factor, so that the next solve() depends on nothing but the points and the arguments.
  void forget_factor();

  /// Compliance [m/N] of point i to forces at point j.
  Eigen::Matrix3d block(int i, int j) const;
  /// The compliance below which a pivot is raised, for a point whose own compliance is given [m/N].
  double floor_of(double own) const;
  /// Adds the response of all points to a change of one point's force [N] to their displacements [m] (3n).
  void add_response(int point, const Eigen::Vector3d& change, double* displacement) const;
  /// Displacements [m] of all points (3n) under forces [N] at all points (3n).
  void displacements(const double* forces, double* displacement);

  /// Forces f (3n) such that held displacements are met: on entry f holds the given part of the forces (friction of
  /// points held along their normal, zero elsewhere); on return the whole. `hold`, `normal`, `target`
  /// (displacement [m]) have one entry per point. Returns how many pivots were raised.
  int solve(std::span<const Hold> hold, std::span<const Eigen::Vector3d> normal,
            std::span<const Eigen::Vector3d> target, double* forces);

 private:
  double* column(int dof) { return a_.data() + stride_ * dof; }
  const double* column(int dof) const { return a_.data() + stride_ * dof; }
  void fill(int point);
  void keep_full(std::span<const Hold> hold);
  int append_full(int point);
  int append_normal(int point, std::span<const Eigen::Vector3d> normal);

  const Response& response_;
  const Response* by_;
  int capacity_;
  std::ptrdiff_t stride_;
  std::vector<Anchor> anchors_;
  std::vector<ContactSide> sides_;  ///< per point: what holds it
  std::vector<double> a_;           ///< A, column-major, both triangles
  kernels::Buffer factor_;
  std::vector<int> full_;     ///< fully held points in the order of the factor
  std::vector<int> raised_;   ///< pivots raised when full_[i] was appended
  std::vector<int> normals_;  ///< points held along their normal, in the order of the factor
  kernels::Buffer rows_, rhs_, given_, scratch_;
  std::vector<const double*> columns_;  ///< of A, for displacements()
};

}  // namespace palpate
