#pragma once
#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace palpate {

/// What one role's folder holds, as `palpate keys` writes it.
struct KeyFiles {
  std::filesystem::path authority;    ///< certificate of who signed all the others
  std::filesystem::path certificate;  ///< own
  std::filesystem::path key;          ///< own, private: nobody else may read it
  std::filesystem::path governance;   ///< how all topics are protected, signed
  std::filesystem::path permissions;  ///< what this role may do, signed
};
KeyFiles key_files(const std::filesystem::path& folder);

/// The keys of a role: those in the subfolder of its name or, if there is none, in the folder itself. Throws
/// std::runtime_error in one sentence if a file is missing, the private key lies open to others or does not belong to
/// the certificate, or they are of another role.
KeyFiles find_keys(const std::filesystem::path& folder, const std::string& role);

/// The last day on which keys hold, by their permissions: "2028-11-20".
std::string last_day(const KeyFiles& keys);

/// Properties of a participant that takes part with these keys. Throws std::runtime_error in one sentence if the
/// middleware's plugins are not installed.
std::map<std::string, std::string> security_properties(const KeyFiles& keys);

/// Why the middleware refused these keys, in one sentence, from what it said meanwhile.
std::string why_refused(const KeyFiles& keys, const std::vector<std::string>& words);

}  // namespace palpate
