#pragma once
#include <span>
#include <string_view>

namespace palpate {

/// The candidate that a misspelt word is likely to mean; empty if none is near.
std::string_view nearest(std::string_view word, std::span<const std::string_view> candidates);

}  // namespace palpate
