#pragma once
#include <cstdint>
#include <filesystem>
#include <set>
#include <string>

#include "common/scene/scene.hpp"

namespace palpate {

/// What has to be known of a log before it is drawn.
struct LogContents {
  std::set<std::string> topics;    ///< that it has samples of
  double seconds = 0;              ///< from its first sample to its last
  double scene_begin = 0;          ///< [s] after its first sample: the first step of the scene, before it too
  std::set<std::uint32_t> shaped;  ///< bodies whose surfaces it has
};

/// `scene`: the log's. Throws std::runtime_error if the file is no log.
LogContents contents_of(const std::filesystem::path& log, const Scene& scene);

}  // namespace palpate
