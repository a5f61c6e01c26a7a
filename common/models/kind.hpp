#pragma once
#include <Eigen/Core>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "common/fem/progress.hpp"

namespace palpate {

struct Appearance;
struct Archive;
struct CheckReport;
struct CheckSettings;
struct DirectProblem;
struct FreeVibration;
struct NamedSpec;
struct MeshedSpec;
struct MovingSpec;
struct ShellMesh;
struct ShellSpec;
struct SolidSpec;
struct StaticField;
struct StepSettings;
struct SurfaceMap;
struct VisualSpec;
class BodyPart;
class BodyShape;
class Description;
class DynamicOrgan;

/// What programs ask of every kind of tissue are functions of its spec, declared beside it and defined in the kind's
/// folder; a function of a base serves the kinds that derive from it, unless they have their own. Programs call them by
/// std::visit on a Body, and know of no kind otherwise.

// What it is.

/// owner(spec): which node keeps the body's state and advances it.
enum class Owner { haptic_node, deform_node };
constexpr Owner owner(const NamedSpec&) {
  return Owner::haptic_node;
}
constexpr Owner owner(const MovingSpec&) {
  return Owner::deform_node;
}

/// has_task(spec): whether the haptic node measures a task on it, and tells a TaskRecord.
constexpr bool has_task(const NamedSpec&) {
  return false;
}

/// has_static_states(spec): whether it comes to rest where its nodes are held.
constexpr bool has_static_states(const NamedSpec&) {
  return true;
}

/// moving_gravity(spec): [m/s^2] on tissue that moves; zero for all else.
inline Eigen::Vector3d moving_gravity(const NamedSpec&) {
  return Eigen::Vector3d::Zero();
}
Eigen::Vector3d moving_gravity(const MovingSpec& body);

/// absence(spec): what programs leave out where a scene has no such body; kinds with the same sentence are left out
/// together.
constexpr std::string_view absence(const NamedSpec&) {
  return {};
}
constexpr std::string_view absence(const MovingSpec&) {
  return "no dynamic body: no masses, no cutting, no topology topic";
}
constexpr std::string_view absence(const ShellSpec&) {
  return "no shell: no modes";
}

/// appearance(spec, surface): how it looks. `surface`: at rest.
Appearance appearance(const NamedSpec& body, const SurfaceMap& surface);
Appearance appearance(const ShellSpec& body, const SurfaceMap& surface);

/// visual_of(spec): what is drawn in place of its own surface; null: nothing else is.
constexpr const VisualSpec* visual_of(const NamedSpec&) {
  return nullptr;
}
const VisualSpec* visual_of(const SolidSpec& body);

// Its archive.

/// mesh_file(spec): the mesh beside which its archive lies; empty for a body without a mesh, which has no file.
std::filesystem::path mesh_file(const NamedSpec& body);
std::filesystem::path mesh_file(const MeshedSpec& body);

/// stores_inertia(spec): whether density and gravity count for what is in the archive.
constexpr bool stores_inertia(const NamedSpec&) {
  return true;
}

/// archive_job(spec, progress): loads the body's meshes, of which the job computes the archive. Throws
/// std::runtime_error on a bad mesh, the job on a bad body or too little memory. Empty for a body without a mesh.
using ArchiveJob = std::function<Archive()>;

/// archive_lines(spec, archive): what `palpate precompute` says of the archive beside its size, a sentence a line.
inline std::vector<std::string> archive_lines(const NamedSpec&, const Archive&) {
  return {};
}
std::vector<std::string> archive_lines(const MovingSpec& body, const Archive& archive);

/// made_archive(spec): the archive of a body without a mesh, for which there is no file; empty for all others.
std::optional<Archive> made_archive(const MeshedSpec& body);

/// fit_archive(spec, archive): makes of an archive that serves several bodies (archive_hash()) that of this one.
inline void fit_archive(const NamedSpec&, Archive&) {}
void fit_archive(const MeshedSpec& body, Archive& archive);

// What it becomes at run time.

/// make_haptic_part(spec, archive, settings): what the haptic step knows of the body; null for moving tissue, whose
/// state the deformation node owns. `archive` is read with ArchivePart::touchable.
std::unique_ptr<BodyPart> make_haptic_part(const MovingSpec& body, const Archive& archive,
                                           const StepSettings& settings);

/// make_shape(spec, archive, settings): its visible surface as it follows from what the haptic node says of the body.
/// `archive` is read with ArchivePart::surface; `settings`: of the haptic step.
std::unique_ptr<BodyShape> make_shape(const MovingSpec& body, const Archive& archive, const StepSettings& settings);

/// make_organ(spec, archive, settings): the body as the deformation node advances it; null for a body that the haptic
/// step owns. Throws std::runtime_error naming the body if the scene's step is not stable.
std::unique_ptr<DynamicOrgan> make_organ(const NamedSpec& body, const Archive& archive, const StepSettings& settings);

// Bodies that are led into others.

/// wall_of(spec): the body as a wall into which others may be led; null if it is none.
constexpr const ShellSpec* wall_of(const NamedSpec&) {
  return nullptr;
}
constexpr const ShellSpec* wall_of(const ShellSpec& body) {
  return &body;
}

/// Another body of a scene, as a description looks at it.
struct Neighbour {
  std::string_view kind;
  const ShellSpec* wall;  ///< null if it is none
};
using FindNeighbour = std::function<std::optional<Neighbour>(const std::string& name)>;

/// require_neighbours(d, place, spec, find): what it asks of the scene's other bodies. `place`: of its keys, "body.0".
inline void require_neighbours(Description&, const std::string& /*place*/, const NamedSpec&, const FindNeighbour&) {}

/// check_guest(spec, wall, mesh): where it is led into that wall, whether it can be. Throws
/// std::runtime_error("FILE: reason"), FILE being the wall's mesh.
inline void check_guest(const NamedSpec&, const ShellSpec&, const ShellMesh&) {}

// What tools say and compute of it.

/// check(spec, settings, report): what `palpate check` says of the body; see common/models/check/check.hpp. Throws
/// std::runtime_error on a body that cannot be run.

/// locking_warnings(spec): a sentence where Poisson's ratio makes its linear elements lock, with the cure.
std::vector<std::string> locking_warnings(const MovingSpec& body);

/// direct_problem(spec): its static states, solved on its full system. Throws std::runtime_error for a body that has
/// none of tetrahedra.
DirectProblem direct_problem(const NamedSpec& body);
DirectProblem direct_problem(const SolidSpec& body);
DirectProblem direct_problem(const MovingSpec& body);

/// vibration(spec): how it swings freely about its rest shape.
FreeVibration vibration(const MovingSpec& body);

/// static_correction(spec): what is done to a linear static state with the archive's help; returns the factor of the
/// forces. Empty: nothing.
using StaticCorrection = std::function<double(const Archive& archive, const StaticField& state)>;
inline StaticCorrection static_correction(const NamedSpec&) {
  return {};
}

}  // namespace palpate
