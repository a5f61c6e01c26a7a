#pragma once
#include <Eigen/Core>
#include <algorithm>
#include <array>

namespace palpate {

/// Of the arrays of messages and states.
inline Eigen::Map<const Eigen::Vector3d> vector(const std::array<double, 3>& of) {
  return Eigen::Map<const Eigen::Vector3d>(of.data());
}

/// Into them.
inline void copy(const Eigen::Vector3d& from, std::array<double, 3>& to) {
  std::copy_n(from.data(), 3, to.begin());
}

/// By rows.
inline void copy(const Eigen::Matrix3d& from, std::array<double, 9>& to) {
  Eigen::Map<Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(to.data()) = from;
}

}  // namespace palpate
