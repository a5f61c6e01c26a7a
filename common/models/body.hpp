#pragma once
#include <concepts>
#include <string>
#include <string_view>
#include <variant>

#include "common/models/catheter/spec.hpp"
#include "common/models/hybrid/spec.hpp"
#include "common/models/modal_shell/spec.hpp"
#include "common/models/quasi_static/spec.hpp"
#include "common/models/spring_mass/spec.hpp"
#include "common/models/tensor_mass/spec.hpp"

namespace palpate {

/// The table of the kinds of tissue: a body is one of them.
using Body = std::variant<QuasiStaticSpec, TensorMassSpec, SpringMassSpec, HybridSpec, ModalShellSpec, CatheterSpec>;

/// What of a body is a Part, its kind or one of its bases; null if it is none.
template <class Part>
Part* as(Body& body) {
  return std::visit(
      [](auto& spec) -> Part* {
        if constexpr (std::derived_from<std::remove_reference_t<decltype(spec)>, Part>)
          return &spec;
        else
          return nullptr;
      },
      body);
}
template <class Part>
const Part* as(const Body& body) {
  return as<Part>(const_cast<Body&>(body));
}

inline const std::string& name_of(const Body& body) {
  return as<NamedSpec>(body)->name;
}

/// As a scene file writes it: `quasi_static`.
inline std::string_view kind_of(const Body& body) {
  return std::visit([](const auto& spec) { return std::remove_cvref_t<decltype(spec)>::kKind; }, body);
}

inline Owner owner_of(const Body& body) {
  return std::visit([](const auto& spec) { return owner(spec); }, body);
}

inline const ShellSpec* wall_of(const Body& body) {
  return std::visit([](const auto& spec) { return wall_of(spec); }, body);
}

inline void describe(Description& d, Body& body) {
  d.variant({"model", "", "the kind of tissue, see below", Need::optional, Use::stored}, body);
}

}  // namespace palpate
