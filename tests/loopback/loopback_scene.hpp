#pragma once
#include <fmt/format.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "common/mesh/generators.hpp"
#include "common/mesh/mesh_file.hpp"

namespace palpate::testing {

/// For a body whose tensors may be the plainest.
inline constexpr const char* kLinear = "[body.offline]\nelement = \"p1\"\n";

/// A small complete scene in a folder of its own: a block under one scripted tool that presses 6 mm deep, slides
/// and lets go within two seconds. Removed with the object.
class LoopbackScene {
 public:
  explicit LoopbackScene(const std::string& name, const std::string& more_body = "", double young = 5000)
      : folder_(std::filesystem::temp_directory_path() / fmt::format("palpate-{}-{}", name, getpid())) {
    std::filesystem::create_directories(folder_);
    write_tet_mesh(make_block({-0.05, -0.05, -0.05}, {0.05, 0.05, 0}, {8, 8, 4}), folder_ / "block.msh");
    write("motion.csv",
          "time,yaw,pitch,depth,roll,grip\n0,0,0,0.17,0,0\n0.5,0,0,0.18,0,0\n1.0,0,0,0.198,0,0\n1.5,0.06,0.02,0.199,0."
          "3,0\n"
          "2.0,0.06,0.02,0.17,0.3,0\n2.2,0,0,0.17,0,0\n");
    write("scene.toml", fmt::format(R"(title = "loopback block"
[[body]]
name = "block"
mesh = "block.msh"
model = "quasi_static"
young = {}
poisson = 0.4
density = 1000.0
{}
[[body.fixed]]
box = [[-1.0, -1.0, -0.0501], [1.0, 1.0, -0.0499]]

[[tool]]
name = "probe"
pivot = [0.0, 0.0, 0.2]
radius = 0.008
device = "scripted"
trajectory = "motion.csv"

[render]
width = 320
height = 240
[render.camera]
eye = [0.0, -0.15, 0.1]
target = [0.0, 0.0, 0.0]
)",
                                    young, more_body));
  }
  ~LoopbackScene() { std::filesystem::remove_all(folder_); }

  std::string scene() const { return folder_ / "scene.toml"; }
  std::filesystem::path folder() const { return folder_; }
  /// Puts other text in place of a part of the scene file.
  void replace(const std::string& from, const std::string& to) const {
    std::ifstream in(scene());
    std::string text{std::istreambuf_iterator<char>(in), {}};
    text.replace(text.find(from), from.size(), to);
    write("scene.toml", text);
  }
  void write(const std::string& file, const std::string& text) const { std::ofstream(folder_ / file) << text; }

 private:
  std::filesystem::path folder_;
};

inline std::string program(const std::string& name) {
  return std::string(PALPATE_BIN) + "/" + name;
}

/// Runs a command line and returns its exit status; standard output and error go to `output`.
inline int run_command(const std::string& command, std::string* output = nullptr) {
  std::FILE* pipe = popen((command + " 2>&1").c_str(), "r");
  std::string all;
  char buffer[4096];
  while (std::size_t n = std::fread(buffer, 1, sizeof buffer, pipe)) all.append(buffer, n);
  const int status = pclose(pipe);
  if (output) *output = all;
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

}  // namespace palpate::testing
