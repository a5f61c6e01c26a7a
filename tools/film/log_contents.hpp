#pragma once
#include <cstdint>
#include <filesystem>
#include <set>
#include <string>

namespace palpate {

/// What has to be known of a log before it is drawn.
struct LogContents {
  std::set<std::string> topics;    ///< that it has samples of
  double seconds = 0;              ///< from its first sample to its last
  std::set<std::uint32_t> shaped;  ///< bodies whose surfaces it has
};

/// Throws std::runtime_error if the file is no log.
LogContents contents_of(const std::filesystem::path& log);

}  // namespace palpate
