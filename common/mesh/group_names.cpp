#include "common/mesh/group_names.hpp"

#include <algorithm>

namespace palpate {
namespace {

bool is_number_of_another(const std::map<std::string, MeshGroup>& groups, const std::string& name,
                          const MeshGroup& group) {
  const auto is_same = [&](const auto& other) {
    return other.first != name && other.second.nodes == group.nodes && other.second.tetrahedra == group.tetrahedra;
  };
  return name.find_first_not_of("0123456789") == std::string::npos && std::ranges::any_of(groups, is_same);
}

}  // namespace

std::vector<std::string> group_names(const std::map<std::string, MeshGroup>& groups) {
  std::vector<std::string> names;
  for (const auto& [name, group] : groups)
    if (!is_number_of_another(groups, name, group)) names.push_back(name);
  return names;
}

}  // namespace palpate
