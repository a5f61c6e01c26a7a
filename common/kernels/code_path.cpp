#include "common/kernels/code_path.hpp"

#include <fmt/format.h>

#include "common/kernels/kernels.hpp"

namespace palpate {

std::string this_software() {
  return fmt::format("palpate {} g++ {}", PALPATE_VERSION, __VERSION__);
}

std::string code_path() {
  return fmt::format("{}; {}", kernels::active().name, this_software());
}

std::pair<std::string, std::string> split_code_path(const std::string& recorded) {
  const std::size_t cut = recorded.find("; ");
  if (cut == std::string::npos) return {recorded, ""};
  return {recorded.substr(0, cut), recorded.substr(cut + 2)};
}

}  // namespace palpate
