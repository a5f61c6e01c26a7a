#include "common/mesh/visual_mesh.hpp"

#include <fmt/format.h>

#include <map>
#include <stdexcept>

#include "common/files/ending.hpp"
#include "common/mesh/mesh_file.hpp"
#include "common/mesh/obj_file.hpp"

namespace palpate {
namespace {

VisualMesh of_one_material(const TriangleMesh& surface, const Eigen::Vector3d& origin, const std::string& file) {
  if (surface.triangles.size() > kMaxVisualTriangles)
    throw std::runtime_error(fmt::format("{}: it has {} triangles, and a visual surface has {} at most", file,
                                         surface.triangles.size(), kMaxVisualTriangles));
  VisualMesh mesh;
  for (const Eigen::Vector3d& p : surface.nodes) mesh.position.emplace_back((p - origin).cast<float>());
  mesh.image.assign(mesh.position.size(), Eigen::Vector2f::Zero());
  VisualMesh::Part& part = mesh.parts.emplace_back();
  part.count = static_cast<int>(mesh.position.size());
  part.triangles = surface.triangles;
  join_places(mesh);
  return mesh;
}

}  // namespace

void join_places(VisualMesh& mesh) {
  std::map<std::array<float, 3>, int> node_at;
  mesh.node.clear();
  for (const Eigen::Vector3f& p : mesh.position)
    mesh.node.push_back(node_at.try_emplace({p.x(), p.y(), p.z()}, static_cast<int>(node_at.size())).first->second);
  mesh.nodes = static_cast<int>(node_at.size());
}

VisualMesh load_visual_mesh(const VisualSpec& spec, const Eigen::Vector3d& origin) {
  const bool is_obj = has_ending(spec.surface, ".obj");
  if (!is_obj && !(spec.materials.empty() && spec.texture.empty()))
    throw std::runtime_error(spec.surface.string() + ": only an OBJ has materials and texture coordinates");
  if (!is_obj) return of_one_material(load_triangle_mesh(spec.surface, spec.scale), origin, spec.surface.string());
  std::optional<ObjMaterials> materials;
  if (!spec.materials.empty()) materials = load_mtl(spec.materials);
  return load_obj(spec.surface, spec.scale, materials, !spec.texture.empty(), origin);
}

}  // namespace palpate
