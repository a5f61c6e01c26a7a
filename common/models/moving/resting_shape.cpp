// The haptic node tells nothing of the shape of moving tissue: the deformation node has it.
#include "common/archive/archive.hpp"
#include "common/dynamics/spec.hpp"
#include "common/models/body_shape.hpp"
#include "common/models/kind.hpp"

namespace palpate {

std::unique_ptr<BodyShape> make_shape(const MovingSpec&, const Archive& archive, const StepSettings&) {
  return std::make_unique<BodyShape>(archive.surface);
}

}  // namespace palpate
