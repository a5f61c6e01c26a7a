#include "common/bus/printable.hpp"

namespace palpate {

std::string printable(std::string text) {
  for (char& c : text)
    if (c < 0x20 || c > 0x7e) c = '?';
  return text;
}

}  // namespace palpate
