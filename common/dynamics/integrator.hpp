#pragma once
#include <array>
#include <string_view>

namespace palpate {

/// How tissue that moves goes on by a step. Scenes have the first two; forward Euler is there for comparison
/// (RR3510 sec. 5.4).
enum class Integrator { rk4, semi_implicit, forward_euler };

inline const auto& words_of(Integrator) {
  static constexpr std::array<std::string_view, 2> words{"rk4", "semi_implicit"};
  return words;
}

}  // namespace palpate
