#pragma once
#include "common/view/draw_list.hpp"

namespace palpate {

inline constexpr int kMaxTools = 8;

/// The uniform block of shaders/scene.glsl, where its fields are explained.
struct SceneBlock {
  struct Tool {
    Eigen::Vector4f tip, shaft, across, along, near;
  };
  Eigen::Matrix4f view_projection;
  Eigen::Vector4f eye, right, up, forward, light, viewport;
  Tool tools[kMaxTools];
};
static_assert(sizeof(SceneBlock) == 64 + 6 * 16 + kMaxTools * 5 * 16);

/// Throws std::runtime_error if the camera looks nowhere.
SceneBlock scene_block(const Frame& frame, int width, int height);

}  // namespace palpate
