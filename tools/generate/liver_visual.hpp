#pragma once
#include <filesystem>

#include "common/mesh/visual_mesh.hpp"

namespace palpate {

/// The default organ as it is looked at, 14,000 triangles: the liver, with places in an image all around it, the gall
/// bladder in its fossa, cystic and common bile duct, hepatic artery and portal vein.
VisualMesh make_liver_visual();

/// That image: what lies below the liver's capsule. Writes a PNG; throws std::runtime_error.
void write_liver_texture(const std::filesystem::path& file);

}  // namespace palpate
