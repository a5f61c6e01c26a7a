#pragma once
#include <string_view>

namespace palpate::cli {

/// How much a command says on standard error while it works. Results, warnings and faults do not depend on it.
enum class Telling { nothing, progress, everything };
void set_telling(Telling telling);
Telling telling();

/// A line of progress.
void say(std::string_view line);
/// A line that the next one takes the place of; only on a terminal. Empty: takes the last one away.
void say_in_place(std::string_view line);

}  // namespace palpate::cli
