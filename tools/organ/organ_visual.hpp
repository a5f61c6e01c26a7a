#pragma once
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "common/mesh/visual_mesh.hpp"
#include "tools/organ/label_solid.hpp"

namespace palpate {

/// The surface of labels as it is looked at, of about so many triangles, in the image's frame [m]: a part for each
/// label on it. The first label has no colour, so that the scene's tissue colour is its own; others have one by their
/// name.
VisualMesh visual_of(const LabelSolid& solid, const std::vector<NamedLabel>& labels, int triangles);

/// OBJ in millimetres, and its MTL beside it. Throws std::runtime_error("FILE: sentence").
void write_visual(const VisualMesh& mesh, const std::filesystem::path& file);

}  // namespace palpate
