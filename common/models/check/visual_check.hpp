#pragma once
#include "common/fem/solid_spec.hpp"
#include "common/mesh/tet_mesh.hpp"
#include "common/models/check/check.hpp"

namespace palpate {

/// Of a visual surface: what a picture has time for, 60 times a second.
inline constexpr std::size_t kFluentTriangles = 16000;

/// Says what a body's visual surface consists of and how it lies about the body's mesh, and warns where that is hardly
/// meant. Nothing for a body without one. Throws as load_visual_mesh() and read_png_bytes().
void check_visual(const SolidSpec& body, const TetMesh& mesh, CheckReport& report);

}  // namespace palpate
