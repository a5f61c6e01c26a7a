#pragma once
#include <string_view>

#include "common/fem/assembly.hpp"
#include "common/fem/boundary_conditions.hpp"
#include "common/fem/solid_spec.hpp"
#include "common/mesh/tet_mesh.hpp"
#include "common/models/check/surface_check.hpp"

namespace palpate {

/// A body's mesh with everything that refers to it.
struct CheckedSolid {
  TetMesh mesh;
  DofMap dofs;
  MaterialField materials;
  SurfaceMap surface;
};

/// Loads and validates it. Throws std::runtime_error.
CheckedSolid load_solid(const SolidSpec& body);

/// Says what every body of tetrahedra consists of, and what it goes without. `kind`: of tissue.
void check_solid(const SolidSpec& body, std::string_view kind, const CheckedSolid& solid, const CheckSettings& settings,
                 CheckReport& report);

/// One sentence for each modulus that no tissue has.
std::vector<std::string> material_warnings(const SolidSpec& body);

/// [Pa] Young's moduli of tissue lie between: the softest fat and brain, and cortical bone.
inline constexpr double kSoftestTissue = 50, kStiffestTissue = 3e10;

/// One sentence where a body's Poisson's ratio makes its linear elements lock, with the cure.
std::vector<std::string> locking_warnings(const SolidSpec& body, const std::string& cure);

/// Where the compliance of a disc whose radius is four elements comes out a tenth too small (docs/offline.md).
inline constexpr double kLockingPoisson = 0.48;

}  // namespace palpate
