#pragma once
#include <span>
#include <vector>

#include "common/tool/spec.hpp"

namespace palpate {

/// A part of a tool that presses by a patch of its own.
struct PatchPart {
  int tool, part;
  double radius;  ///< [m]
  double length;  ///< [m] 0: a sphere
};

/// The balls at tips and, where `shafts`, the tools' shafts. Jaws press by the mesh.
std::vector<PatchPart> patch_parts(std::span<const Tool> tools, bool shafts);

}  // namespace palpate
