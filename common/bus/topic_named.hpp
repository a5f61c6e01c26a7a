#pragma once
#include <fmt/format.h>

#include <stdexcept>
#include <string>

#include "idl/topics.hpp"

namespace palpate {

/// The topic of this name, or of this name after `palpate/`. Throws std::runtime_error that names all where there is
/// none.
inline std::string topic_named(const std::string& name) {
  std::string whole = name.find('/') == std::string::npos ? "palpate/" + name : name;
  std::string all;
  bool known = false;
  topics::for_each([&](const auto& topic) {
    all += fmt::format(" {}", std::string(topic.name).substr(8));
    known |= whole == topic.name;
  });
  if (!known) throw std::runtime_error(fmt::format("there is no topic '{}'; the topics are{}", name, all));
  return whole;
}

}  // namespace palpate
