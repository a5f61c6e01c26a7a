#pragma once
#include <filesystem>

#include "common/node/node_setup.hpp"
#include "render_node/stage.hpp"

namespace palpate {

/// The bodies of a scene at rest before its backdrop. Throws std::runtime_error if that cannot be read.
Stage make_stage(const LoadedScene& loaded);

/// A picture (PNG) of a stage, with smooth edges. Throws as write_png().
void write_still(const Stage& stage, int width, int height, const std::filesystem::path& file);

}  // namespace palpate
