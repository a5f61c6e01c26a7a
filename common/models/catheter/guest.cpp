// A catheter among the other bodies of a scene.
#include <fmt/format.h>

#include "common/models/catheter/spec.hpp"

namespace palpate {

void require_neighbours(Description& d, const std::string& place, const CatheterSpec& body, const FindNeighbour& find) {
  const std::string& inside = body.catheter.inside;
  if (inside.empty()) return;
  const auto duct = find(inside);
  const std::string reason =
      !duct ? "the scene has no such body" : fmt::format("that body's model is '{}'", duct->kind);
  d.require(duct && duct->wall, place + ".catheter.inside",
            fmt::format("inside must name a body of the model 'modal_shell', and is '{}': {}", inside, reason));
}

}  // namespace palpate
