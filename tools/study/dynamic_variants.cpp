#include "common/fem/refine_graded.hpp"
#include "common/models/hybrid/hybrid_split.hpp"
#include "tools/study/kinds.hpp"

namespace palpate::study {

void name_anew(SolidSpec& solid, const StaticProblem& finer) {
  solid.fixed.clear();
  for (int axis = 0; axis < 3; ++axis) {
    BoundaryCondition region;
    region.axes = {axis == 0, axis == 1, axis == 2};
    for (int n = 0; n < static_cast<int>(finer.mesh.nodes.size()); ++n)
      if (finer.dofs.index(n, axis) == DofMap::kFixed) region.where.indices.push_back(n);
    if (!region.where.indices.empty()) solid.fixed.push_back(std::move(region));
  }
  solid.materials.clear();
  for (std::size_t m = 1; m < finer.materials.materials.size(); ++m) {
    MaterialRegion region;
    region.material = finer.materials.materials[m];
    for (std::size_t t = 0; t < finer.materials.of_element.size(); ++t)
      if (finer.materials.of_element[t] == m) region.where.indices.push_back(static_cast<int>(t));
    if (!region.where.indices.empty()) solid.materials.push_back(std::move(region));
  }
  solid.touchable.reset();
}

FinerBody finer_body(const Body& body, const StaticProblem& problem, double share_of_edge) {
  const double size = share_of_edge * mean_edge(problem.mesh);
  StaticProblem fine = refine_graded(
      problem, [=](const Eigen::Vector3d&) { return size; }, 60000);
  FinerBody finer{body, {}};
  std::visit([&](auto& spec) { name_anew(spec, fine); }, finer.body);
  finer.mesh = std::move(fine.mesh);
  return finer;
}

std::vector<int> grown_part(const HybridSpec& body, const TetMesh& mesh, int layers) {
  std::vector<char> in(mesh.tetrahedra.size(), 0);
  for (const int t : dynamic_elements(body, mesh)) in[t] = 1;
  for (int layer = 0; layer < std::abs(layers); ++layer) {
    const char spreading = layers > 0 ? 1 : 0;
    std::vector<char> touched(mesh.nodes.size(), 0);
    for (std::size_t t = 0; t < in.size(); ++t)
      for (const int n : mesh.tetrahedra[t]) touched[n] |= in[t] == spreading;
    for (std::size_t t = 0; t < in.size(); ++t)
      for (const int n : mesh.tetrahedra[t])
        if (touched[n]) in[t] = spreading;
  }
  std::vector<int> part;
  for (int t = 0; t < static_cast<int>(in.size()); ++t)
    if (in[t]) part.push_back(t);
  return part;
}

}  // namespace palpate::study
