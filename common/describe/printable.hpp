#pragma once
#include <string>
#include <string_view>

namespace palpate {

/// Text from outside as it may stand in a line for the operator: letters of every script (UTF-8) as they are; '?' for
/// each byte that is none, and for each character that a terminal could take for something else than a letter: control
/// characters, ends of lines, and those that turn the direction of writing or show nothing.
std::string printable(std::string_view text);

}  // namespace palpate
