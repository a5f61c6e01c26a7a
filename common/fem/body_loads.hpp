#pragma once
#include <array>
#include <functional>
#include <string>
#include <vector>

#include "common/fem/static_loads.hpp"

namespace palpate {

/// Nodes of a mesh that a selector names, ascending.
using SelectNodes = std::function<std::vector<int>(const Selector& where, const std::string& place)>;

/// What the [[body.load]] of a scene are on a mesh, whose surface has these outward triangles; without weight. Throws
/// std::runtime_error where one selects no node, or a pressure no triangle.
StaticLoads body_loads(const MeshedSpec& body, const std::vector<std::array<int, 3>>& triangles,
                       const SelectNodes& select);

/// The same of a mesh of tetrahedra.
StaticLoads body_loads(const MeshedSpec& body, const TetMesh& mesh);

}  // namespace palpate
