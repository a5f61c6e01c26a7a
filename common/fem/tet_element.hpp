#pragma once
#include <array>
#include <string_view>

namespace palpate {

/// What a tetrahedron of moving tissue makes of its corners' displacements: a strain of its own, or the mean over the
/// tetrahedra around each of its nodes (NodalPatches).
enum class TetElement { linear, nodal_strain };

inline const auto& words_of(TetElement) {
  static constexpr std::array<std::string_view, 2> words{"linear", "nodal_strain"};
  return words;
}

}  // namespace palpate
