// The smooth tube about a catheter's particles, as others show it.
#include "common/archive/archive.hpp"
#include "common/mesh/tube.hpp"
#include "common/models/body_shape.hpp"
#include "common/models/catheter/spec.hpp"

namespace palpate {
namespace {

class TubeShape : public ShapeFrom<CatheterState> {
 public:
  TubeShape(const SurfaceMap& map, const Catheter& catheter)
      : ShapeFrom(map), tube_(catheter.particles, catheter.radius), particles_(catheter.particles) {}

  void rebuild(const ContactsOnBody& contacts, DeformedSurface& surface) override {
    if (!newest()) return BodyShape::rebuild(contacts, surface);
    for (std::size_t i = 0; i < particles_.size(); ++i)
      particles_[i] = Eigen::Map<const Eigen::Vector3d>(&newest()->position[3 * i]) - origin();
    tube_.place(particles_, surface.position, surface.normal);
    for (std::size_t n = 0; n < surface.position.size(); ++n)
      surface.displacement[n] = surface.position[n] - (map().position[n] - origin()).cast<float>();
  }

 private:
  bool is_mine(const CatheterState& state) const override {
    return state.position.size() == 3 * static_cast<std::size_t>(tube_.particles());
  }

  TubeSurface tube_;
  std::vector<Eigen::Vector3d> particles_;  ///< [m] from tail to tip
};

}  // namespace

std::unique_ptr<BodyShape> make_shape(const CatheterSpec& body, const Archive& archive, const StepSettings&) {
  return std::make_unique<TubeShape>(archive.surface, body.catheter);
}

}  // namespace palpate
