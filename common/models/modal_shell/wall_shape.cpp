// The shape of a modal wall from its modes' coordinates and the forces on it, as others show it.
#include "common/models/body_shape.hpp"
#include "common/models/modal_shell/modal_shape.hpp"
#include "common/models/modal_shell/spec.hpp"

namespace palpate {
namespace {

class WallShape : public ShapeFrom<ModalState> {
 public:
  explicit WallShape(const Archive& archive) : ShapeFrom(archive.surface), field_(archive) {}

 private:
  bool is_mine(const ModalState& state) const override { return field_.fits(state); }
  void displace(const ContactsOnBody& contacts, std::vector<Eigen::Vector3f>& displacement) override {
    if (newest())
      field_.displace(*newest(), displacement);
    else
      ShapeFrom::displace(contacts, displacement);
  }

  ModalShape field_;
};

}  // namespace

std::unique_ptr<BodyShape> make_shape(const ModalShellSpec&, const Archive& archive, const StepSettings&) {
  return std::make_unique<WallShape>(archive);
}

}  // namespace palpate
