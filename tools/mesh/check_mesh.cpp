#include "tools/mesh/check_mesh.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>

#include "common/contact/tool_contacts.hpp"
#include "common/fem/dense.hpp"
#include "common/fem/factorisation.hpp"
#include "common/fem/fine_stiffness.hpp"
#include "common/fem/ordering.hpp"
#include "common/files/ending.hpp"
#include "common/mesh/measures.hpp"
#include "common/mesh/mesh_file.hpp"
#include "common/models/check/surface_check.hpp"
#include "common/models/quasi_static/free_surface.hpp"
#include "common/models/quasi_static/spec.hpp"
#include "tools/shared/human_bytes.hpp"

namespace palpate {
namespace {

constexpr double kBlockPenalty = 4;     // blocks of right-hand sides run at a quarter of the speed of dense algebra
constexpr Eigen::Index kSquare = 1000;  // the size of a product that tells this machine's speed

/// What the compliance of a surface asks for.
struct Work {
  double operations = 0;  ///< [flop] worth of dense algebra
  double factor = 0;      ///< [bytes] of the sparse factor
};

/// By the analysis of the same sparse system, with `touchable` unknowns on the surface.
Work work_of(const TetMesh& mesh, const Offline& offline, const SurfaceMap& surface, double touchable) {
  const FineSpace space = make_fine_space(mesh, offline);
  const NodeGraph graph = fine_graph(space, nullptr);
  std::vector<char> used(space.nodes.size());
  for (std::size_t n = 0; n < used.size(); ++n) used[n] = graph.begin[n + 1] > graph.begin[n];
  DofMap dofs(used);
  dofs.number();
  const bool by_blocks = is_finer(offline) || form_of(surface.touchable) == TensorForm::compressed;
  const std::vector<Eigen::Matrix3d> blocks(graph.neighbour.size(), Eigen::Matrix3d::Identity());
  const std::vector<int> last = by_blocks ? std::vector<int>{} : surface.node_number;
  const Factorisation factor(lower_triangle(blocks, dofs, graph), dof_order(dofs, interior_first_order(graph, last)));
  const auto entries = static_cast<double>(factor.factor_nonzeros());
  const double rest = by_blocks ? kBlockPenalty * 4 * entries * touchable : 2.0 / 3 * touchable * touchable * touchable;
  return {factor.flops() + rest, sizeof(double) * entries};
}

/// [flop/s] of a dense product on this machine.
double speed() {
  const Eigen::MatrixXd a = Eigen::MatrixXd::Constant(kSquare, kSquare, 0.5);
  dense_product(a, a);  // wakes its threads
  const auto begin = std::chrono::steady_clock::now();
  dense_product(a, a);
  const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - begin;
  return 2.0 * kSquare * kSquare * kSquare / taken.count();
}

void say_groups(const TetMesh& mesh, CheckOutput& out) {
  std::string names;
  for (const auto& [name, group] : mesh.groups)
    names += fmt::format("{}'{}' with {} nodes", names.empty() ? "" : ", ", name, group.nodes.size());
  out.say("  groups: " + (names.empty() ? "none" : names));
}

}  // namespace

bool names_mesh(const std::filesystem::path& file) {
  constexpr std::array<const char*, 7> kEndings{".msh", ".vtk", ".stl", ".obj", ".ply", ".off", ".vtp"};
  return std::ranges::any_of(kEndings, [&](const char* ending) { return has_ending(file, ending); });
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
  const Work work = work_of(mesh, offline, surface, 3.0 * surface.size());
  out.say(fmt::format(
      "  as a quasi-static body, touchable where it is not held, {}tensors from {} elements: precompute takes about "
      "{:.2g} s on this machine ({:.3g} Gflop), and {} for its factor",
      compressed ? "compressed " : "", offline.element == FiniteElement::p1 ? "linear" : "quadratic",
      work.operations / speed(), 1e-9 * work.operations, human_bytes(static_cast<std::size_t>(work.factor))));
  out.memory(free_surface_memory(surface));
  if (const double across = measures.extent.maxCoeff(); across > kMaxBody || across < kMinBody)
    out.warn(fmt::format("{} is {:.3g} m across: is it in metres?", file.string(), across));
}

}  // namespace palpate
