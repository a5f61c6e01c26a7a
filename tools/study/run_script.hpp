#pragma once
#include <filesystem>
#include <string>

namespace palpate {

/// Runs a script of scripts/ with a folder as its argument, in python3: that of the installation which this program
/// belongs to, else that of the source tree. Says in one sentence what is missing where it cannot, else an empty
/// string.
std::string run_script(const std::string& name, const std::filesystem::path& folder);

}  // namespace palpate
