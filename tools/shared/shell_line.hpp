#pragma once
#include <string>
#include <vector>

namespace palpate {

/// A command line in words, as a shell reads it.
std::string shell_line(const std::vector<std::string>& arguments);

}  // namespace palpate
