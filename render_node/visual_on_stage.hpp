#pragma once
#include <memory>
#include <span>
#include <vector>

#include "common/contact/patch/hertz_dent.hpp"
#include "common/mesh/visual_shape.hpp"
#include "common/view/draw_list.hpp"
#include "common/view/visual_body.hpp"
#include "render_node/image.hpp"

namespace palpate {

/// The visual surface of a body as it is to be seen now.
class VisualOnStage {
 public:
  /// `tissue`: linear RGB of parts without a colour; `texture`: where the image's name is said if it is none;
  /// `by_displacement`: whether that colours it. Throws as decode_png().
  VisualOnStage(VisualBody visual, std::span<const Eigen::Vector3d> nodes, const std::array<double, 3>& tissue,
                const std::filesystem::path& texture, bool by_displacement);

  /// Follows the body's nodes [m], and what is finer than these.
  void place(std::span<const Eigen::Vector3f> nodes, std::span<const HertzDent> dents);
  /// As VisualShape::part().
  void part(std::span<const int> piece);
  float max_displacement() const { return max_displacement_; }  ///< [m] of its vertices; 0 unless that colours it

  /// Appends a mesh for each part, with numbers from `id` on; the image has the number `texture`.
  void add_views(int id, int texture, Frame& frame) const;
  int parts() const { return static_cast<int>(looks_.size()); }

 private:
  void dent(const HertzDent& dent);

  VisualShape shape_;
  std::vector<PartLook> looks_;
  std::shared_ptr<const Image> image_;  ///< null: none
  std::vector<Eigen::Vector3f> rest_normal_;
  std::vector<float> displacement_;  ///< [m] per vertex; empty unless that colours it
  float max_displacement_ = 0;
  std::uint64_t cuts_ = 0;
};

}  // namespace palpate
