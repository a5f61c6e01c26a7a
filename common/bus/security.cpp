#include "common/bus/security.hpp"

#include <dds/security/dds_security_api_defs.h>
#include <dds/security/dds_security_api_err.h>
#include <dlfcn.h>
#include <fmt/format.h>
#include <sys/stat.h>

#include <algorithm>
#include <fstream>
#include <stdexcept>

namespace palpate {
namespace fs = std::filesystem;
namespace {

[[noreturn]] void fail(const std::string& sentence) {
  throw std::runtime_error("network: " + sentence);
}

std::string text_of(const fs::path& file) {
  std::error_code error;
  if (!fs::exists(file, error))
    fail(fmt::format("there is no {}; docs/security.md says what a folder of keys holds", file.string()));
  std::ifstream stream(file, std::ios::binary);
  std::string text(std::istreambuf_iterator<char>(stream), {});
  if (!stream || text.empty()) fail(fmt::format("{} cannot be read", file.string()));
  return text;
}

/// The bytes of the first object in a PEM text.
std::string bytes_of_pem(const std::string& text) {
  const std::size_t begin = text.find('\n', text.find("-----BEGIN")), end = text.find("-----END");
  std::string bytes;
  unsigned bits = 0, count = 0;
  if (begin == text.npos || end == text.npos || end < begin) return bytes;
  for (const char c : text.substr(begin, end - begin)) {
    static constexpr std::string_view digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    const std::size_t digit = digits.find(c);
    if (digit == digits.npos) continue;
    bits = bits << 6 | static_cast<unsigned>(digit);
    if (++count % 4 != 1) bytes.push_back(static_cast<char>(bits >> (6 - 2 * ((count - 1) % 4))));
  }
  return bytes;
}

/// The middleware itself does not notice, and would take part in vain. A private key on P-256 holds its public one as
/// a bit string of 65 bytes, the first of them 4, and a certificate the same bytes.
void check_key(const KeyFiles& keys) {
  struct stat status {};
  if (stat(keys.key.c_str(), &status) == 0 && (status.st_mode & 077) != 0)
    fail(fmt::format("{} may be read by others: chmod 600 it", keys.key.string()));
  const std::string own = bytes_of_pem(text_of(keys.key)), certificate = bytes_of_pem(text_of(keys.certificate));
  static const std::string head("\x03\x42\x00\x04", 4);
  const std::size_t at = own.find(head);
  if (at == own.npos || own.size() < at + 68)
    fail(fmt::format("{} is not a private key as `palpate keys` makes them", keys.key.string()));
  if (certificate.find(own.substr(at, 68)) == certificate.npos)
    fail(fmt::format("{} is not the key of {}", keys.key.string(), keys.certificate.string()));
}

/// What stands between two texts in signed permissions, whose own text stands in them as it is.
std::string between(const fs::path& permissions, const std::string& before, char end) {
  const std::string text = text_of(permissions);
  const std::size_t at = text.find(before);
  if (at == text.npos) return {};
  return text.substr(at + before.size(), text.find(end, at + before.size()) - at - before.size());
}

/// Folder of the middleware's plugins: beside its library, or in a folder of Debian's package there.
fs::path plugin_folder() {
  Dl_info library{};
  if (dladdr(dlsym(RTLD_DEFAULT, "dds_create_participant"), &library) == 0 || !library.dli_fname)
    fail("cannot tell where Cyclone DDS lies");
  const fs::path beside = fs::canonical(library.dli_fname).parent_path(), debian = beside / "libddsc0debian";
  for (const fs::path& folder : {debian, beside})
    if (fs::exists(folder / "libdds_security_auth.so")) return folder;
  fail(
      fmt::format("the scene has [network.security], but the plugins for it, libdds_security_auth.so and others, are "
                  "neither in {} nor in {}; "
                  "Debian's package libddsc0debian has them",
                  debian.string(), beside.string()));
}

}  // namespace

KeyFiles key_files(const fs::path& folder) {
  return {folder / "authority.pem", folder / "certificate.pem", folder / "key.pem", folder / "governance.p7s",
          folder / "permissions.p7s"};
}

KeyFiles find_keys(const fs::path& folder, const std::string& role) {
  std::error_code error;
  if (!fs::is_directory(folder, error))
    fail(fmt::format("there is no folder of keys {}: `palpate keys` makes one, see docs/security.md", folder.string()));
  const bool of_all = fs::is_directory(folder / role, error), of_one = fs::exists(key_files(folder).certificate, error);
  if (!of_all && !of_one)
    fail(
        fmt::format("{} holds no keys of the role '{}': a folder of that name has to be in it", folder.string(), role));
  KeyFiles keys = key_files(fs::absolute(of_all ? folder / role : folder));
  const std::string found = between(keys.permissions, "<grant name=\"", '"');
  if (found != role)
    fail(fmt::format("{} holds keys of the role '{}', and this program's is '{}'",
                     keys.permissions.parent_path().string(), found, role));
  for (const fs::path& file : {keys.authority, keys.governance}) text_of(file);
  check_key(keys);
  return keys;
}

std::string last_day(const KeyFiles& keys) {
  return between(keys.permissions, "<not_after>", 'T');
}

std::map<std::string, std::string> security_properties(const KeyFiles& keys) {
  const fs::path plugins = plugin_folder();
  const auto uri = [](const fs::path& file) { return "file:" + file.string(); };
  return {{DDS_SEC_PROP_AUTH_LIBRARY_PATH, plugins / "libdds_security_auth.so"},
          {DDS_SEC_PROP_AUTH_LIBRARY_INIT, "init_authentication"},
          {DDS_SEC_PROP_AUTH_LIBRARY_FINALIZE, "finalize_authentication"},
          {DDS_SEC_PROP_ACCESS_LIBRARY_PATH, plugins / "libdds_security_ac.so"},
          {DDS_SEC_PROP_ACCESS_LIBRARY_INIT, "init_access_control"},
          {DDS_SEC_PROP_ACCESS_LIBRARY_FINALIZE, "finalize_access_control"},
          {DDS_SEC_PROP_CRYPTO_LIBRARY_PATH, plugins / "libdds_security_crypto.so"},
          {DDS_SEC_PROP_CRYPTO_LIBRARY_INIT, "init_crypto"},
          {DDS_SEC_PROP_CRYPTO_LIBRARY_FINALIZE, "finalize_crypto"},
          {DDS_SEC_PROP_AUTH_IDENTITY_CA, uri(keys.authority)},
          {DDS_SEC_PROP_AUTH_IDENTITY_CERT, uri(keys.certificate)},
          {DDS_SEC_PROP_AUTH_PRIV_KEY, uri(keys.key)},
          {DDS_SEC_PROP_ACCESS_PERMISSIONS_CA, uri(keys.authority)},
          {DDS_SEC_PROP_ACCESS_GOVERNANCE, uri(keys.governance)},
          {DDS_SEC_PROP_ACCESS_PERMISSIONS, uri(keys.permissions)}};
}

std::string why_refused(const KeyFiles& keys, const std::vector<std::string>& words) {
  std::string said;
  for (const std::string& text : words)
    if (said.empty() || text.find("(code: ") != text.npos) said = text;
  const auto says = [&](const std::string& part) { return said.find(part) != said.npos; };
  const auto code = [&](int number) { return says(fmt::format("(code: {})", number)); };
  const auto sentence = [](const fs::path& file, const std::string& what) {
    return fmt::format("network: {} {}", file.string(), what);
  };
  const std::string ended = "has expired; `palpate keys` makes new ones",
                    early = "is not valid yet: is this host's clock right?";
  if (says("certificate has expired")) return sentence(keys.certificate, "or the authority's " + ended);
  if (says("certificate is not yet valid")) return sentence(keys.certificate, early);
  if (says("unable to get local issuer") || says("certificate signature failure"))
    return sentence(keys.certificate, fmt::format("is not of the authority {}", keys.authority.string()));
  if (code(DDS_SECURITY_ERR_VALIDITY_PERIOD_EXPIRED_CODE)) return sentence(keys.permissions, ended);
  if (code(DDS_SECURITY_ERR_VALIDITY_PERIOD_NOT_STARTED_CODE)) return sentence(keys.permissions, early);
  if (code(DDS_SECURITY_ERR_INVALID_SUBJECT_NAME_CODE))
    return sentence(keys.permissions, fmt::format("is not for {}", keys.certificate.string()));
  if (code(DDS_SECURITY_ERR_INVALID_SMIME_DOCUMENT_CODE))
    return sentence(keys.governance,
                    fmt::format("or {} beside it is not as {} signed it", keys.permissions.filename().string(),
                                keys.authority.filename().string()));
  return fmt::format("network: the middleware refuses the keys in {}: {}", keys.certificate.parent_path().string(),
                     said.substr(0, said.find('\n')));
}

}  // namespace palpate
