#pragma once
#include <filesystem>
#include <optional>

namespace palpate {

/// $PALPATE_CACHE, where it is set.
std::optional<std::filesystem::path> chosen_cache();

/// The user's folder of what can be made again: $PALPATE_CACHE, $XDG_CACHE_HOME/palpate or ~/.cache/palpate. None where
/// none of these variables nor $HOME is set. It need not be there.
std::optional<std::filesystem::path> user_cache();

}  // namespace palpate
