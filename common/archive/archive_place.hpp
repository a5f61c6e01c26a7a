#pragma once
#include <filesystem>
#include <string>

namespace palpate {

/// Where the archive of a body lives: MESH_DIR/.palpate/BODY-HASH.h5; where that is not there and cannot be made, since
/// nothing may be written beside the mesh, below archive_cache(). $PALPATE_CACHE, if set, goes before both.
std::filesystem::path archive_path(const std::filesystem::path& mesh_file, const std::string& body,
                                   const std::string& content_hash);

/// The user's folder of archives: $PALPATE_CACHE, $XDG_CACHE_HOME/palpate or ~/.cache/palpate. Throws
/// std::runtime_error where none of these variables nor $HOME is set.
std::filesystem::path archive_cache();

}  // namespace palpate
