#pragma once
#include <string_view>

namespace palpate::bench {

/// Whether a case is asked for: one whose name contains the word behind --only, or any where there is none.
inline bool is_asked_for(std::string_view name, int argc, char** argv) {
  for (int i = 1; i + 1 < argc; ++i)
    if (std::string_view(argv[i]) == "--only") return name.find(argv[i + 1]) != std::string_view::npos;
  return true;
}

}  // namespace palpate::bench
