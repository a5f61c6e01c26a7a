#include "render_node/scene_block.hpp"

#include <algorithm>

#include "render_node/camera_axes.hpp"

namespace palpate {
namespace {

using Eigen::Vector3d;

Eigen::Vector4f with_w(const Vector3d& v, double w) {
  return Eigen::Vector4d(v.x(), v.y(), v.z(), w).cast<float>();
}

/// Perspective with y downwards: the first row read back is the upper one. Depth runs from `near` to `far`.
Eigen::Matrix4d projection(double half_width, double half_height, double near, double far) {
  Eigen::Matrix4d p = Eigen::Matrix4d::Zero();
  p(0, 0) = 1 / half_width;
  p(1, 1) = -1 / half_height;
  p(2, 2) = (far + near) / (near - far);
  p(2, 3) = 2 * far * near / (near - far);
  p(3, 2) = -1;
  return p;
}

/// From the world to x right, y up, -z forward.
Eigen::Matrix4d view_matrix(const Vector3d& eye, const Vector3d& right, const Vector3d& up, const Vector3d& forward) {
  Eigen::Matrix3d axes;
  axes << right.transpose(), up.transpose(), -forward.transpose();
  Eigen::Matrix4d view = Eigen::Matrix4d::Identity();
  view.topLeftCorner<3, 3>() = axes;
  view.topRightCorner<3, 1>() = -axes * eye;
  return view;
}

/// The shadow of a shaft is the plane through it and the light; the tip ends it with a disc.
SceneBlock::Tool tool_block(const InstrumentView& tool, const Vector3d& light) {
  const double ahead = 0.75 * tool.jaw_length;  // open jaws cast about the shadow of a narrow end there
  const Vector3d tip = tool.tip * Vector3d(0, 0, ahead);
  const double tip_radius = tool.jaw_length > 0 ? 1.4 * tool.jaw_radius : tool.tip_radius;
  const Vector3d shaft = tool.tip.linear() * Vector3d(0, 0, -tool.shaft_length - ahead);
  const Vector3d to_tip = tip - light, to_end = to_tip + shaft;
  const Vector3d across = to_tip.cross(to_end).normalized();
  Vector3d along = (to_end - to_end.dot(to_tip) / to_tip.squaredNorm() * to_tip).normalized();
  // n . to_tip = n . to_end = 1 in the plane: n is normal to the shaft, scaled by the shaft's distance.
  const Vector3d foot = to_tip - to_tip.dot(shaft) / shaft.squaredNorm() * shaft;
  return {with_w(tip, tip_radius), with_w(shaft, tool.shaft_radius), with_w(across, 1 / shaft.squaredNorm()),
          with_w(along, 0), with_w(foot / std::max(foot.squaredNorm(), 1e-12), 0)};
}

}  // namespace

SceneBlock scene_block(const Frame& frame, int width, int height) {
  const Camera& camera = frame.camera;
  const double reach = (camera.target - camera.eye).norm();
  const auto [right, up, forward, half_height] = axes_of(camera);
  const double half_width = half_height * width / height;

  SceneBlock block{};
  block.view_projection =
      (projection(half_width, half_height, 0.02 * reach, 20 * reach) * view_matrix(camera.eye, right, up, forward))
          .cast<float>();
  block.eye = with_w(camera.eye, reach);
  block.right = with_w(half_width * right, 2 * half_height / height);
  block.up = with_w(half_height * up, frame.legend ? frame.legend->max : 1);
  block.forward = with_w(forward, frame.brightness);
  // The light fibres end beside the lens: a little way off it, small shadows show the shape.
  const Vector3d light = camera.eye + reach * (0.12 * up + 0.08 * right);
  block.light = with_w(light, 0);
  block.viewport = Eigen::Vector4f(width, height, 2.0f / height, -1);
  for (std::size_t i = 0; i < frame.instruments.size(); ++i) block.tools[i] = tool_block(frame.instruments[i], light);
  return block;
}

}  // namespace palpate
