#pragma once
#include <string>
#include <vector>

#include "common/archive/archive.hpp"
#include "common/scene/scene.hpp"
#include "tools/footprint.hpp"

namespace palpate {

/// Loads and validates a modal_shell body's mesh and what refers to it, and prints the wall and its modes;
/// those frequencies are known where the archive is there. Throws std::runtime_error.
SurfaceMap check_shell_body(const Scene& scene, const Body& body);

/// What a shell takes.
std::vector<MemoryPart> shell_memory(const Scene& scene, const Body& body, const SurfaceMap& surface);

/// Validates a catheter and prints its springs and how they are integrated. Throws std::runtime_error if it
/// is too stiff for the integrator that the scene chooses, or sticks in the wall of its duct at rest.
void check_catheter(const Scene& scene, const CatheterSpec& body);

/// What is legal but likely not meant: a wall thicker than its mesh is fine, a catheter with gaps between its
/// particles, or one so stiff that it asks for many substeps.
std::vector<std::string> shell_warnings(const ShellSpec& body, const SurfaceMap& surface);
std::vector<std::string> catheter_warnings(const Scene& scene, const CatheterSpec& body);

}  // namespace palpate
