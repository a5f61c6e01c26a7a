#pragma once
#include "common/tool/devices/kind.hpp"

namespace palpate {

/// A device whose motion is in a file: all that its kinds share.
struct MotionFileSpec {
  std::filesystem::path trajectory;
};

inline void describe(Description& d, MotionFileSpec& m) {
  d.file({"trajectory", "", "CSV for `\"scripted\"` and `\"hand\"`, an LCM event log for `\"log\"`", Need::required,
          Use::local},
         m.trajectory);
}

inline std::filesystem::path motion_file(const MotionFileSpec& spec) {
  return spec.trajectory;
}
inline std::optional<Trajectory> script(const MotionFileSpec& spec) {
  return load_trajectory(spec.trajectory);
}
constexpr ForHands for_hands(const MotionFileSpec&) {
  return ForHands::if_asked;
}
constexpr std::string_view absence(const MotionFileSpec&) {
  return {};
}

}  // namespace palpate
