#include "common/cli/progress.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <cstdio>

namespace palpate::cli {
namespace {

Telling how_much = Telling::progress;

}  // namespace

void set_telling(Telling telling) {
  how_much = telling;
}

Telling telling() {
  return how_much;
}

void say(std::string_view line) {
  if (how_much != Telling::nothing) fmt::print(stderr, "{}\n", line);
}

void say_in_place(std::string_view line) {
  static const bool terminal = isatty(STDERR_FILENO) != 0;
  constexpr const char* kEraseLine = "\r\x1b[K";
  if (terminal && how_much != Telling::nothing) fmt::print(stderr, "{}{}", kEraseLine, line);
}

}  // namespace palpate::cli
