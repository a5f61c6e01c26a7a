#pragma once
#include <filesystem>
#include <string>

namespace palpate {

/// Makes the folder that a command's table goes into. Throws std::runtime_error if it cannot be made or written, or
/// holds a table of that name with another heading, which is not this command's to write over.
void prepare_folder(const std::filesystem::path& folder, const std::string& table, const std::string& heading);

}  // namespace palpate
