#pragma once
#include <array>
#include <vector>

#include "common/archive/archive.hpp"
#include "common/models/catheter/catheter_body.hpp"
#include "common/scene/scene.hpp"

namespace palpate::study {

/// The scene's catheter in ticks of `tick` [s].
CatheterSettings catheter_settings(const Scene& scene, int catheter, double tick);

/// A catheter that is led into its duct as a forceps would: held at a point before the mouth, which goes forward along
/// the catheter and aside by four of its radii, so that it leans on the wall; then it rests. Both move as they do in a
/// haptic step.
class Insertion {
 public:
  static constexpr double kFeedSeconds = 0.6, kSeconds = 1;

  Insertion(const Scene& scene, int catheter);

  /// Force of the catheter on the wall [N] and length in the lumen [m] at every `interval` [s], in ticks of `tick` [s].
  /// `scene`: this one, with another setting of the catheter. Times [s] of the catheter's own ticks go into `times`
  /// unless that is null.
  std::vector<std::array<double, 2>> course(const Scene& scene, double tick, double interval,
                                            std::vector<double>* times = nullptr) const;

 private:
  int catheter_, duct_;
  Archive archive_;
  double feed_ = 0;  ///< [m]
};

}  // namespace palpate::study
