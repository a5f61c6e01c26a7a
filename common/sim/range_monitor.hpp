#pragma once
#include <string>
#include <vector>

#include "common/mesh/surface_change.hpp"
#include "common/scene/scene.hpp"
#include "common/sim/deformer.hpp"

namespace palpate {

/// Beyond any of these an answer by superposition is no longer taken for the tissue's; docs/nonlinear.md has the
/// presses from which they come.
inline constexpr double kMaxStretch = 0.2;    // [1] of a triangle of the surface
inline constexpr double kMaxRotation = 0.44;  // [rad] likewise, 25 degrees
inline constexpr double kMaxVolume = 0.02;    // [1] by which the body's volume seems to change

/// How far a body has gone.
struct UsedRange {
  SurfaceChange change;
  double force = 0;  ///< [1] of the forces to which its correction was fitted; 0 without a correction

  bool within() const;
};

/// Watches whether bodies whose shape is superposed stay where linear elasticity holds, and its correction where that
/// is fitted.
class RangeMonitor {
 public:
  RangeMonitor(const Scene& scene, const Deformer& deformer);

  /// Looks at the newest shapes. Returns a sentence for each body that leaves its range for the first time in a run.
  std::vector<std::string> look(const Deformer& deformer);
  /// What is out of its range as of the last look, in one line; empty: nothing.
  std::string warning() const;

  struct Watched {
    std::string name;
    int body;  ///< position in the scene's list
    SurfaceAtRest rest;
    UsedRange now{}, most{};  ///< most: the largest of each so far, of the volume that with the largest size
    bool said = false;        ///< that it left its range, in this run
    bool left = false;        ///< its range, in any run
  };
  const std::vector<Watched>& watched() const { return watched_; }

 private:
  std::vector<Watched> watched_;
  std::uint64_t run_ = 0;
};

}  // namespace palpate
