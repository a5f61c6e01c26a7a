#pragma once
#include <Eigen/Core>
#include <algorithm>
#include <array>

namespace palpate {

/// Into the arrays of messages and states.
inline void copy(const Eigen::Vector3d& from, std::array<double, 3>& to) {
  std::copy_n(from.data(), 3, to.begin());
}

/// By rows.
inline void copy(const Eigen::Matrix3d& from, std::array<double, 9>& to) {
  Eigen::Map<Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(to.data()) = from;
}

}  // namespace palpate
