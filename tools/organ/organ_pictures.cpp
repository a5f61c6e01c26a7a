#include "tools/organ/organ_pictures.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "common/mesh/surface.hpp"
#include "tools/organ/picture_folder.hpp"
#include "tools/organ/slice_pictures.hpp"
#include "tools/organ/surface_picture.hpp"

namespace palpate {
namespace {

const Colour kBorder{1, 1, 0.2f}, kGround{0.05f, 0.05f, 0.05f}, kEdge{0, 0, 0};

/// The image within the solid's box.
struct Section {
  GridShape shape;
  std::array<int, 3> first;  ///< voxel of the image
};

Section section_of(const GridShape& image, const Solid& solid) {
  Section section{image, {}};
  for (int a = 0; a < 3; ++a) {
    const double low = (solid.low[a] - image.origin[a]) / image.spacing[a];
    const double high = (solid.high[a] - image.origin[a]) / image.spacing[a];
    section.first[a] = std::max(0, static_cast<int>(std::ceil(low)));
    section.shape.count[a] = std::min(image.count[a] - 1, static_cast<int>(std::floor(high))) - section.first[a] + 1;
    section.shape.origin[a] += section.first[a] * image.spacing[a];
  }
  return section;
}

/// The part of each voxel of the section, from 1; 0: none of the labels.
class Parts {
 public:
  Parts(const LabelVolume& volume, const std::vector<NamedLabel>& labels, const Section& section)
      : volume_(volume), labels_(labels), first_(section.first) {}

  int at(int i, int j, int k) const {
    const auto& count = volume_.shape.count;
    i += first_[0], j += first_[1], k += first_[2];
    if (std::min({i, j, k}) < 0 || i >= count[0] || j >= count[1] || k >= count[2]) return 0;
    const auto found = std::ranges::find(labels_, label_at(volume_, volume_.shape.index(i, j, k)), &NamedLabel::label);
    return found == labels_.end() ? 0 : static_cast<int>(found - labels_.begin()) + 1;
  }

 private:
  const LabelVolume& volume_;
  const std::vector<NamedLabel>& labels_;
  std::array<int, 3> first_;
};

Image border_picture(const GridShape& shape, const Parts& parts, const Solid& solid, int k) {
  SliceCanvas canvas(shape, [&](int i, int j) {
    const int part = parts.at(i, j, k);
    return part == 0 ? kGround : Colour(0.6f * part_colour(part));
  });
  std::vector<std::pair<int, double>> of_voxel;  // its part, and how deep it lies there
  for (int j = 0; j < shape.count[1]; ++j)
    for (int i = 0; i < shape.count[0]; ++i) {
      const Eigen::Vector3d x = shape.place(i, j, k);
      of_voxel.emplace_back(solid.part(x), solid.depth(x));
    }
  for (int part = 1; part <= solid.parts; ++part) {
    const auto value = [&](int i, int j) {
      const auto& [of, depth] = of_voxel[shape.index(i, j, 0)];
      return of == part ? -depth : depth;
    };
    for (const Contour& line : level_lines(shape.count[0], shape.count[1], value)) canvas.contour(line, kBorder);
  }
  return canvas.image();
}

/// Where the plane z cuts a tetrahedron, in voxels: nothing, a triangle, or four points in order.
Contour cut_of(const GridShape& shape, const TetMesh& mesh, const std::array<int, 4>& corners, double z) {
  std::array<int, 4> sorted = corners;  // those below first
  const auto below =
      std::partition(sorted.begin(), sorted.end(), [&](int n) { return mesh.nodes[n].z() < z; }) - sorted.begin();
  const auto crossing = [&](int a, int b) {
    const Eigen::Vector3d &p = mesh.nodes[sorted[a]], &q = mesh.nodes[sorted[b]];
    const Eigen::Vector3d x = p + (z - p.z()) / (q.z() - p.z()) * (q - p) - shape.origin;
    return Eigen::Vector2d(x.head<2>().cwiseQuotient(shape.spacing.head<2>()));
  };
  if (below == 1) return {crossing(0, 1), crossing(0, 2), crossing(0, 3)};
  if (below == 2) return {crossing(0, 2), crossing(0, 3), crossing(1, 3), crossing(1, 2)};
  if (below == 3) return {crossing(0, 3), crossing(1, 3), crossing(2, 3)};
  return {};
}

Image cut_picture(const GridShape& shape, const FilledSolid& filled, int k) {
  SliceCanvas canvas(shape, [](int, int) { return kGround; });
  std::vector<Contour> cuts;
  for (std::size_t t = 0; t < filled.part.size(); ++t) {
    const Contour cut = cut_of(shape, filled.mesh, filled.mesh.tetrahedra[t], shape.place(0, 0, k).z());
    for (std::size_t c = 2; c < cut.size(); ++c)
      canvas.triangle(cut[0], cut[c - 1], cut[c], part_colour(filled.part[t]));
    cuts.push_back(cut);
  }
  for (const Contour& cut : cuts) canvas.contour(cut, kEdge);
  return canvas.image();
}

/// The faces between voxels of different parts, seen from outside all of them.
PartSurface voxel_surface(const GridShape& shape, const Parts& parts) {
  PartSurface surface;
  const auto add = [&](const Eigen::Vector3d& voxel, int axis, int side, int part) {
    const Eigen::Vector3d normal = side * Eigen::Vector3d::Unit(axis);
    const Eigen::Vector3d u = Eigen::Vector3d::Unit((axis + 1) % 3), v = side * Eigen::Vector3d::Unit((axis + 2) % 3);
    const int first = static_cast<int>(surface.mesh.nodes.size());
    const Eigen::Vector3d a = normal - u - v, b = normal + u - v, c = normal + u + v, d = normal - u + v;
    for (const Eigen::Vector3d& corner : {a, b, c, d})
      surface.mesh.nodes.push_back(shape.origin + shape.spacing.cwiseProduct(voxel + 0.5 * corner));
    surface.mesh.triangles.push_back({first, first + 1, first + 2});
    surface.mesh.triangles.push_back({first, first + 2, first + 3});
    surface.part.insert(surface.part.end(), 2, part);
  };
  for (int k = 0; k < shape.count[2]; ++k)
    for (int j = 0; j < shape.count[1]; ++j)
      for (int i = 0; i < shape.count[0]; ++i) {
        const int part = parts.at(i, j, k);
        for (int f = 0; part != 0 && f < 6; ++f) {
          const int axis = f / 2, side = f % 2 == 0 ? -1 : 1;
          const int beyond = parts.at(i + (axis == 0) * side, j + (axis == 1) * side, k + (axis == 2) * side);
          if (beyond == 0) add(Eigen::Vector3d(i, j, k), axis, side, part);
        }
      }
  return surface;
}

PartSurface mesh_surface(const FilledSolid& filled) {
  const Surface surface = extract_surface(filled.mesh);
  PartSurface result{{filled.mesh.nodes, surface.triangles}, {}};
  for (const int t : surface.tetrahedra) result.part.push_back(filled.part[t]);
  return result;
}

}  // namespace

void write_organ_pictures(const LabelVolume& volume, const std::vector<NamedLabel>& labels, const Solid& solid,
                          const FilledSolid& filled, const std::filesystem::path& folder) {
  make_picture_folder(folder);
  const Section section = section_of(volume.shape, solid);
  const GridShape& shape = section.shape;
  const Parts parts(volume, labels, section);
  for (int k = 0; k < shape.count[2]; ++k)
    write_png(side_by_side(border_picture(shape, parts, solid, k), cut_picture(shape, filled, k)),
              folder / fmt::format("slice_{:04}.png", k + section.first[2]));
  write_png(side_by_side(surface_picture(voxel_surface(shape, parts), solid.low, solid.high),
                         surface_picture(mesh_surface(filled), solid.low, solid.high)),
            folder / "surface.png");
}

}  // namespace palpate
