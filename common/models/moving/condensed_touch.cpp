#include "common/models/moving/condensed_touch.hpp"

#include <algorithm>
#include <stdexcept>

#include "common/contact/patch/patch_parts.hpp"

namespace palpate {
namespace {

SurfaceMap quasi_static_surface(const Archive& archive) {
  if (!archive.condensed) throw std::runtime_error("the archive has no condensed part");
  SurfaceMap map = archive.surface;
  map.triangles.resize(archive.condensed->quasi_static_triangles);
  return map;
}

// Of parts that press by a patch.
ToolContacts::Options beside_patches(const StepSettings& settings) {
  ToolContacts::Options options;
  if (settings.contact.rule == ContactRule::patch)
    options.elsewhere = [parts = patch_parts(settings.tools, true)](int tool, int part, int) {
      return std::ranges::any_of(parts, [&](const PatchPart& p) { return p.tool == tool && p.part == part; });
    };
  return options;
}

}  // namespace

CondensedTouch::CondensedTouch(const Archive& archive, const StepSettings& settings, bool single, DynamicModel& model)
    : model_(model),
      map_(quasi_static_surface(archive)),
      part_(archive, settings.contact.friction, single),
      surface_(map_, bucket_size(settings.contact, map_)),
      contacts_(surface_, part_.law(), parts_of(settings.tools), beside_patches(settings)),
      moved_(map_.size(), Eigen::Vector3f::Zero()) {
  part_.couple(model);
  displacement_.reserve(3 * map_.size());
  take();
}

bool CondensedTouch::grasping(int tool) const {
  return part_.law().grasps(tool);
}

void CondensedTouch::drop_tool(int tool) {
  for (int i = static_cast<int>(contacts().size()) - 1; i >= 0; --i)
    if (contacts()[i].is_by(tool)) part_.law().remove(i);
}

void CondensedTouch::find(std::span<const MovingTool> tools) {
  const std::span<const int> marked = mark(surface_, contacts_, part_.law(), tools);
  part_.update(marked);
  displacement_.clear();
  for (int node : marked) {
    const Eigen::Vector3d u = part_.positions()[node] - map_.position[node];
    displacement_.insert(displacement_.end(), u.data(), u.data() + 3);
  }
  surface_.move_marked(displacement_);
  contacts_.collide(tools);
}

void CondensedTouch::hold(std::span<const MovingTool> tools) {
  contacts_.aim(tools);
  part_.hold();
  for (std::size_t k = 0; k < part_.connection().size(); ++k)
    model_.set_load(part_.connection()[k], part_.load(static_cast<int>(k)));
}

void CondensedTouch::shape(std::span<const Eigen::Vector3d> rest, const Eigen::Vector3d& origin,
                           std::span<Eigen::Vector3f> position) {
  part_.superpose(moved_);
  for (int n = 0; n < map_.size(); ++n)
    if (part_.owns(n)) position[n] = (rest[n] - origin).cast<float>() + moved_[n];
}

void CondensedTouch::state(State& s, std::span<const MovingTool> tools) {
  surface_.state(s);
  contacts_.state(s, tools);
  std::vector<Eigen::Vector3d> forces;
  if (!s.restoring())
    for (std::size_t c = 0; c < contacts().size(); ++c) forces.push_back(force(static_cast<int>(c)));
  s.list(forces);
  s.require(forces.size() == contacts().size(), "the recorded state is of another body");
  if (s.restoring()) part_.adopt(model_, forces);
}

}  // namespace palpate
