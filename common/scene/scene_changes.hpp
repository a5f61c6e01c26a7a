#pragma once
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "common/scene/scene.hpp"

namespace palpate {

/// A key of a scene, and what stands in the place of what its file says: "body.young" and "8000".
struct SceneChange {
  /// The table's names, then the key's, dots between them. An entry of a list follows the list's name by its own name
  /// or its number from 0 ("tool.probe.radius", "body.0.young"), and is left out where there is only one.
  std::string key;
  std::string value;  ///< as TOML writes it; a single word may go without its quotes

  std::string argument() const { return key + "=" + value; }
};

/// Reads "body.young=8000". Throws std::runtime_error in one sentence.
SceneChange parse_change(std::string_view argument);

std::vector<SceneChange> parse_changes(std::span<const std::string> arguments);

/// load_scene() of the file with these changes, which are checked as if the file had them; what is wrong with one is
/// said as "--set body.young=-1: sentence".
Scene load_scene(const std::filesystem::path& file, std::span<const SceneChange> changes);

}  // namespace palpate
