#pragma once
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <span>

#include "common/scene/scene.hpp"

namespace palpate::python {

namespace py = pybind11;

/// The scene's body of this name, or the only one where it is empty. Throws ValueError.
const Body& body_of(const Scene& scene, const std::string& name);

void bind_archive(py::module_& module);
void bind_log(py::module_& module);
void bind_simulator(py::module_& module);
void bind_solve(py::module_& module);

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

/// Memory of `owner`, which the array keeps alive and does not let be written.
template <class T>
py::array_t<T> view_of(const std::vector<T>& values, const py::object& owner) {
  py::array_t<T> array(static_cast<py::ssize_t>(values.size()), values.data(), owner);
  array.attr("setflags")(py::arg("write") = false);
  return array;
}
/// The same of vectors, one a row.
template <class Vector>
auto view_of_rows(std::span<const Vector> vectors, const py::object& owner) {
  using T = typename Vector::value_type;
  constexpr py::ssize_t kColumns = sizeof(Vector) / sizeof(T);
  const T* first = vectors.empty() ? nullptr : vectors.front().data();
  py::array_t<T> array(std::vector<py::ssize_t>{static_cast<py::ssize_t>(vectors.size()), kColumns}, first, owner);
  array.attr("setflags")(py::arg("write") = false);
  return array;
}
template <class Vector>
auto view_of_rows(const std::vector<Vector>& vectors, const py::object& owner) {
  return view_of_rows(std::span<const Vector>(vectors), owner);
}

}  // namespace palpate::python
