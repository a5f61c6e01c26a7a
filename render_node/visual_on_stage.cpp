#include "render_node/visual_on_stage.hpp"

#include <algorithm>

namespace palpate {

VisualOnStage::VisualOnStage(VisualBody visual, std::span<const Eigen::Vector3d> nodes,
                             const std::array<double, 3>& tissue, const std::filesystem::path& texture,
                             bool by_displacement)
    : shape_(std::move(visual.mesh), std::move(visual.binding), nodes), rest_normal_(shape_.normal()) {
  for (const VisualMesh::Part& part : shape_.mesh().parts) looks_.push_back(look_of(part, tissue));
  if (!visual.texture.empty()) image_ = std::make_shared<const Image>(decode_png(visual.texture, texture));
  if (by_displacement) displacement_.resize(rest_normal_.size());
}

void VisualOnStage::place(std::span<const Eigen::Vector3f> nodes, std::span<const HertzDent> dents) {
  shape_.place(nodes);
  for (const HertzDent& d : dents) dent(d);
  if (!dents.empty()) shape_.find_normals();
  if (displacement_.empty()) return;
  const std::vector<Eigen::Vector3f>&now = shape_.position(), &rest = shape_.mesh().position;
  for (std::size_t v = 0; v < now.size(); ++v) displacement_[v] = (now[v] - rest[v]).norm();
  max_displacement_ = *std::ranges::max_element(displacement_);
}

void VisualOnStage::dent(const HertzDent& dent) {
  const std::vector<Eigen::Vector3f>& rest = shape_.mesh().position;
  for (std::size_t v = 0; v < rest.size(); ++v) {
    const Eigen::Vector3d at = rest[v].cast<double>();
    if (dent.share(at) == 0) continue;
    shape_.positions()[v] += dent.displacement(at, rest_normal_[v].cast<double>()).cast<float>();
  }
}

void VisualOnStage::part(std::span<const int> piece) {
  shape_.part(piece);
  ++cuts_;
}

void VisualOnStage::add_views(int id, int texture, Frame& frame) const {
  const VisualMesh& mesh = shape_.mesh();
  for (std::size_t p = 0; p < looks_.size(); ++p) {
    const VisualMesh::Part& part = mesh.parts[p];
    if (shape_.triangles(p).empty()) continue;
    const auto own = [&](const auto& all) { return std::span(all).subspan(part.first, part.count); };
    MeshView view{.id = id + static_cast<int>(p),
                  .shape = cuts_,
                  .finish = looks_[p].finish,
                  .colour = looks_[p].colour,
                  .rest = own(mesh.position),
                  .position = own(shape_.position()),
                  .normal = own(shape_.normal()),
                  .triangles = shape_.triangles(p)};
    if (!displacement_.empty()) view.scalar = own(displacement_);
    if (part.textured && image_) {
      view.image = own(mesh.image);
      view.texture = {texture, image_->width, image_->height, image_->rgba};
    }
    frame.meshes.push_back(view);
  }
}

}  // namespace palpate
