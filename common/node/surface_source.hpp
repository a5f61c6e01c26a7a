#pragma once
#include <memory>
#include <span>

#include "common/bus/bus.hpp"
#include "common/bus/presence.hpp"
#include "common/sim/deformer.hpp"
#include "common/sim/range_monitor.hpp"

namespace palpate {

/// Where the shape of the bodies comes from.
class SurfaceSource {
 public:
  struct Shape {
    std::span<const Eigen::Vector3f> position;  ///< [m] per surface node of the archive, from the source's origin on
    std::span<const Eigen::Vector3f> normal;    ///< unit, outward
    std::span<const HertzDent> dents = {};  ///< from there too, that the nodes show as far as they can; of shapes of
                                            ///< this process
  };
  virtual ~SurfaceSource() = default;
  virtual bool update() = 0;                ///< takes what has come; true if a newer haptic step is shown
  virtual void watch(std::int64_t) {}       ///< of a live system, after update(): whether its haptic node is there
  virtual Shape shape(int body) const = 0;  ///< empty spans: not known yet, so at rest
  /// The haptic step shown.
  struct Moment {
    std::uint64_t run = 0, step = 0;  ///< run 0: rest shape
    std::int64_t sense_ns = 0;        ///< on the haptic node's clock
  };
  virtual Moment moment() const = 0;
  /// How far shapes that are superposed in this process have gone; null: that is another's to say.
  virtual const RangeMonitor* range() const { return nullptr; }
  virtual std::uint64_t refused() const = 0;  ///< samples of foreign runs, or that do not fit the archives
};

/// Surfaces published by a deform node. `nodes`: surface nodes per body. `origin` [m]: where to count places from, near
/// the bodies.
std::unique_ptr<SurfaceSource> receive_surfaces(Bus& bus, const Presence& presence, std::vector<std::size_t> nodes,
                                                const Eigen::Vector3d& origin = Eigen::Vector3d::Zero());

/// Superposes the received contacts in this process, and keeps them for a haptic node that dies and comes
/// back.
std::unique_ptr<SurfaceSource> deform_surfaces(const Scene& scene, Bus& bus, const Presence& presence,
                                               Deformer deformer,
                                               const Eigen::Vector3d& origin = Eigen::Vector3d::Zero());

}  // namespace palpate
