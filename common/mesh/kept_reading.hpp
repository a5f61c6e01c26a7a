#pragma once
#include <filesystem>
#include <optional>
#include <string>

namespace palpate {

/// Where in a cache folder what the gmsh library answered to mesh files is kept: a file for each, named by what it was
/// made of. Loading the library takes longer than reading most meshes.
std::filesystem::path readings_folder(const std::filesystem::path& cache);

/// Where the answer to this file's bytes and extension, by this version of gmsh, belongs; none without a user's cache.
/// Throws std::runtime_error if the file cannot be read.
std::optional<std::filesystem::path> reading_place(const std::filesystem::path& mesh_file);

/// What is kept there; none where that is missing, damaged, another place's or another version's.
std::optional<std::string> kept_answer(const std::filesystem::path& place);

/// Keeps an answer of 16 MB at most, whole or not at all; one that cannot be written is not kept.
void keep_answer(const std::filesystem::path& place, const std::string& answer);

}  // namespace palpate
