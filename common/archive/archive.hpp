#pragma once
#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "common/archive/condensed_tensors.hpp"
#include "common/archive/pressed_place.hpp"

namespace palpate {

class CompressedCompliance;

/// Geometry and numbering of the nodes in a body's archive. Nodes 0 .. touchable-1 are the touchable ones (on the
/// surface, at least one free axis), the other surface nodes follow, and where a part of the body moves with inertia
/// the remaining nodes of that part's tetrahedra; each group ascends in mesh node number.
struct SurfaceMap {
  std::vector<Eigen::Vector3d> position;      ///< [m] rest position per surface node
  std::vector<int> node_number;               ///< mesh node number per surface node
  std::vector<std::array<bool, 3>> fixed;     ///< per surface node and axis
  std::vector<std::array<int, 3>> triangles;  ///< surface node indices, outward
  int touchable = 0;

  int size() const { return static_cast<int>(position.size()); }
};

/// Lowest modes of a shell about its rest shape, K phi = omega^2 M phi with phi^T M phi = 1, rotations condensed
/// (BHS01 eq. 16, 19).
struct ModalTensors {
  double thickness = 0;       ///< [m]
  std::vector<double> omega;  ///< [rad/s] ascending
  std::vector<double> shape;  ///< [kg^-1/2] column-major, 3 * surface nodes x modes; rows of fixed axes are zero
  std::vector<double> mass;   ///< [kg] lumped, per surface node

  int modes() const { return static_cast<int>(omega.size()); }
  bool operator==(const ModalTensors&) const = default;
};

/// What an archive has beside a surface and its compliance, as the kind of tissue says; its data must agree.
struct ArchiveParts {
  bool dynamic = false;    ///< tetrahedra that move with inertia
  bool condensed = false;  ///< tensors that join them to a quasi-static part
  bool modal = false;      ///< modes
};

/// Tensors of one body as stored in the HDF5 archive. Compliance only: T^f_k = C_kk^-1 and
/// T^u_nk = C_nk C_kk^-1 (TVCG99 sec. 4-1) are views computed from it. Bodies that move with inertia have their
/// tetrahedra in place of a compliance; hybrid ones have both, each for its part.
struct Archive {
  std::string body;
  std::string model;  ///< the kind of tissue, as a scene names it
  ArchiveParts parts;
  std::string content_hash;  ///< over mesh, material, boundary conditions, touchable set and format version; in a
                             ///< file but for a factor common to all of `young`
  std::string software;      ///< version that computed it
  int mesh_nodes = 0;        ///< nodes in the mesh file
  std::vector<double> young, poisson;  ///< [Pa], [1]: the body's material, then one per material region
  std::vector<double> density;         ///< [kg/m^3] likewise; empty for a quasi-static body
  /// Index into those per tetrahedron (of the mesh; of `tetrahedra` where there are any); empty: all have the first.
  std::vector<std::uint16_t> material_of_element;
  SurfaceMap surface;
  /// [m] By how much its dead loads and its weight move each node of a body that is solved beforehand; empty: it has
  /// none. Once read for a body (fit_archive) they are in the surface's positions, from which all displacements count.
  std::vector<Eigen::Vector3d> sag;
  std::vector<Eigen::Vector3d> load;           ///< [N] dead load per node of what moves with inertia; empty: none
  std::vector<std::array<int, 4>> tetrahedra;  ///< those that move with inertia: surface nodes, positively oriented
  std::vector<Dof> moving_dofs;                ///< free dofs of the touchable nodes, ascending, where there are any
  /// Compliance at rest of such a body as a whole among those dofs, packed like C_tt [m/N].
  std::vector<double> moving_compliance;
  std::vector<Dof> touchable_dofs;  ///< free dofs of touchable nodes (hybrid: those among i), ascending
  std::vector<Dof> other_dofs;      ///< free dofs of the remaining visible nodes (hybrid: those among i)
  /// C_tt, packed lower triangle by rows: entry (i,j), j <= i, at i(i+1)/2 + j.  [m/N]
  std::vector<double> touchable_compliance;
  /// C_ot, row-major, other_dofs x touchable_dofs [m/N]; empty when every visible free node is touchable
  std::vector<double> other_compliance;
  /// C_tt and C_ot in place of the two above, where that is smaller; else null.
  std::shared_ptr<const CompressedCompliance> compressed;
  /// Slopes of the linear model's specimen curves where the scene names a specimen mesh, else 0.
  double specimen_force_slope = 0;    ///< [N/m]
  double specimen_radial_slope = 0;   ///< [1]
  std::vector<PressedPlace> presses;  ///< empty unless the scene asks for them
  std::optional<CondensedTensors> condensed;
  std::optional<ModalTensors> modal;  ///< of a shell, beside the static compliance of its nodes
};

/// Changes with every change of the layout or of the meaning of a stored number.
constexpr int kArchiveFormat = 11;

/// Writes to a temporary name beside `file`, syncs and renames, so that `file` is at every moment either
/// whole or as it was. Removes temporary files that killed writers of the same body left. Throws
/// std::runtime_error on failure (a full disk, say), leaving nothing.
void write_archive(const Archive& archive, const std::filesystem::path& file);

/// Which part of an archive to read: the header with maps, tetrahedra, material and frequencies, C_tt and mode shapes
/// as well (all that the haptic node needs), or everything. What is not asked for is not read.
enum class ArchivePart { header, touchable, surface };

/// Throws std::runtime_error("FILE: reason") if the file is truncated, foreign, of another format version, or
/// its content hash is not `expected_hash` (checked unless empty), or a dataset fails its checksum.
Archive read_archive(const std::filesystem::path& file, ArchivePart part, const std::string& expected_hash);

}  // namespace palpate
