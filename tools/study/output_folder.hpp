#pragma once
#include <filesystem>
#include <string>
#include <vector>

namespace palpate {

/// The file by which a folder is known to be a command's own: it begins so, and is written before the others.
struct OwnFile {
  std::string name, beginning;
};

/// Makes the folder that a command's files go into. Throws std::runtime_error if it cannot be made or written, or holds
/// what is not this command's to write over: another file of the name of `own`, or one of `others` without that.
void prepare_folder(const std::filesystem::path& folder, const OwnFile& own, const std::vector<std::string>& others);

}  // namespace palpate
