#include "tools/motion/choose_tool.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

namespace palpate {

int choose_tool(const Scene& scene, const std::string& name) {
  const auto found = std::ranges::find(scene.tools, name, &Tool::name);
  if (found != scene.tools.end()) return static_cast<int>(found - scene.tools.begin());
  if (name.empty() && scene.tools.size() == 1) return 0;
  std::string names;
  for (const Tool& tool : scene.tools) names += (names.empty() ? "" : ", ") + tool.name;
  throw std::runtime_error(fmt::format("{}: which tool? It has {}", scene.file.string(), names));
}

}  // namespace palpate
