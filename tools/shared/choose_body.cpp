#include "tools/shared/choose_body.hpp"

#include <fmt/format.h>

#include <stdexcept>

namespace palpate {

const Body& choose_body(const Scene& scene, const std::string& name) {
  if (name.empty() && scene.bodies.size() == 1) return scene.bodies[0];
  for (const auto& body : scene.bodies)
    if (name_of(body) == name) return body;
  std::string names;
  for (const auto& body : scene.bodies) names += (names.empty() ? "" : ", ") + name_of(body);
  throw std::runtime_error(name.empty() ? "the scene has several bodies: choose one with --body: " + names
                                        : fmt::format("the scene has no body '{}': it has {}", name, names));
}

}  // namespace palpate
