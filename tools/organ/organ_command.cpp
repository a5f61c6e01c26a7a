#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <charconv>
#include <filesystem>
#include <memory>
#include <set>
#include <stdexcept>

#include "common/mesh/quality.hpp"
#include "common/mesh/surface.hpp"
#include "tools/organ/commands.hpp"
#include "tools/organ/fineness_options.hpp"
#include "tools/organ/label_solid.hpp"
#include "tools/organ/organ_pictures.hpp"
#include "tools/organ/surface_library.hpp"
#include "tools/organ/surface_shells.hpp"

namespace palpate {
namespace {

struct OrganOptions : MeshOptions {
  OrganOptions() { nodes = 2500; }
  std::string volume, preview;
  std::vector<std::string> labels;
  double smoothing = 1;
};

/// "255" or "255=liver".
NamedLabel parse_label(const std::string& text) {
  const std::string number = text.substr(0, text.find('='));
  NamedLabel label{0, number.size() < text.size() ? text.substr(number.size() + 1) : "label" + number};
  const auto [end, error] = std::from_chars(number.data(), number.data() + number.size(), label.label);
  if (error != std::errc() || end != number.data() + number.size() || label.name.empty())
    throw std::runtime_error(fmt::format("--label {}: NUMBER or NUMBER=NAME is asked for", text));
  return label;
}

std::vector<NamedLabel> labels_of(const OrganOptions& o) {
  std::vector<NamedLabel> labels;
  std::set<int> numbers;
  std::set<std::string> names;
  for (const std::string& text : o.labels) {
    labels.push_back(parse_label(text));
    if (!numbers.insert(labels.back().label).second || !names.insert(labels.back().name).second)
      throw std::runtime_error(fmt::format("--label {}: there are two of that number or name", text));
  }
  return labels;
}

/// A group of tetrahedra for each label.
void name_parts(FilledSolid& filled, const std::vector<NamedLabel>& labels) {
  if (labels.size() < 2) return;
  for (std::size_t l = 0; l < labels.size(); ++l) {
    MeshGroup group;
    std::set<int> nodes;
    for (std::size_t t = 0; t < filled.part.size(); ++t) {
      if (filled.part[t] != static_cast<int>(l) + 1) continue;
      group.tetrahedra.push_back(static_cast<int>(t));
      nodes.insert(filled.mesh.tetrahedra[t].begin(), filled.mesh.tetrahedra[t].end());
    }
    if (group.tetrahedra.empty())
      throw std::runtime_error(fmt::format("nothing is left of '{}': ask for shorter edges", labels[l].name));
    group.nodes.assign(nodes.begin(), nodes.end());
    filled.mesh.groups[labels[l].name] = group;
  }
}

/// How far the mesh's surface and the voxels' border are apart, both ways.
void print_distance(const LabelSolid& labels, const TetMesh& mesh, double diagonal) {
  const Surface surface = extract_surface(mesh);
  const SurfaceTree tree({mesh.nodes, surface.triangles});
  double sum = 0, largest = 0;
  Eigen::Vector3d where = mesh.nodes[0];
  const auto note = [&](double distance, const Eigen::Vector3d& x) {
    if (distance > largest) largest = distance, where = x;
  };
  for (const Eigen::Vector3d& x : labels.border) {
    const double distance = tree.distance(x);
    sum += distance;
    note(distance, x);
  }
  for (const auto& [a, b, c] : surface.triangles) {
    const Eigen::Vector3d middle = (mesh.nodes[a] + mesh.nodes[b] + mesh.nodes[c]) / 3;
    note(labels.from_voxels(middle), middle);
  }
  const double mean = sum / static_cast<double>(labels.border.size());
  fmt::print(
      "  surface to voxels: mean {:.3g} mm, largest {:.3g} mm, which are {:.2f} and {:.2f} voxel diagonals, at {}\n",
      1e3 * mean, 1e3 * largest, mean / diagonal, largest / diagonal, place_in_mm(where));
}

void print_volumes(const LabelSolid& solid, const FilledSolid& filled, const std::vector<NamedLabel>& labels) {
  std::vector<double> volumes(labels.size(), 0);
  for (std::size_t t = 0; t < filled.part.size(); ++t)
    volumes[filled.part[t] - 1] += tet_volume(filled.mesh, filled.mesh.tetrahedra[t]);
  for (std::size_t l = 0; l < labels.size(); ++l)
    fmt::print("  '{}': {:.4g} ml, of its voxels {:.4g} ml ({:+.2f} %)\n", labels[l].name, 1e6 * volumes[l],
               1e6 * solid.volumes[l], 100 * (volumes[l] / solid.volumes[l] - 1));
}

void make_organ(const OrganOptions& o) {
  Fineness fineness = fineness_of(o);
  const std::vector<NamedLabel> labels = labels_of(o);
  say_progress("reading the image");
  const LabelVolume volume = read_label_volume(o.volume);
  const GridShape& shape = volume.shape;
  const Eigen::Vector3d mm = 1e3 * shape.spacing;
  fmt::print("{}: {} x {} x {} voxels of {:.4g} x {:.4g} x {:.4g} mm\n", o.volume, shape.count[0], shape.count[1],
             shape.count[2], mm.x(), mm.y(), mm.z());
  say_progress("measuring distances to the labels' borders");
  const LabelSolid solid = [&] {
    try {
      return solid_of(volume, labels, o.smoothing);
    } catch (const std::runtime_error& error) {
      throw std::runtime_error(fmt::format("{}: {}", o.volume, error.what()));
    }
  }();
  for (const std::string& finding : solid.findings) fmt::print("  found: {}\n", finding);
  std::fflush(stdout);
  if (fineness.deviation == 0) fineness.deviation = 0.6 * volume.diagonal();
  FilledSolid filled = make_organ_mesh(solid.solid, solid.measures, fineness, say_progress);
  name_parts(filled, labels);
  if (!o.preview.empty()) {
    say_progress("drawing slices and surface");
    write_organ_pictures(volume, labels, solid.solid, filled, o.preview);
  }
  print_volumes(solid, filled, labels);
  print_distance(solid, filled.mesh, volume.diagonal());
  for (Eigen::Vector3d& x : filled.mesh.nodes) x = volume.turn * x + volume.shift;
  finish_mesh(std::move(filled.mesh), o);
}

}  // namespace

void add_organ_command(cli::Command& app) {
  cli::Command command =
      app.add_command("organ", "Make a mesh of tetrahedra of labels in an image (INR, NIfTI, MetaImage, NRRD, DICOM)");
  auto o = std::make_shared<OrganOptions>();
  command.add_option("VOLUME", o->volume, "Image file, or a folder with a DICOM series").required();
  command
      .add_option("--label", o->labels,
                  "Value of the organ's voxels, and its name: NUMBER or NUMBER=NAME; several make one mesh of several "
                  "groups that share their borders")
      .required()
      .one_value_each_time();
  command.add_option("--smoothing", o->smoothing, "Over how many voxels the border is smoothed")
      .between(0.0, 5.0)
      .show_default();
  command.add_option("--preview", o->preview,
                     "Folder for pictures: each slice with the smoothed border and the tetrahedra cut there, the "
                     "surface of the voxels and that of the mesh");
  add_mesh_options(command, *o);
  command.examples(
      {"palpate organ liver.inr.gz --label 255=liver --label 85=gall_bladder --group attachment=above:z -o organ.msh"});
  command.does([o] { make_organ(*o); });
}

}  // namespace palpate
