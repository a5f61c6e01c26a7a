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

const std::string& name_of(const Body& body);

/// As a scene file writes it: `quasi_static`.
std::string_view kind_of(const Body& body);

Owner owner_of(const Body& body);

bool has_task(const Body& body);

const ShellSpec* wall_of(const Body& body);
const VisualSpec* visual_of(const Body& body);

void describe(Description& d, Body& body);

}  // namespace palpate
