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

/// The balls at tips and, where `shafts`, the tools' shafts. Jaws press by the mesh, and so does a ball that is so wide
/// that it is a plate: where on the body it comes deepest is no place about which a patch could lie.
std::vector<PatchPart> patch_parts(std::span<const Tool> tools, bool shafts);

}  // namespace palpate
