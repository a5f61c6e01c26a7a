#include "common/mesh/obj_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <stdexcept>
#include <unordered_map>

#include "common/describe/printable.hpp"
#include "common/mesh/text_lines.hpp"

namespace palpate {
namespace {

/// A corner of a face: places in the lists of positions and of texture coordinates; -1: none of these.
struct Corner {
  int position, image;
};

class ObjReader {
 public:
  ObjReader(const std::filesystem::path& file, double scale, const std::optional<ObjMaterials>& materials, bool image,
            const Eigen::Vector3d& origin)
      : lines_(file), scale_(scale), materials_(materials), image_(image), origin_(origin) {}

  VisualMesh read() {
    while (lines_.next()) take_line();
    if (triangles_ == 0) lines_.refuse("the file ends without a face");
    lay_out();
    return std::move(mesh_);
  }

 private:
  /// A part while it grows; its vertices by their corner.
  struct Growing {
    VisualMesh::Part part;
    std::vector<Corner> corners;
    std::unordered_map<std::uint64_t, int> vertex;
  };

  void take_line() {
    const std::string_view key = lines_.key();
    if (key == "v")
      take_position();
    else if (key == "vt")
      take_image_place();
    else if (key == "usemtl")
      material_ = lines_.rest();
    else if (key == "f")
      take_face();
  }

  void take_position() {
    Eigen::Vector3d p;
    for (double& x : p) x = scale_ * lines_.number();
    if (!p.cast<float>().allFinite()) lines_.refuse("a place lies too far away to be drawn");
    positions_.emplace_back((p - origin_).cast<float>());
  }

  void take_image_place() {
    const double u = lines_.number();
    const double v = lines_.number_if_any().value_or(0);
    image_places_.push_back(Eigen::Vector2d(u, 1 - v).cast<float>());
  }

  void take_face() {
    face_.clear();
    for (std::string_view word = lines_.word(); !word.empty(); word = lines_.word()) face_.push_back(corner(word));
    if (face_.size() < 3) lines_.refuse(fmt::format("a face has {} corners, and needs 3", face_.size()));
    const bool placed = std::ranges::all_of(face_, [](const Corner& c) { return c.image >= 0; });
    Growing& to = part_for(placed);
    for (std::size_t k = 2; k < face_.size(); ++k) add_triangle(to, face_[0], face_[k - 1], face_[k]);
  }

  /// "7", "7/2", "7/2/5" or "7//5"; from 1, or backwards from -1.
  Corner corner(std::string_view word) {
    const std::size_t slash = word.find('/');
    const std::string_view behind = slash == word.npos ? std::string_view() : word.substr(slash + 1);
    const std::string_view image = behind.substr(0, behind.find('/'));
    return {index(word.substr(0, slash), positions_.size(), "vertices"),
            image.empty() ? -1 : index(image, image_places_.size(), "texture coordinates")};
  }

  int index(std::string_view text, std::size_t count, std::string_view things) {
    long long number = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    if (error != std::errc() || end != text.data() + text.size())
      lines_.refuse(fmt::format("\"{}\" stands where a face's corner should", printable(text.substr(0, 20))));
    const long long known = static_cast<long long>(count), place = number < 0 ? known + number : number - 1;
    if (place < 0 || place >= known)
      lines_.refuse(fmt::format("a face asks for number {} of {} {} above it", number, known, things));
    return static_cast<int>(place);
  }

  Growing& part_for(bool placed) {
    ObjMaterial material;
    if (materials_ && !material_.empty()) {
      const auto found = materials_->find(material_);
      if (found == materials_->end())
        lines_.refuse(fmt::format("the material '{}' is not in the file of materials", printable(material_)));
      material = found->second;
      if (material.textured && !image_)
        lines_.refuse(fmt::format("the material '{}' wears an image: name it as the scene's 'texture'", material_));
    } else {
      material.textured = image_;
    }
    const bool textured = material.textured && placed;
    const auto same = [&](const Growing& g) { return g.part.material == material_ && g.part.textured == textured; };
    const auto found = std::ranges::find_if(parts_, same);
    if (found != parts_.end()) return *found;
    return parts_.emplace_back(
        Growing{{material_, textured ? std::nullopt : material.colour, textured, 0, 0, {}}, {}, {}});
  }

  void add_triangle(Growing& to, Corner a, Corner b, Corner c) {
    if (++triangles_ > kMaxVisualTriangles)
      lines_.refuse(fmt::format("a visual surface has {} triangles at most", kMaxVisualTriangles));
    to.part.triangles.push_back({vertex(to, a), vertex(to, b), vertex(to, c)});
  }

  static int vertex(Growing& to, Corner corner) {
    const std::uint64_t key =
        static_cast<std::uint64_t>(corner.position) << 32 | static_cast<std::uint32_t>(corner.image);
    const auto [entry, is_new] = to.vertex.try_emplace(key, static_cast<int>(to.corners.size()));
    if (is_new) to.corners.push_back(corner);
    return entry->second;
  }

  void lay_out() {
    for (Growing& growing : parts_) {
      VisualMesh::Part& part = mesh_.parts.emplace_back(std::move(growing.part));
      part.first = static_cast<int>(mesh_.position.size());
      part.count = static_cast<int>(growing.corners.size());
      for (const Corner& corner : growing.corners) {
        mesh_.position.push_back(positions_[corner.position]);
        mesh_.image.push_back(corner.image < 0 ? Eigen::Vector2f::Zero() : image_places_[corner.image]);
      }
    }
    join_places(mesh_);
  }

  TextLines lines_;
  double scale_;
  const std::optional<ObjMaterials>& materials_;
  bool image_;
  Eigen::Vector3d origin_;
  std::string material_;
  std::vector<Eigen::Vector3f> positions_;
  std::vector<Eigen::Vector2f> image_places_;
  std::vector<Corner> face_;
  std::vector<Growing> parts_;
  std::size_t triangles_ = 0;
  VisualMesh mesh_;
};

}  // namespace

VisualMesh load_obj(const std::filesystem::path& file, double scale, const std::optional<ObjMaterials>& materials,
                    bool image, const Eigen::Vector3d& origin) {
  return ObjReader(file, scale, materials, image, origin).read();
}

}  // namespace palpate
