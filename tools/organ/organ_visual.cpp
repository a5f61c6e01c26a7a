#include "tools/organ/organ_visual.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <string_view>

#include "common/mesh/obj_file.hpp"
#include "common/mesh/surface.hpp"

namespace palpate {
namespace {

struct Hue {
  std::string_view word;
  std::array<double, 3> colour;  ///< linear RGB
};
constexpr std::array<double, 3> kPale{0.46, 0.24, 0.20};
constexpr Hue kHues[] = {{"gall", {0.16, 0.20, 0.075}},  {"bile", {0.26, 0.27, 0.10}},  {"duct", {0.26, 0.27, 0.10}},
                         {"vein", {0.10, 0.075, 0.16}},  {"vena", {0.10, 0.075, 0.16}}, {"portal", {0.10, 0.075, 0.16}},
                         {"arter", {0.42, 0.05, 0.04}},  {"aorta", {0.42, 0.05, 0.04}}, {"kidney", {0.30, 0.09, 0.07}},
                         {"spleen", {0.22, 0.05, 0.07}}, {"tumo", {0.52, 0.42, 0.30}},  {"bone", {0.80, 0.68, 0.54}}};

std::array<double, 3> colour_of(std::string name) {
  std::ranges::transform(name, name.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  const auto* hue = std::ranges::find_if(kHues, [&](const Hue& h) { return name.find(h.word) != name.npos; });
  return hue == std::end(kHues) ? kPale : hue->colour;
}

/// Only its surface counts: large edges inside, and no bettering.
FilledSolid shell_of(const Solid& solid, double edge) {
  const double deviation = std::min(0.25 * edge, 0.25 * solid.wall.thickness);
  return fill_solid(solid, {edge, 8 * edge, deviation, {}}, false);
}

}  // namespace

VisualMesh visual_of(const LabelSolid& solid, const std::vector<NamedLabel>& labels, int triangles) {
  double edge = std::sqrt(2.3 * solid.measures.area / triangles);  // even triangles of that edge
  FilledSolid filled = shell_of(solid.solid, edge);
  Surface surface = extract_surface(filled.mesh);
  edge *= std::sqrt(static_cast<double>(surface.triangles.size()) / triangles);
  filled = shell_of(solid.solid, edge);
  surface = extract_surface(filled.mesh);

  VisualMesh mesh;
  for (std::size_t l = 0; l < labels.size(); ++l) {
    VisualMesh::Part part{.material = labels[l].name, .first = static_cast<int>(mesh.position.size())};
    if (l > 0) part.colour = colour_of(labels[l].name);
    std::vector<int> vertex(filled.mesh.nodes.size(), -1);
    for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
      if (filled.part[surface.tetrahedra[t]] != static_cast<int>(l) + 1) continue;
      auto& corners = part.triangles.emplace_back();
      for (int k = 0; k < 3; ++k) {
        int& place = vertex[surface.triangles[t][k]];
        if (place < 0) {
          place = part.count++;
          mesh.position.push_back(filled.mesh.nodes[surface.triangles[t][k]].cast<float>());
        }
        corners[k] = place;
      }
    }
    if (!part.triangles.empty()) mesh.parts.push_back(std::move(part));
  }
  mesh.image.assign(mesh.position.size(), Eigen::Vector2f::Zero());
  join_places(mesh);
  return mesh;
}

void write_visual(const VisualMesh& mesh, const std::filesystem::path& file) {
  write_obj(mesh, file, 1e-3, 3);
  write_mtl(mesh, std::filesystem::path(file).replace_extension(".mtl"), "");
}

}  // namespace palpate
