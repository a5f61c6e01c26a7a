#pragma once
#include <cstddef>
#include <string>

#include "common/scene/scene.hpp"

namespace palpate {

/// Bytes as a person reads them: "1.2 MB".
std::string human(std::size_t bytes);

/// Which kind of selector it is: "group 'top'", "a box", "a list of nodes"; `list` names what a list holds.
std::string describe(const Selector& where, const char* list);

}  // namespace palpate
