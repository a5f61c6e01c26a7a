// Writes the tables of keys into the page of the scene file: scene_reference docs/scene.md
#include <fmt/format.h>

#include <cstdio>
#include <fstream>
#include <sstream>
#include <stdexcept>

#include "common/scene/reference.hpp"
#include "common/scene/scene.hpp"

int main(int argc, char** argv) try {
  if (argc != 2) throw std::runtime_error("usage: scene_reference PAGE.md");
  std::ifstream in(argv[1]);
  if (!in) throw std::runtime_error(fmt::format("{}: the page cannot be read", argv[1]));
  std::ostringstream page;
  page << in.rdbuf();
  const std::string text = palpate::with_reference(page.str(), palpate::scene_keys());
  std::ofstream out(argv[1]);
  out << text;
  if (!out.flush()) throw std::runtime_error(fmt::format("{}: the page cannot be written", argv[1]));
} catch (const std::exception& error) {
  fmt::print(stderr, "scene_reference: {}\n", error.what());
  return 1;
}
