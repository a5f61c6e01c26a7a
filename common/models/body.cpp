#include "common/models/body.hpp"

namespace palpate {

const std::string& name_of(const Body& body) {
  return as<NamedSpec>(body)->name;
}

std::string_view kind_of(const Body& body) {
  return std::visit([](const auto& spec) { return std::remove_cvref_t<decltype(spec)>::kKind; }, body);
}

Owner owner_of(const Body& body) {
  return std::visit([](const auto& spec) { return owner(spec); }, body);
}

bool has_task(const Body& body) {
  return std::visit([](const auto& spec) { return has_task(spec); }, body);
}

const ShellSpec* wall_of(const Body& body) {
  return std::visit([](const auto& spec) { return wall_of(spec); }, body);
}

const VisualSpec* visual_of(const Body& body) {
  return std::visit([](const auto& spec) { return visual_of(spec); }, body);
}

void describe(Description& d, Body& body) {
  d.variant({"model", "", "the kind of tissue, see below", Need::optional, Use::stored}, body);
}

}  // namespace palpate
