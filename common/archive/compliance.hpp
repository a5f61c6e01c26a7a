#pragma once
#include <cstddef>
#include <memory>
#include <optional>
#include <span>

#include "common/archive/archive.hpp"
#include "common/archive/compressed_compliance.hpp"

namespace palpate {

/// Compliance for the run time. Rows and columns of fixed axes are zero, so that node i is always rows 3i..3i+2. Where
/// the archive has it compressed it is read from there, in single precision, and the archive need not live on. Else it
/// is dense, column-major and 64-byte aligned: column 3k+b holds the displacement of every row node, three entries a
/// node, per unit force [N] at touchable node k along axis b; the leading dimension is a multiple of 16.
template <class Scalar>
class Compliance {
 public:
  /// `rows`: touchable nodes only (haptic node) or the whole visible surface (deformation node).
  enum class Rows { touchable, surface };
  Compliance(const Archive& archive, Rows rows);
  /// That of a body that moves with inertia, or a part of which does, at rest, among the touchable nodes.
  static Compliance at_rest(const Archive& archive);

  int row_nodes() const { return row_nodes_; }
  int column_nodes() const { return column_nodes_; }
  std::ptrdiff_t stride() const { return stride_; }
  /// Of a dense one.
  const Scalar* column(int node, int axis) const { return data_.get() + stride_ * (3 * node + axis); }
  /// Null where it is dense.
  const CompressedCompliance* compressed() const { return compressed_ ? &*compressed_ : nullptr; }
  /// [m/N] displacement of a row node per force on a touchable one.
  Eigen::Matrix<Scalar, 3, 3> block(int node, int under) const;

  void clear();               ///< every entry of a dense one becomes zero
  void scale(double factor);  ///< every entry becomes so many times as large
  /// Of a dense one: adds sum_m weight_m phi_m phi_m^T, phi_m being column m of `shape`: column-major, 3 entries a
  /// surface node of the archive, whose fixed axes hold zeros.
  void add_modes(std::span<const double> shape, std::span<const double> weight);

  std::size_t bytes() const {
    return compressed_ ? compressed_->bytes() : sizeof(Scalar) * stride_ * 3 * column_nodes_;
  }

  /// What a dense compliance of that size will take.
  static std::ptrdiff_t stride_of(int row_nodes) { return (3 * row_nodes + 15) / 16 * 16; }
  static std::size_t bytes_of(int row_nodes, int column_nodes) {
    return sizeof(Scalar) * stride_of(row_nodes) * 3 * column_nodes;
  }

 private:
  struct Free {
    void operator()(Scalar* p) const;
  };
  Compliance(int row_nodes, int column_nodes);
  void expand(const Archive& archive, Rows rows);

  int row_nodes_ = 0, column_nodes_ = 0;
  std::ptrdiff_t stride_ = 0;
  std::unique_ptr<Scalar[], Free> data_;
  std::optional<CompressedCompliance> compressed_;
};

template <class Scalar>
Eigen::Matrix<Scalar, 3, 3> Compliance<Scalar>::block(int node, int under) const {
  if (compressed_) return compressed_->block(node, under).template cast<Scalar>();
  return Eigen::Map<const Eigen::Matrix<Scalar, 3, 3>, 0, Eigen::OuterStride<>>(column(under, 0) + 3 * node,
                                                                                Eigen::OuterStride<>(stride_));
}

extern template class Compliance<double>;
extern template class Compliance<float>;

}  // namespace palpate
