#include "common/contact/patch/patch_parts.hpp"

#include "common/tool/instrument.hpp"

namespace palpate {
namespace {

constexpr double kWidestBall = 0.1;  // [m] of radius

bool is_shaft(const EndAbilities& can, int part) {
  return !can.turning || part == forceps_shaft;
}

}  // namespace

std::vector<PatchPart> patch_parts(std::span<const Tool> tools, bool shafts) {
  std::vector<PatchPart> all;
  for (std::size_t t = 0; t < tools.size(); ++t) {
    const EndAbilities can = abilities_of(tools[t]);
    const std::vector<ToolPart> parts = tool_parts(tools[t]);
    for (int p = 0; p < static_cast<int>(parts.size()); ++p) {
      const bool sphere = parts[p].length == 0;
      if (sphere ? can.ball && parts[p].radius <= kWidestBall : shafts && is_shaft(can, p))
        all.push_back({static_cast<int>(t), p, parts[p].radius, parts[p].length});
    }
  }
  return all;
}

}  // namespace palpate
