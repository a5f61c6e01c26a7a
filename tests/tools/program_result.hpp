#pragma once
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "tests/loopback/loopback_scene.hpp"

namespace palpate::testing {

/// What can be read of a file; of a process in /proc that ends meanwhile, nothing.
inline std::string text_of(const std::filesystem::path& file) {
  const std::ifstream in(file, std::ios::binary);
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
}

/// A folder of this process's own, removed with the object.
class OwnFolder {
 public:
  explicit OwnFolder(const std::string& name)
      : path_(std::filesystem::temp_directory_path() / fmt::format("palpate-{}-{}", name, getpid())) {
    std::filesystem::create_directories(path_);
  }
  ~OwnFolder() { std::filesystem::remove_all(path_); }
  OwnFolder(const OwnFolder&) = delete;
  std::filesystem::path operator/(const std::string& file) const { return path_ / file; }
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

/// What a program printed on each stream, and its exit status (128 + signal if it crashed).
struct ProgramResult {
  int status = 0;
  std::string out, err;
};

/// Runs a command line, given up after four minutes (status 124): it hangs.
inline ProgramResult run_program(const std::string& command) {
  const OwnFolder streams("streams");
  const std::string out = streams / "out", err = streams / "err";
  ProgramResult result;
  result.status = run_command(fmt::format("timeout -k 5 240 sh -c '{} >{} 2>{}'", command, out, err));
  result.out = text_of(out);
  result.err = text_of(err);
  return result;
}

/// The command fails with status 1 and says one sentence that begins with the program's name and holds every fragment.
inline void expect_refusal(const std::string& command, const std::vector<std::string>& fragments) {
  const ProgramResult result = run_program(command);
  EXPECT_EQ(result.status, 1) << command << "\n" << result.err;
  EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << command << "\n" << result.err;
  const std::string speaker = std::filesystem::path(command.substr(0, command.find(' '))).filename().string() + ": ";
  EXPECT_TRUE(result.err.starts_with(speaker)) << result.err;
  for (const std::string& fragment : fragments)
    EXPECT_NE(result.err.find(fragment), std::string::npos)
        << command << "\nlacks '" << fragment << "': " << result.err;
}

/// `text` with its only occurrence of `from` replaced.
inline std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  EXPECT_EQ(text.find(from, at + 1), std::string::npos) << from;
  return at == std::string::npos ? text : text.replace(at, from.size(), to);
}

}  // namespace palpate::testing
