#include "common/archive/compliance.hpp"

#include <sys/mman.h>

#include <Eigen/Core>
#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <new>
#include <stdexcept>

namespace palpate {
namespace {

constexpr std::size_t kAlignment = 64, kHugePage = std::size_t{2} << 20;

void* allocate_zeroed(std::size_t bytes) {
  const std::size_t alignment = bytes >= kHugePage ? kHugePage : kAlignment;
  const std::size_t rounded = (bytes + alignment - 1) / alignment * alignment;
  void* memory = std::aligned_alloc(alignment, std::max(rounded, alignment));
  if (!memory) throw std::bad_alloc();
  if (alignment == kHugePage) madvise(memory, rounded, MADV_HUGEPAGE);
  std::memset(memory, 0, rounded);
  return memory;
}

std::vector<std::ptrdiff_t> places(const std::vector<Dof>& dofs) {
  std::vector<std::ptrdiff_t> place;
  for (const auto& dof : dofs) place.push_back(3 * dof.node + dof.axis);
  return place;
}

/// Writes both triangles tile by tile, so that neither the reads nor the writes stride through memory.
template <class Scalar>
void expand_triangle(const std::vector<double>& packed, const std::vector<std::ptrdiff_t>& place, Scalar* data,
                     std::ptrdiff_t stride) {
  constexpr std::ptrdiff_t kTile = 64;
  const auto n = static_cast<std::ptrdiff_t>(place.size());
  for (std::ptrdiff_t row = 0; row < n; row += kTile)
    for (std::ptrdiff_t column = 0; column <= row; column += kTile)
      for (std::ptrdiff_t i = row; i < std::min(row + kTile, n); ++i) {
        const double* value = packed.data() + i * (i + 1) / 2;
        for (std::ptrdiff_t j = column; j <= std::min(column + kTile - 1, i); ++j) {
          data[place[j] * stride + place[i]] = static_cast<Scalar>(value[j]);
          data[place[i] * stride + place[j]] = static_cast<Scalar>(value[j]);
        }
      }
}

template <class Scalar>
void expand_rectangle(const std::vector<double>& rectangle, const std::vector<std::ptrdiff_t>& row_place,
                      const std::vector<std::ptrdiff_t>& column_place, Scalar* data, std::ptrdiff_t stride) {
  constexpr std::size_t kTile = 64;
  const std::size_t columns = column_place.size();
  for (std::size_t row = 0; row < row_place.size(); row += kTile)
    for (std::size_t column = 0; column < columns; column += kTile)
      for (std::size_t i = row; i < std::min(row + kTile, row_place.size()); ++i)
        for (std::size_t j = column; j < std::min(column + kTile, columns); ++j)
          data[column_place[j] * stride + row_place[i]] = static_cast<Scalar>(rectangle[i * columns + j]);
}

}  // namespace

template <class Scalar>
void Compliance<Scalar>::Free::operator()(Scalar* p) const {
  std::free(p);
}

template <class Scalar>
Compliance<Scalar>::Compliance(int row_nodes, int column_nodes)
    : row_nodes_(row_nodes), column_nodes_(column_nodes), stride_(stride_of(row_nodes)) {
  data_.reset(static_cast<Scalar*>(allocate_zeroed(bytes())));
}

template <class Scalar>
Compliance<Scalar> Compliance<Scalar>::at_rest(const Archive& archive) {
  const std::size_t dofs = archive.moving_dofs.size();
  if (archive.moving_compliance.size() != dofs * (dofs + 1) / 2)
    throw std::runtime_error("the archive was read without the compliance of what moves");
  Compliance result(archive.surface.touchable, archive.surface.touchable);
  expand_triangle(archive.moving_compliance, places(archive.moving_dofs), result.data_.get(), result.stride_);
  return result;
}

template <class Scalar>
Compliance<Scalar>::Compliance(const Archive& archive, Rows rows)
    : row_nodes_(rows == Rows::surface ? archive.surface.size() : archive.surface.touchable),
      column_nodes_(archive.surface.touchable),
      stride_(stride_of(row_nodes_)) {
  if (!archive.compressed) {
    expand(archive, rows);
    return;
  }
  if (rows == Rows::surface && !archive.other_dofs.empty() && !archive.compressed->has_others())
    throw std::runtime_error("the archive was read without the compliance of the untouchable surface");
  compressed_ = *archive.compressed;
}

template <class Scalar>
void Compliance<Scalar>::expand(const Archive& archive, Rows rows) {
  const std::size_t touchable = archive.touchable_dofs.size();
  if (archive.touchable_compliance.size() != touchable * (touchable + 1) / 2)
    throw std::runtime_error("the archive was read without its touchable compliance");
  if (rows == Rows::surface && archive.other_compliance.size() != archive.other_dofs.size() * touchable)
    throw std::runtime_error("the archive was read without the compliance of the untouchable surface");
  data_.reset(static_cast<Scalar*>(allocate_zeroed(bytes())));
  const auto columns = places(archive.touchable_dofs);
  expand_triangle(archive.touchable_compliance, columns, data_.get(), stride_);
  if (rows == Rows::surface)
    expand_rectangle(archive.other_compliance, places(archive.other_dofs), columns, data_.get(), stride_);
}

template <class Scalar>
void Compliance<Scalar>::clear() {
  std::memset(static_cast<void*>(data_.get()), 0, bytes());
}

template <class Scalar>
void Compliance<Scalar>::scale(double factor) {
  if (compressed_) {
    compressed_ = compressed_->scaled(factor);
    return;
  }
  const std::ptrdiff_t entries = 3 * stride_ * column_nodes_;
  for (std::ptrdiff_t i = 0; i < entries; ++i) data_[i] *= static_cast<Scalar>(factor);
}

template <class Scalar>
void Compliance<Scalar>::add_modes(std::span<const double> shape, std::span<const double> weight) {
  const auto modes = static_cast<Eigen::Index>(weight.size());
  if (modes == 0 || shape.size() % weight.size() != 0 ||
      shape.size() / weight.size() < 3 * static_cast<std::size_t>(row_nodes_))
    throw std::invalid_argument("the mode shapes do not fit the compliance");
  const Eigen::Map<const Eigen::MatrixXd> all(shape.data(), static_cast<Eigen::Index>(shape.size()) / modes, modes);
  const Eigen::Map<const Eigen::VectorXd> weights(weight.data(), modes);
  const auto rows = all.topRows(3 * row_nodes_), columns = all.topRows(3 * column_nodes_);
  Eigen::Map<Eigen::Matrix<Scalar, Eigen::Dynamic, Eigen::Dynamic>, 0, Eigen::OuterStride<>> entries(
      data_.get(), 3 * row_nodes_, 3 * column_nodes_, Eigen::OuterStride<>(stride_));
  entries += (rows * (weights.asDiagonal() * columns.transpose())).template cast<Scalar>();
}

template class Compliance<double>;
template class Compliance<float>;

}  // namespace palpate
