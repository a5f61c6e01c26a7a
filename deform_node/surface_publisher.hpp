#pragma once
#include <Eigen/Core>
#include <memory>
#include <span>
#include <vector>

#include "common/bus/bus.hpp"
#include "common/sim/deformer.hpp"
#include "common/sim/tissue_time.hpp"

namespace palpate {

/// Publishes the shapes of a scene's bodies, in messages whose memory is kept.
class SurfacePublisher {
 public:
  SurfacePublisher(Bus& bus, const Deformer& deformer);

  /// The newest step shown, and of which time the tissue is, if it moves.
  struct Moment {
    std::uint64_t run = 0, step = 0;
    std::int64_t sense_ns = 0;
    TissueTime tissue = {};
  };
  struct Shape {
    Eigen::Vector3d origin;                             ///< [m] world, near the body
    std::span<const Eigen::Vector3f> position, normal;  ///< [m] from there on, unit
  };
  void publish(int body, const Shape& shape, const Moment& moment);
  std::int64_t last_publish_ns() const { return last_ns_; }
  bool delivered() const { return writer_->delivered(); }  ///< every viewer has what was published

 private:
  std::unique_ptr<Writer<SurfaceState>> writer_;
  std::vector<SurfaceState> messages_;
  std::int64_t last_ns_ = 0;
};

}  // namespace palpate
