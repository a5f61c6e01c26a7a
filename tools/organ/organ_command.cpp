#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <charconv>
#include <filesystem>
#include <memory>
#include <set>
#include <stdexcept>

#include "tools/organ/commands.hpp"
#include "tools/organ/fineness_options.hpp"
#include "tools/organ/idle_places.hpp"
#include "tools/organ/label_measures.hpp"
#include "tools/organ/mesh_distances.hpp"
#include "tools/organ/organ_pictures.hpp"
#include "tools/organ/organ_visual.hpp"
#include "tools/organ/picture_folder.hpp"
#include "tools/organ/places.hpp"

namespace palpate {
namespace {

constexpr int kFewestNodes = 50;    // of a mesh that shares --nodes with others
constexpr double kDeviation = 0.6;  // voxel diagonals

struct OrganOptions : MeshOptions {
  OrganOptions() {
    nodes = 2500;
    if_strange = "are the image's voxels of the right size?";
  }
  std::string volume, preview, visual;
  bool force = false;  ///< files of another kind are written over
  int visual_triangles = 14000;
  std::vector<std::string> labels;
  double smoothing = 1, gap_mm = 0;
  std::string series;
};

/// "255" or "255=liver".
NamedLabel parse_label(const std::string& text) {
  const std::string number = text.substr(0, text.find('='));
  NamedLabel label{0, number.size() < text.size() ? text.substr(number.size() + 1) : "label" + number};
  const auto [end, error] = std::from_chars(number.data(), number.data() + number.size(), label.label);
  if (error == std::errc::invalid_argument || end != number.data() + number.size() || label.name.empty() ||
      label.name.find('/') != std::string::npos)
    throw std::runtime_error(fmt::format("--label {}: NUMBER or NUMBER=NAME is asked for", text));
  if (error != std::errc() || label.label < kLeastLabel || label.label > kMostLabel)
    throw std::runtime_error(
        fmt::format("--label {}: labels are whole numbers from {} to {}", text, kLeastLabel, kMostLabel));
  return label;
}

std::vector<NamedLabel> labels_of(const OrganOptions& o) {
  std::vector<NamedLabel> labels;
  std::set<std::int64_t> numbers;
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

std::string joined(const std::vector<NamedLabel>& labels, const char* between) {
  std::string names = labels[0].name;
  for (std::size_t l = 1; l < labels.size(); ++l) names += between + labels[l].name;
  return names;
}

/// Of several meshes each has a file and a folder of pictures of its own, with its labels' names.
OrganOptions options_of_one(const OrganOptions& o, const std::vector<NamedLabel>& labels) {
  namespace fs = std::filesystem;
  OrganOptions own = o;
  const std::string name = joined(labels, "_");
  const fs::path file(o.output);
  own.output = file.parent_path() / fmt::format("{}_{}{}", file.stem().string(), name, file.extension().string());
  if (!o.preview.empty()) own.preview = fs::path(o.preview) / name;
  const fs::path visual(o.visual);
  if (!o.visual.empty()) own.visual = visual.parent_path() / fmt::format("{}_{}.obj", visual.stem().string(), name);
  return own;
}

/// Labels that make one mesh: those that touch, unless a gap is asked for.
std::vector<std::vector<int>> meshes_of(const LabelVoxels& voxels, double gap) {
  if (gap == 0) return touching_labels(voxels);
  std::vector<std::vector<int>> alone;
  for (std::size_t l = 0; l < voxels.labels.size(); ++l) alone.push_back({static_cast<int>(l)});
  return alone;
}

/// Labels that make a mesh together, and their solid.
struct Together {
  std::vector<int> labels;
  LabelSolid solid;
};

/// Why labels do not make one mesh.
void say_apart(const LabelVolume& volume, const LabelVoxels& voxels, const std::vector<Together>& bodies,
               const Output& out) {
  if (bodies.size() < 2) return;
  out.say(fmt::format("  {} bodies that share no border, a mesh each:", bodies.size()));
  for (const Together& body : bodies)
    for (const int l : body.labels) {
      const auto& inside = voxels.inside[l];
      const auto first = static_cast<std::size_t>(std::ranges::find(inside, 1) - inside.begin());
      out.say(fmt::format("    '{}' at {}", voxels.labels[l].name,
                          place_in_mm(volume.in_world(voxels.shape.place_of(first)))));
    }
}

std::vector<std::string> names_of(const std::vector<NamedLabel>& labels) {
  std::vector<std::string> names;
  for (const NamedLabel& label : labels) names.push_back(label.name);
  return names;
}

std::vector<NamedLabel> named_labels(const LabelVoxels& voxels, const std::vector<int>& labels) {
  std::vector<NamedLabel> named;
  for (const int l : labels) named.push_back(voxels.labels[l]);
  return named;
}

void make_visual(const LabelVolume& volume, const std::vector<NamedLabel>& labels, const LabelSolid& solid,
                 const OrganOptions& o, Output& out) {
  say_progress("making the surface to be looked at");
  VisualMesh mesh = visual_of(solid, labels, o.visual_triangles);
  for (Eigen::Vector3f& p : mesh.position) p = volume.in_world(p.cast<double>()).cast<float>();
  write_visual(mesh, o.visual);
  out.say(fmt::format("{}: {} triangles of {} materials in millimetres, for [body.visual]", o.visual, mesh.triangles(),
                      mesh.parts.size()));
  out.mesh()["visual"] = {{"file", o.visual}, {"triangles", mesh.triangles()}, {"materials", mesh.parts.size()}};
}

/// A mesh that is made and not yet written.
struct MadeBody {
  FilledSolid filled;  ///< in the image's frame
  TetMesh mesh;        ///< in the world's, with its groups
};

MadeBody make_body(const LabelVolume& volume, const std::vector<NamedLabel>& labels, const LabelSolid& solid,
                   const MeshFineness& fineness, const OrganOptions& o) {
  MadeBody made{make_organ_mesh(solid.solid, solid.measures, fineness, say_progress), {}};
  name_parts(made.filled, labels);
  made.mesh = made.filled.mesh;
  for (Eigen::Vector3d& x : made.mesh.nodes) x = volume.in_world(x);
  add_groups(made.mesh, o);
  return made;
}

void write_body(const LabelVolume& volume, const LabelVoxels& voxels, const Together& body, const MadeBody& made,
                const OrganOptions& o, Output& out) {
  const std::vector<NamedLabel> named = named_labels(voxels, body.labels);
  if (!o.preview.empty()) {
    say_progress("drawing slices and surface");
    write_organ_pictures(volume, named, body.solid.solid, made.filled, o.preview);
  }
  tell_label_measures(voxels, body.labels, body.solid, made.filled, out);
  if (!o.visual.empty()) make_visual(volume, named, body.solid, o, out);
  write_mesh(made.mesh, o, out);
}

/// A place in the world's frame, in the image's; of a box that is turned the box around it.
FinePlace in_image(const FinePlace& f, const LabelVolume& volume) {
  FinePlace turned = f;
  for (int corner = 0; corner < 8; ++corner) {
    Eigen::Vector3d x;
    for (int a = 0; a < 3; ++a) x[a] = corner >> a & 1 ? f.high[a] : f.low[a];
    x = volume.in_image(x);
    turned.low = corner == 0 ? x : turned.low.cwiseMin(x);
    turned.high = corner == 0 ? x : turned.high.cwiseMax(x);
  }
  return turned;
}

/// What is asked of one of the meshes; places are told in the world's frame.
MeshFineness fineness_for(const LabelVolume& volume, const LabelSolid& solid, const OrganOptions& o, double share,
                          Output& out) {
  MeshFineness fineness = fineness_of(o);
  if (fineness.deviation == 0) fineness.deviation = kDeviation * volume.diagonal();
  fineness.nodes = std::max(kFewestNodes, static_cast<int>(o.nodes * share));
  std::vector<Eigen::Vector3d> surface;
  for (const Eigen::Vector3d& x : solid.border) surface.push_back(volume.in_world(x));
  add_touched_places(fineness, o, surface, out);
  for (FinePlace& place : fineness.fine) place = in_image(place, volume);
  return fineness;
}

LabelVolume read(const OrganOptions& o, Output& out) {
  say_progress("reading the image");
  LabelVolume volume = read_label_volume(o.volume, o.series);
  tell_image(o.volume, volume.shape, out);
  return volume;
}

/// What is found is in the image's frame.
std::vector<Together> bodies_of(const OrganOptions& o, const LabelVolume& volume, const LabelVoxels& voxels,
                                std::vector<Finding>& findings) {
  std::vector<Together> bodies;
  for (const std::vector<int>& labels : meshes_of(voxels, 1e-3 * o.gap_mm)) {
    bodies.push_back({labels, solid_of(voxels, labels, {o.smoothing, 1e-3 * o.gap_mm}, findings)});
    bodies.back().solid.solid.in_world = [&volume](const Eigen::Vector3d& x) { return volume.in_world(x); };
  }
  return bodies;
}

void tell_in_world(std::vector<Finding> findings, const LabelVolume& volume, const OrganOptions& o, Output& out) {
  for (Finding& finding : findings)
    for (Eigen::Vector3d& x : finding.places) x = volume.in_world(x);
  tell_findings(findings, o.report, out);
}

/// Of all of them before any is written: where one fails there is none.
std::vector<MadeBody> make_bodies(const LabelVolume& volume, const LabelVoxels& voxels,
                                  const std::vector<Together>& bodies, const OrganOptions& o, Output& out) {
  double area = 0;
  for (const Together& body : bodies) area += body.solid.measures.area;
  std::vector<MadeBody> made;
  for (const Together& body : bodies) {
    const LabelSolid& solid = body.solid;
    const std::vector<NamedLabel> labels = named_labels(voxels, body.labels);
    const auto make = [&] {
      const MeshFineness fineness = fineness_for(volume, solid, o, solid.measures.area / area, out);
      return make_body(volume, labels, solid, fineness, o);
    };
    made.push_back(bodies.size() == 1 ? make() : of_file(fmt::format("'{}'", joined(labels, "', '")), make));
  }
  return made;
}

/// How far apart they are.
void tell_gaps(const LabelVoxels& voxels, const std::vector<Together>& bodies, const std::vector<MadeBody>& made,
               const OrganOptions& o, Output& out) {
  std::vector<NamedMesh> meshes;
  for (std::size_t b = 0; b < bodies.size(); ++b)
    meshes.push_back({joined(named_labels(voxels, bodies[b].labels), "_"), made[b].mesh});
  tell_distances(meshes, 1e-3 * o.gap_mm, out);
}

/// Before anything is written, or the meshes are made.
void check_outputs(const OrganOptions& own) {
  cli::require_output(own.output, ".msh", {".msh"}, own.force);
  if (!own.visual.empty()) cli::require_output(own.visual, ".obj", {".csv"}, own.force);
  check_picture_folder(own.preview);
}

void make_organ(const OrganOptions& o) {
  Output out(o.json);
  fineness_of(o);  // what cannot be read, or written later, is told at once
  check_picture_folder(o.preview);
  const std::vector<NamedLabel> labels = labels_of(o);
  check_groups(o.groups, names_of(labels));
  const LabelVolume volume = read(o, out);
  LabelVoxels voxels;
  std::vector<Together> bodies;
  std::vector<Finding> findings;
  say_progress("measuring distances to the labels' borders");
  tell_refused_too([&] { tell_in_world(findings, volume, o, out); },
                   [&] {
                     voxels = of_file(o.volume, [&] { return voxels_of(volume, labels, findings); });
                     bodies = bodies_of(o, volume, voxels, findings);
                   });
  say_apart(volume, voxels, bodies, out);
  std::vector<OrganOptions> options;  // of each body
  for (const Together& body : bodies)
    options.push_back(bodies.size() == 1 ? o : options_of_one(o, named_labels(voxels, body.labels)));
  std::ranges::for_each(options, check_outputs);
  const std::vector<MadeBody> made = make_bodies(volume, voxels, bodies, o, out);
  tell_gaps(voxels, bodies, made, o, out);
  std::vector<MeshWithEdge> written;
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    out.next_mesh();
    write_body(volume, voxels, bodies[b], made[b], options[b], out);
    written.push_back({made[b].mesh, out.mesh().at("mean_edge_m")});
  }
  warn_of_idle_places(o, written, out);
  out.finish();
}

}  // namespace

void add_organ_command(cli::Command& app) {
  cli::Command command =
      app.add_command("organ", "Make a mesh of tetrahedra of labels in an image (INR, NIfTI, MetaImage, NRRD, DICOM)");
  auto o = std::make_shared<OrganOptions>();
  command.add_option("VOLUME", o->volume, "Image file, or a folder with a DICOM series").required();
  command
      .add_option("--label", o->labels,
                  "Value of the organ's voxels, and its name: NUMBER or NUMBER=NAME; several that "
                  "touch make one mesh of several groups that share their borders, others a mesh each")
      .required()
      .one_value_each_time();
  command.add_option("--smoothing", o->smoothing, "Over how many voxels the border is smoothed")
      .between(0.0, 5.0)
      .show_default();
  command.add_option("--gap", o->gap_mm, "Keep labels that touch apart by this much [mm], a mesh each").positive();
  command.add_option("--series", o->series, kSeriesHelp);
  command.add_option("--preview", o->preview,
                     "Folder for pictures: each slice with the smoothed border and the tetrahedra cut there, the "
                     "surface of the voxels and that of the mesh");
  command
      .add_option("--visual", o->visual,
                  "Write the surface as it is looked at (.obj, and .mtl beside it), a material for each label")
      .output_file(".obj", {".csv"});
  command.add_option("--triangles", o->visual_triangles, "About so many has that surface")
      .between(100, 200000)
      .show_default();
  add_mesh_options(command, *o);
  command.tells_progress();
  command.examples(
      {"palpate organ liver.inr.gz --label 255=liver --label 85=gall_bladder --group attachment=above:z -o organ.msh"});
  command.does([o, command] {
    o->force = command.given("--force");
    make_organ(*o);
  });
}

}  // namespace palpate
