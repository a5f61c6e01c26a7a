#include "common/sim/felt_part.hpp"

#include "common/geometry/arrays.hpp"
#include "common/sim/contact_stiffness.hpp"

namespace palpate {
namespace {

constexpr int kCondensedFor = 16;  // ticks for which the contacts' stiffness holds while they stay the same

/// What moves with inertia; its stiffness is that of the whole organ, as it is known.
class MovingFelt final : public FeltPart {
 public:
  MovingFelt(const DynamicOrgan& organ, const LocalStiffness& known) : organ_(organ), known_(known) {}

  const ContactSurface& surface() const override { return organ_.surface(); }
  std::span<const int> find(const Segment& axis, double radius) const override {
    return organ_.surface().find(axis.start, axis.end, radius);
  }
  void fill(int node, LocalNode& out) const override {
    copy(organ_.surface().positions()[node], out.position);
    copy(organ_.model().velocity(node), out.velocity);
    const LocalStiffness::Answer& answer = known_.current();
    const int place = answer.find(node);
    if (place < 0) return;
    Eigen::Matrix3d c = answer.block(place, place);
    c.diagonal().array() += 1e-6 * c.trace() + 1e-12;
    copy(Eigen::Matrix3d(c.inverse()), out.stiffness);
  }

  std::span<const TouchContact> contacts() const override { return organ_.contacts(); }
  Eigen::Vector3d position(const Anchor& anchor) const override {
    Eigen::Vector3d position = Eigen::Vector3d::Zero();
    for (int v = 0; v < 3; ++v)
      if (anchor.weights[v] != 0) position += anchor.weights[v] * organ_.position(anchor.nodes[v]);
    return position;
  }
  Eigen::Vector3d force(int contact) const override { return contacts()[contact].force; }
  void condense() override {
    std::vector<std::array<int, 5>> shape;
    for (const TouchContact& c : contacts())
      shape.push_back(
          {c.tool_point().tool, static_cast<int>(c.touch), c.anchor.nodes[0], c.anchor.nodes[1], c.anchor.nodes[2]});
    if (shape == shape_ && ++age_ < kCondensedFor) return;
    shape_ = std::move(shape);
    age_ = 0;
    stiffness_ = contact_stiffness(known_.current(), contacts());
  }
  void forget() override { shape_.clear(); }
  Eigen::Matrix3d stiffness(int contact) const override { return stiffness_[contact]; }

  void state(State& s) override {
    s.list(stiffness_);
    s.list(shape_);
    s.value(age_);
  }

 private:
  const DynamicOrgan& organ_;
  const LocalStiffness& known_;
  std::vector<Eigen::Matrix3d> stiffness_;  ///< [N/m] per contact
  std::vector<std::array<int, 5>> shape_;   ///< what it was worked out for
  int age_ = 0;
};

/// What moves at once; its stiffness is its own, with the connection nodes standing still.
class CondensedFelt final : public FeltPart {
 public:
  explicit CondensedFelt(const CondensedTouch& touch) : touch_(touch) {}

  const ContactSurface& surface() const override { return touch_.surface(); }
  std::span<const int> find(const Segment& axis, double radius) const override {
    return touch_.surface().find(axis, axis, radius);
  }
  void fill(int node, LocalNode& out) const override {
    copy(touch_.surface().positions()[node], out.position);
    copy(touch_.part().stiffness(node), out.stiffness);
  }

  std::span<const TouchContact> contacts() const override { return touch_.contacts(); }
  Eigen::Vector3d position(const Anchor& anchor) const override {
    return anchor_position(anchor, touch_.part().positions());
  }
  Eigen::Vector3d force(int contact) const override { return touch_.force(contact); }
  Eigen::Matrix3d stiffness(int contact) const override {
    const TouchContact& c = contacts()[contact];
    Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
    for (int v = 0; v < 3; ++v) sum += c.anchor.weights[v] * touch_.part().stiffness(c.anchor.nodes[v]);
    if (c.touch != Touch::sliding) return sum;
    return c.normal * c.normal.dot(sum * c.normal) * c.normal.transpose();
  }

 private:
  const CondensedTouch& touch_;
};

}  // namespace

std::vector<std::unique_ptr<FeltPart>> felt_parts(const DynamicOrgan& organ, const LocalStiffness& known) {
  std::vector<std::unique_ptr<FeltPart>> parts;
  parts.push_back(std::make_unique<MovingFelt>(organ, known));
  if (organ.condensed_part()) parts.push_back(std::make_unique<CondensedFelt>(*organ.condensed_part()));
  return parts;
}

}  // namespace palpate
