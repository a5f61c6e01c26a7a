#include "tools/keys/key_folder.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <random>
#include <stdexcept>

#include "common/bus/security.hpp"
#include "tools/keys/documents.hpp"

namespace palpate::keys {
namespace fs = std::filesystem;
namespace {

constexpr std::time_t kDay = 24 * 60 * 60, kLifeOfAuthority = 7300 * kDay;

/// Writes a file that is not there yet; nobody else ever sees what is private.
void write(const fs::path& file, const std::string& text, int mode) {
  const int out = open(file.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, mode);
  const bool written =
      out >= 0 && ::write(out, text.data(), text.size()) == static_cast<ssize_t>(text.size()) && fsync(out) == 0;
  const std::string reason = std::strerror(errno);
  if (out >= 0) close(out);
  if (!written) throw std::runtime_error(fmt::format("keys: cannot write {}: {}", file.string(), reason));
}

void make(const fs::path& folder, fs::perms permissions) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (!error) fs::permissions(folder, permissions, error);
  if (error)
    throw std::runtime_error(fmt::format("keys: cannot make the folder {}: {}", folder.string(), error.message()));
}

std::string text_of(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  std::string text(std::istreambuf_iterator<char>(stream), {});
  if (!stream || text.empty()) throw std::runtime_error(fmt::format("keys: {} cannot be read", file.string()));
  return text;
}

fs::path authority_in(const fs::path& folder) {
  return folder / "authority";
}

Identity read_authority(const fs::path& folder) {
  const fs::path authority = authority_in(folder);
  if (!fs::exists(authority))
    throw std::runtime_error(
        fmt::format("keys: {} has no authority; `palpate keys {}` makes one", folder.string(), folder.string()));
  return {text_of(authority / "key.pem"), text_of(authority / "certificate.pem")};
}

void write_role(const Identity& authority, const fs::path& folder, const std::string& role, const std::string& name,
                const Period& period) {
  const Identity member = make_member(authority, name, period);
  const KeyFiles files = key_files(folder / name);
  make(folder / name, fs::perms::owner_all);
  write(files.authority, authority.certificate, 0644);
  write(files.certificate, member.certificate, 0644);
  write(files.key, member.key, 0600);
  write(files.governance, sign(authority, governance_document()), 0644);
  write(files.permissions,
        sign(authority, permissions_document(role, subject_of(member.certificate), rights_of(role), period)), 0644);
}

/// Two authorities are never of one name.
std::string new_name() {
  std::random_device random;
  return fmt::format("palpate {:08x}{:08x}", random(), random());
}

}  // namespace

void make_folder(const fs::path& folder, const Period& period) {
  for (const auto& name : bus_roles())
    if (fs::exists(folder / name))
      throw std::runtime_error(fmt::format("keys: {} is there already; nothing was written", (folder / name).string()));
  if (fs::exists(authority_in(folder)))
    throw std::runtime_error(
        fmt::format("keys: {} is there already; nothing was written, --add makes further keys from it",
                    authority_in(folder).string()));
  const Identity authority =
      make_authority(new_name(), {period.from, std::max(period.to, period.from + kLifeOfAuthority)});
  make(authority_in(folder), fs::perms::owner_all);
  write(authority_in(folder) / "key.pem", authority.key, 0600);
  write(authority_in(folder) / "certificate.pem", authority.certificate, 0644);
  for (const std::string& role : bus_roles()) write_role(authority, folder, role, role, period);
}

std::time_t add_keys(const fs::path& folder, const std::string& role, const std::string& name, const Period& period) {
  rights_of(role);
  if (name.empty() || name == "authority" ||
      !std::ranges::all_of(name, [](unsigned char c) { return std::isalnum(c) || c == '_' || c == '-'; }))
    throw std::runtime_error(fmt::format("keys: '{}' is no name for keys: letters, digits, _ and - make one", name));
  const Identity authority = read_authority(folder);
  if (fs::exists(folder / name))
    throw std::runtime_error(fmt::format("keys: {} is there already; nothing was written", (folder / name).string()));
  const Period within{period.from, std::min(period.to, end_of(authority.certificate))};
  if (within.to <= within.from)
    throw std::runtime_error(fmt::format("keys: the authority in {} has expired", folder.string()));
  write_role(authority, folder, role, name, within);
  return within.to;
}

}  // namespace palpate::keys
