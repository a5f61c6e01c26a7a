#pragma once
#include "common/mesh/shell_mesh.hpp"
#include "tools/study/method.hpp"

namespace palpate::study {

/// A thin wall by its lowest modes, pressed through the haptic step: how many of them, with and without
/// residual flexibility; against all modes on the same mesh and many on a refined one.
std::unique_ptr<Method> make_modal(const Scene& scene, int body, bool quick);

/// Every triangle cut into four; nodes keep their numbers. A new node belongs to a group if both ends of its
/// edge do.
ShellMesh refine(const ShellMesh& mesh);

}  // namespace palpate::study
