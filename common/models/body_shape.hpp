#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <vector>

#include "common/archive/archive.hpp"
#include "common/contact/body_message.hpp"
#include "common/contact/patch/hertz_dent.hpp"
#include "common/mesh/near_origin.hpp"

namespace palpate {

/// The visible surface of one body as it is now.
struct DeformedSurface {
  std::vector<Eigen::Vector3f> position;      ///< [m] world, per surface node, from BodyShape::origin() on
  std::vector<Eigen::Vector3f> displacement;  ///< [m]; of a catheter, from its rest shape
  std::vector<Eigen::Vector3f> normal;        ///< unit, outward
};

/// The contacts of a scene as a body's shape looks at them.
struct ContactsOnBody {
  const std::map<std::uint32_t, ContactState>& of_tool;  ///< the newest of each tool
  std::uint32_t body;                                    ///< whose contacts count
};

/// Rebuilds the visible surface of one body, in single precision, from what the haptic node says of it. As it is here,
/// the body stays at rest.
class BodyShape {
 public:
  explicit BodyShape(SurfaceMap map) : map_(std::move(map)), origin_(near_origin(map_.position)) {}
  virtual ~BodyShape() = default;

  const SurfaceMap& map() const { return map_; }
  const Eigen::Vector3d& origin() const { return origin_; }  ///< [m] world, near the body

  /// Whether it follows from contacts.
  virtual bool superposed() const { return false; }
  /// [1] Largest force of a tool in the last rebuild(), of those to which the body's correction was fitted; 0 without a
  /// correction.
  virtual double used_force() const { return 0; }
  /// Of the last rebuild(): dents that its surface shows at the nodes, and that are finer than its triangles.
  virtual std::span<const HertzDent> dents() const { return {}; }
  /// Whether it follows from messages of this type.
  virtual bool hears(const BodyMessage&) const { return false; }
  /// Whether a message of that type is of this body: as many modes or particles, known nodes.
  virtual bool fits(const BodyMessage&) const { return false; }
  /// Keeps a message that fits for the next rebuild().
  virtual void take(const BodyMessage&) {}
  /// Back to rest: another run of the haptic loop has begun.
  virtual void reset() {}

  /// Fills a surface whose lists have one entry a node.
  virtual void rebuild(const ContactsOnBody& contacts, DeformedSurface& surface);

 protected:
  /// Fills the displacement [m] of every surface node.
  virtual void displace(const ContactsOnBody& contacts, std::vector<Eigen::Vector3f>& displacement);

 private:
  SurfaceMap map_;
  Eigen::Vector3d origin_;
};

/// A shape that follows from the newest message of one type.
template <class Message>
class ShapeFrom : public BodyShape {
 public:
  using BodyShape::BodyShape;

  bool hears(const BodyMessage& message) const final { return std::holds_alternative<Message>(message); }
  bool fits(const BodyMessage& message) const final { return hears(message) && is_mine(std::get<Message>(message)); }
  void take(const BodyMessage& message) final { newest_ = std::get<Message>(message); }
  void reset() final { newest_.reset(); }

 protected:
  const std::optional<Message>& newest() const { return newest_; }  ///< empty: at rest

 private:
  virtual bool is_mine(const Message& message) const = 0;

  std::optional<Message> newest_;
};

}  // namespace palpate
