#include "common/archive/archive.hpp"

#include "common/archive/compressed_compliance.hpp"
#include "common/scene/ensure_archive.hpp"
#include "common/scene/find_archive.hpp"
#include "python/bindings.hpp"

namespace palpate::python {
namespace {

Archive archive_of(const Scene& scene, const std::string& body_name) {
  const Body& body = body_of(scene, body_name);
  ensure_archive(scene, body);
  return find_archive(scene, body, ArchivePart::surface);
}

/// Numbers of dofs, node (as a row of the surface map) and axis, one a row.
py::array_t<int> dofs(const std::vector<Dof>& dofs) {
  auto array = new_array<int>(static_cast<py::ssize_t>(dofs.size()), 2);
  int* to = array.mutable_data();
  for (const Dof& dof : dofs) {
    *to++ = dof.node;
    *to++ = dof.axis;
  }
  return array;
}

/// The lower triangle of a compressed compliance by rows; a copy.
py::array_t<double> packed(const Archive& archive) {
  const std::vector<Dof>& dofs = archive.touchable_dofs;
  py::array_t<double> triangle(static_cast<py::ssize_t>(dofs.size() * (dofs.size() + 1) / 2));
  double* to = triangle.mutable_data();
  for (std::size_t i = 0; i < dofs.size(); ++i)
    for (std::size_t j = 0; j <= i; ++j)
      *to++ = archive.compressed->block(dofs[i].node, dofs[j].node)(dofs[i].axis, dofs[j].axis);
  return triangle;
}

template <class Row>
auto rows(const std::vector<Row> SurfaceMap::*member) {
  return [member](const py::object& self) { return view_of_rows(self.cast<const Archive&>().surface.*member, self); };
}

}  // namespace

void bind_archive(py::module_& module) {
  py::class_<Archive>(
      module, "Archive",
      "The stored tensors of a body: docs/archive.md. Arrays are views of its memory, read-only, and keep "
      "it alive.")
      .def(py::init(&archive_of), py::arg("scene"), py::arg("body") = "",
           "Of a body of the scene; computed first if it is not there.")
      .def_readonly("body", &Archive::body, "name")
      .def_readonly("model", &Archive::model, "the kind of tissue, as a scene names it")
      .def_readonly("content_hash", &Archive::content_hash, "over all that the stored numbers depend on")
      .def_property_readonly(
          "touchable", [](const Archive& a) { return a.surface.touchable; },
          "how many nodes, the first ones of the surface map, a contact may hold")
      .def_property_readonly("position", rows(&SurfaceMap::position), "(n, 3) [m] at rest")
      .def_property_readonly("triangles", rows(&SurfaceMap::triangles), "(m, 3) rows of position, outward")
      .def_property_readonly(
          "node", [](const py::object& self) { return view_of(self.cast<const Archive&>().surface.node_number, self); },
          "(n,) each node's number in the mesh file")
      .def_property_readonly(
          "dofs", [](const Archive& a) { return dofs(a.touchable_dofs); },
          "(k, 2) row of position and axis of each free dof of a touchable node; a copy")
      .def_property_readonly(
          "compliance",
          [](const py::object& self) {
            const auto& archive = self.cast<const Archive&>();
            return archive.compressed ? packed(archive) : view_of(archive.touchable_compliance, self);
          },
          "(k (k + 1) / 2,) [m/N] among dofs, the lower triangle by rows: entry (i, j), j <= i, at i (i + 1) / 2 + j; "
          "of compressed tensors a copy, as large as the dense ones would be")
      .def_property_readonly(
          "compressed", [](const Archive& a) { return a.compressed != nullptr; },
          "whether far blocks of the compliance are kept as products of low rank");
}

}  // namespace palpate::python
