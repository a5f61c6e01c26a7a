#pragma once
#include <fmt/format.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "tools/keys/certificates.hpp"

namespace palpate::testing {

/// A folder of this process's own, removed with the object.
class OwnFolder {
 public:
  OwnFolder() : path_(std::filesystem::temp_directory_path() / fmt::format("palpate-keys-{}", getpid())) {
    std::filesystem::create_directories(path_);
  }
  ~OwnFolder() { std::filesystem::remove_all(path_); }
  OwnFolder(const OwnFolder&) = delete;
  std::filesystem::path operator/(const std::string& name) const { return path_ / name; }

 private:
  std::filesystem::path path_;
};

inline std::string text_of(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

constexpr std::time_t kDay = 24 * 60 * 60;
/// From yesterday for a month.
inline keys::Period now_and_on() {
  return {std::time(nullptr) - kDay, std::time(nullptr) + 30 * kDay};
}

}  // namespace palpate::testing
