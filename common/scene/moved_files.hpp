#pragma once
#include <filesystem>
#include <initializer_list>
#include <map>
#include <string_view>
#include <vector>

#include "common/scene/scene.hpp"

namespace palpate {

/// Every file that a scene names, each once, in the order of the scene.
std::vector<std::filesystem::path> files_of(const Scene& scene);

/// Throws std::runtime_error if one of `outputs`, of which empty ones are none, is the scene's file or one that it
/// names: nothing is written over what it is made of.
void keep_files_of(const Scene& scene, std::initializer_list<std::filesystem::path> outputs);

/// Where files lie now, by where the text of a scene says they do.
using MovedFiles = std::map<std::filesystem::path, std::filesystem::path>;

/// parse_scene() of a text from elsewhere.
Scene parse_scene(std::string_view text, const std::filesystem::path& file, const MovedFiles& moved);

}  // namespace palpate
