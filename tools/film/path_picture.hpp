#pragma once
#include <string>

namespace palpate {

struct PathPictureSettings {
  std::string scene, trajectory, picture;
  std::string tool;  ///< empty: the only one
};

/// Draws (PNG) where a trajectory leads the tip of a tool, over the scene at rest, with a ball at each place where it
/// stands; the tool is at its end. Archives that are not there are computed. Throws std::runtime_error.
void draw_path(const PathPictureSettings& settings);

}  // namespace palpate
