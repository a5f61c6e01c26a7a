#include "common/mesh/faults.hpp"

#include <fmt/format.h>

#include <stdexcept>

namespace palpate {

void FaultList::add(std::string fault) {
  if (count_++ < kListed) first_.push_back(std::move(fault));
}

void FaultList::raise(const std::string& where) const {
  if (count_ == 0) return;
  std::string text = fmt::format("{}: {}", where, fmt::join(first_, "; "));
  if (count_ > kListed) text += fmt::format("; and {} more faults", count_ - kListed);
  throw std::runtime_error(text);
}

}  // namespace palpate
