#pragma once
#include <Eigen/Core>
#include <array>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "common/fem/static_loads.hpp"

namespace palpate {

/// A point of the surface and where it is taken: `--touch "x,y,z:dx,dy,dz"`; an empty component is not held.
struct TouchArgument {
  Eigen::Vector3d point;                              ///< [m]
  std::array<std::optional<double>, 3> displacement;  ///< [m]
};

/// Numbers of the mesh nodes of a group. Throws std::runtime_error where there is none of that name.
using GroupNodes = std::function<std::vector<int>(const std::string& name)>;

/// Parses `--hold "NODE:ux,uy,uz"`, one constraint per component given; with `group` also "GROUP:ux,uy,uz", one per
/// node and component. Throws std::runtime_error on anything that is not a number, and if no component is given.
std::vector<Constraint> parse_hold(const std::string& text, const GroupNodes& group = {});

TouchArgument parse_touch(const std::string& text);

/// All holds together. Throws std::runtime_error if an axis of a node is held twice or a node is not in the
/// mesh.
std::vector<Constraint> parse_holds(const std::vector<std::string>& texts, int mesh_nodes,
                                    const GroupNodes& group = {});

/// Parses `--force "NODE:fx,fy,fz"`. Throws std::runtime_error as parse_holds does; a node may have several.
std::vector<NodalLoad> parse_forces(const std::vector<std::string>& texts, int mesh_nodes);

/// Parses `--pressure "GROUP:p"` [Pa], positive where it presses on the tissue: on each triangle of the surface, all of
/// whose corners are in the group, against its normal. Throws std::runtime_error on anything that is not a number, and
/// where the group has no triangle of the surface.
std::vector<SurfacePressure> parse_pressure(const std::string& text, const std::vector<std::array<int, 3>>& triangles,
                                            const GroupNodes& group);

/// The bilateral barycentric rule: the surface point nearest to the touch moves by its displacement.
/// Triangles index `position`; `node_number` gives mesh node numbers.
std::vector<Constraint> touch_constraints(const TouchArgument& touch, const std::vector<Eigen::Vector3d>& position,
                                          const std::vector<int>& node_number,
                                          const std::vector<std::array<int, 3>>& triangles);

}  // namespace palpate
