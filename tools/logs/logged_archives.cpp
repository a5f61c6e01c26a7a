#include <fmt/format.h>

#include "common/cli/progress.hpp"
#include "common/scene/ensure_archive.hpp"
#include "common/scene/find_archive.hpp"
#include "tools/logs/log_files.hpp"

namespace palpate {

std::vector<std::string> LoggedScene::ensure_archives() const {
  std::vector<std::string> computed;
  for (const Body& body : scene_.bodies) {
    if (!archive_path(body).empty() && !std::filesystem::exists(archive_path(body)))
      cli::say(fmt::format("body '{}': its archive is computed first", name_of(body)));
    if (!ensure_archive(scene_, body).up_to_date) computed.push_back(name_of(body));
  }
  return computed;
}

}  // namespace palpate
