#pragma once
#include <string>

namespace palpate {

/// Text from outside as it may stand in a line for the operator: what a terminal could take for something else than a
/// letter is shown as '?'.
std::string printable(std::string text);

}  // namespace palpate
