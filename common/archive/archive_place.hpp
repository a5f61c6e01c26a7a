#pragma once
#include <filesystem>
#include <string>

namespace palpate {

/// Where the archive of a body lives: MESH_DIR/.palpate/BODY-HASH.h5; where that is not there and cannot be made, since
/// nothing may be written beside the mesh, below archive_cache(). $PALPATE_CACHE, if set, goes before both.
std::filesystem::path archive_path(const std::filesystem::path& mesh_file, const std::string& body,
                                   const std::string& content_hash);

/// user_cache(). Throws std::runtime_error where there is none.
std::filesystem::path archive_cache();

}  // namespace palpate
