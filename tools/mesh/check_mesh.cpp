#include "tools/mesh/check_mesh.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <initializer_list>

#include "common/contact/tool_contacts.hpp"
#include "common/files/ending.hpp"
#include "common/mesh/group_names.hpp"
#include "common/mesh/measures.hpp"
#include "common/mesh/mesh_file.hpp"
#include "common/models/check/surface_check.hpp"
#include "common/models/quasi_static/free_surface.hpp"
#include "common/models/quasi_static/spec.hpp"
#include "common/models/quasi_static/tensor_work.hpp"
#include "tools/shared/human_bytes.hpp"

namespace palpate {
namespace {

void say_groups(const TetMesh& mesh, CheckOutput& out) {
  std::string names;
  for (const std::string& name : group_names(mesh.groups))
    names += fmt::format("{}'{}' with {} nodes", names.empty() ? "" : ", ", name, mesh.groups.at(name).nodes.size());
  out.say("  groups: " + (names.empty() ? "none" : names));
}

bool has_one_of(const std::filesystem::path& file, std::initializer_list<const char*> endings) {
  return std::ranges::any_of(endings, [&](const char* ending) { return has_ending(file, ending); });
}

}  // namespace

bool names_mesh(const std::filesystem::path& file) {
  return has_one_of(file, {".msh", ".vtk", ".stl", ".obj", ".ply", ".off", ".vtp"});
}

bool names_image(const std::filesystem::path& file) {
  return has_one_of(file, {".inr", ".inr.gz", ".mha", ".mhd", ".nrrd", ".nhdr", ".nii", ".nii.gz", ".dcm"});
}

void check_mesh(const std::filesystem::path& file, CheckOutput& out) {
  const TetMesh mesh = load_tet_mesh(file, 1);
  const QuasiStaticSpec body;
  const SurfaceMap surface = free_surface(mesh);
  const MeshMeasures measures = measures_of(mesh);
  out.fact("mesh", file.string(), "mesh " + file.string());
  out.say(fmt::format("  {} nodes, {} tetrahedra; surface: {} nodes, {} triangles, mean edge {:.4g} m",
                      mesh.nodes.size(), mesh.tetrahedra.size(), surface.size(), surface.triangles.size(),
                      mean_edge(surface)));
  out.say(
      fmt::format("  size: {} at {:g} kg/m3", say_size(measures, kTissueDensity * measures.volume), kTissueDensity));
  out.say("  " + say_angles(measures));
  say_groups(mesh, out);
  const Offline offline = offline_of(body, surface.size());
  const bool compressed = form_of(surface.touchable) == TensorForm::compressed;
  const TensorWork work = tensor_work(mesh, surface, offline);
  out.say(fmt::format(
      "  as a quasi-static body, touchable where it is not held, {}tensors from {} elements: precompute takes "
      "{} ({:.3g} Gflop), and {} for its factor",
      compressed ? "compressed " : "", offline.element == FiniteElement::p1 ? "linear" : "quadratic",
      time_of(work).words, 1e-9 * work.operations, human_bytes(static_cast<std::size_t>(work.factor_bytes))));
  out.memory(free_surface_memory(surface));
  if (const double across = measures.extent.maxCoeff(); across > kMaxBody || across < kMinBody)
    out.warn(fmt::format("{} is {:.3g} m across: is it in metres?", file.string(), across));
}

}  // namespace palpate
