#pragma once
#include <array>
#include <filesystem>
#include <map>
#include <optional>
#include <string>

#include "common/mesh/visual_mesh.hpp"

namespace palpate {

/// What an MTL file says of a material here.
struct ObjMaterial {
  std::optional<std::array<double, 3>> colour;  ///< Kd, linear RGB
  bool textured = false;                        ///< it has a map_Kd
  std::string image;                            ///< the file that this names
};
using ObjMaterials = std::map<std::string, ObjMaterial, std::less<>>;

/// Throws std::runtime_error("FILE:LINE: sentence").
ObjMaterials load_mtl(const std::filesystem::path& file);

/// Reads vertices, texture coordinates, faces and `usemtl` of a Wavefront OBJ; normals, smoothing groups and the names
/// of objects and groups are passed over, as are lines, points and curves. A face of more than three corners becomes a
/// fan. `scale` [m per unit]; `materials`: empty: any name will do, and faces with texture coordinates wear the image.
/// `image`: whether there is one; positions from `origin` [m] on. Throws std::runtime_error("FILE:LINE: sentence").
VisualMesh load_obj(const std::filesystem::path& file, double scale, const std::optional<ObjMaterials>& materials,
                    bool image, const Eigen::Vector3d& origin = Eigen::Vector3d::Zero());

/// The same mesh as OBJ, its positions and texture coordinates rounded to `digits` places; `usemtl` for parts with a
/// name. Throws std::runtime_error("FILE: sentence").
void write_obj(const VisualMesh& mesh, const std::filesystem::path& file, double metres_per_unit, int digits);
/// Kd for each part with a colour, map_Kd for each that is textured.
void write_mtl(const VisualMesh& mesh, const std::filesystem::path& file, const std::string& image);

}  // namespace palpate
