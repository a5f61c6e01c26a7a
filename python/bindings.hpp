#pragma once
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <span>

namespace palpate::python {

namespace py = pybind11;

void bind_log(py::module_& module);
void bind_simulator(py::module_& module);

/// A new array of `rows` times `columns` numbers, or of `rows` where columns is 0.
template <class T>
py::array_t<T> new_array(py::ssize_t rows, py::ssize_t columns) {
  return columns == 0 ? py::array_t<T>(rows) : py::array_t<T>(std::vector<py::ssize_t>{rows, columns});
}

/// A copy of vectors, one a row.
template <class Vector>
auto rows_of(std::span<const Vector> vectors) {
  using T = typename Vector::value_type;
  constexpr std::size_t kColumns = sizeof(Vector) / sizeof(T);
  auto array = new_array<T>(static_cast<py::ssize_t>(vectors.size()), kColumns);
  T* to = array.mutable_data();
  for (const Vector& v : vectors) to = std::copy_n(v.data(), kColumns, to);
  return array;
}

}  // namespace palpate::python
