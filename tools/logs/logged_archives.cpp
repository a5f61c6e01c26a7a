#include <fmt/format.h>

#include "common/cli/progress.hpp"
#include "common/scene/ensure_archive.hpp"
#include "common/scene/find_archive.hpp"
#include "tools/logs/log_files.hpp"

namespace palpate {

void LoggedScene::ensure_archives() const {
  for (const Body& body : scene_.bodies) {
    if (!archive_path(body).empty() && !std::filesystem::exists(archive_path(body)))
      cli::say(fmt::format("body '{}': its archive is computed first", name_of(body)));
    ensure_archive(scene_, body);
  }
}

}  // namespace palpate
