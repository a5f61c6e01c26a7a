#pragma once
#include <filesystem>
#include <string>

#include "tools/keys/certificates.hpp"

namespace palpate::keys {

/// Makes an authority in FOLDER/authority and keys of every role, each in a folder of its own with all that one host
/// needs. Refuses where there is an authority already. Throws std::runtime_error in one sentence.
void make_folder(const std::filesystem::path& folder, const Period& period);

/// Adds keys of one role to a folder with an authority, in FOLDER/NAME. Refuses to write over any. Returns when they
/// end: with the authority at the latest.
std::time_t add_keys(const std::filesystem::path& folder, const std::string& role, const std::string& name,
                     const Period& period);

}  // namespace palpate::keys
