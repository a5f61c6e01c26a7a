#pragma once
namespace palpate {

/// Where the contact of patches with moving tissue has been tried and found stable (docs/stability.md), of linear
/// elements that do not turn with it: what the stability cases draw from, and beyond which a check of a scene says so.
struct TriedContact {
  static constexpr double kMinYoung = 1e2, kMaxYoung = 1e8;   ///< [Pa]
  static constexpr double kMaxPoisson = 0.45;                 ///< [1]
  static constexpr double kMinCell = 40e-6, kMaxCell = 0.05;  ///< [m] edge of the surface
  static constexpr double kMinRadius = 0.2, kMaxRadius = 4;   ///< [1] of the edge
  static constexpr double kMaxShaft = 1;                      ///< [1] radius of a shaft, of the edge
  static constexpr double kMaxDepth = 0.3;                    ///< [1] of a tip's radius
  static constexpr double kMaxFriction = 1;                   ///< [1]
  static constexpr double kMaxSpeed = 1;                      ///< [m/s] of the tip
  static constexpr double kMaxSteps = 300;                    ///< [1] of the tissue in a tick
};

}  // namespace palpate
