#pragma once
#include <string>
#include <string_view>
#include <type_traits>
#include <variant>

namespace palpate {

/// What is said of a key whose value is one of a table of kinds, by the kKind and kMeaning of each: "`"a"`: this;
/// `"b"`: that".
template <class... Spec>
std::string meanings(std::type_identity<std::variant<Spec...>>) {
  std::string text;
  const auto add = [&](std::string_view kind, std::string_view meaning) {
    text.append(text.empty() ? "" : "; ").append("`\"").append(kind).append("\"`: ").append(meaning);
  };
  (add(Spec::kKind, Spec::kMeaning), ...);
  return text;
}

}  // namespace palpate
