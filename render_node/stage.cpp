#include "render_node/stage.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "common/mesh/normals.hpp"
#include "common/models/appearance.hpp"
#include "common/tool/instrument.hpp"
#include "render_node/backdrop.hpp"
#include "render_node/straighten.hpp"

namespace palpate {
namespace {

// Of one body after refinement: what 60 frames a second allow. A wall has them twice; plastic comes smooth.
constexpr std::size_t kMaxTrianglesOfOrgan = 16000, kMaxTrianglesOfWall = 6000, kMaxTrianglesOfPlastic = 0;
// Linear RGB.
constexpr std::array<double, 3> kBoneColour{0.80, 0.68, 0.54}, lining_colour{0.46, 0.20, 0.165},
    duct_colour{0.60, 0.29, 0.23}, mucosa_colour{0.58, 0.27, 0.19}, plastic_colour{0.66, 0.74, 0.76};

std::vector<Eigen::Vector3f> to_float(const std::vector<Eigen::Vector3d>& points) {
  std::vector<Eigen::Vector3f> out;
  out.reserve(points.size());
  for (const auto& p : points) out.push_back(p.cast<float>());
  return out;
}

/// The next "round" number that is at least `value`.
double round_up(double value) {
  const double decade = std::pow(10.0, std::floor(std::log10(value)));
  for (const double factor : {1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 8.0})
    if (factor * decade >= value) return factor * decade;
  return 10 * decade;
}

/// How a material is drawn.
struct Drawn {
  Finish finish;
  std::size_t max_triangles;
  std::array<double, 3> colour;
};

/// `render`: whose tissue colour is also a wall's, if it is given.
Drawn drawn_as(Appearance::Material material, const Render& render) {
  const bool given = render.tissue_colour != Render{}.tissue_colour;
  switch (material) {
    case Appearance::Material::wall:
      return {Finish::duct, kMaxTrianglesOfWall, given ? render.tissue_colour : duct_colour};
    case Appearance::Material::plastic:
      return {Finish::plastic, kMaxTrianglesOfPlastic, plastic_colour};
    case Appearance::Material::tissue:
      break;
  }
  return {Finish::tissue, kMaxTrianglesOfOrgan, render.tissue_colour};
}

}  // namespace

Stage::Stage(const Scene& scene, std::span<const SurfaceMap> surfaces, const TriangleMesh& backdrop)
    : render_(scene.render.value_or(Render{})) {
  if (!scene.render) render_.camera = fit_camera(surfaces);
  for (std::size_t b = 0; b < surfaces.size(); ++b) {
    const SurfaceMap& map = surfaces[b];
    const Appearance look = std::visit([&](const auto& spec) { return appearance(spec, map); }, scene.bodies.at(b));
    const Drawn drawn = drawn_as(look.material, render_);
    Soft body;
    body.coarse = map.position.size();
    body.max_triangles = drawn.max_triangles;
    body.finish = drawn.finish;
    body.colour = drawn.colour;
    body.rest = to_float(map.position);
    refine(body, map.triangles);
    body.position = body.rest;
    body.normal.resize(body.coarse);
    vertex_normals(std::span(body.rest).first(body.coarse), map.triangles, body.normal);
    body.normal.resize(body.refinement.vertices());
    body.refinement.apply(body.position, body.normal);
    body.texture = look.texture;
    if (look.material == Appearance::Material::wall) add_wall(body, map, look.thickness);
    bodies_.push_back(std::move(body));
  }
  const Backdrop sorted = sort_backdrop(backdrop);
  add_backdrop(sorted.bones, Finish::bone, kBoneColour);
  add_backdrop(sorted.lining, Finish::lining, lining_colour);
  for (const Tool& tool : scene.tools) {
    Instrument instrument{make_trocar(tool.pivot, tool.axis, tool.up), {}};
    instrument.view.shaft_radius = tool.shaft_radius;
    instrument.view.shaft_length = tool.shaft_length;
    const EndAbilities can = abilities_of(tool);
    if (can.ball) instrument.view.tip_radius = *can.ball;
    if (can.turning) {
      instrument.view.jaw_length = can.turning->length;
      instrument.view.jaw_radius = can.turning->radius;
    }
    tools_.push_back(instrument);
  }
}

// A new surface over the body's nodes: what the picture sticks to is the rest shape refined alike.
void Stage::refine(Soft& body, std::span<const std::array<int, 3>> triangles) const {
  body.rest.resize(body.coarse);
  const int levels = refinement_levels(triangles.size(), body.max_triangles);
  body.refinement = Refinement(triangles, static_cast<int>(body.coarse), levels, body.rest);
  std::vector<Eigen::Vector3f> normal(body.coarse);
  vertex_normals(body.rest, triangles, normal);
  body.rest.resize(body.refinement.vertices());
  normal.resize(body.refinement.vertices());
  body.refinement.apply(body.rest, normal);
  if (render_.colour == "displacement" && body.finish != Finish::plastic)
    body.displacement.assign(body.rest.size(), 0.0f);
  ++body.shape;
}

void Stage::add_wall(Soft& body, const SurfaceMap& map, double thickness) const {
  body.wall = ThickWall(body.refinement.triangles(), body.refinement.vertices(), thickness);
  body.wall.place(body.position, body.normal);
  const std::vector<Eigen::Vector3f> coarse = straighten(map);
  body.texture.resize(body.refinement.vertices());
  for (int axis = 0; axis < 3; ++axis) {
    std::vector<float> coordinate(body.refinement.vertices());
    for (std::size_t v = 0; v < coarse.size(); ++v) coordinate[v] = coarse[v][axis];
    body.refinement.apply(coordinate);
    for (std::size_t v = 0; v < coordinate.size(); ++v) body.texture[v][axis] = coordinate[v];
  }
  for (const int v : body.wall.inner().from) body.inner_texture.push_back(body.texture[v]);
  if (!body.displacement.empty()) body.inner_displacement.resize(body.inner_texture.size());
}

void Stage::set_triangles(int index, std::span<const std::array<int, 3>> triangles) {
  Soft& body = bodies_.at(index);
  refine(body, triangles);
  body.position.resize(body.refinement.vertices());
  body.normal.resize(body.refinement.vertices());
  body.refinement.apply(body.position, body.normal);
}

void Stage::add_backdrop(const TriangleMesh& mesh, Finish finish, const std::array<double, 3>& colour) {
  if (mesh.triangles.empty()) return;
  Rigid part{to_float(mesh.nodes), {}, mesh.triangles, finish, colour};
  part.normal.resize(part.position.size());
  vertex_normals(part.position, part.triangles, part.normal);
  backdrop_.push_back(std::move(part));
}

void Stage::set_surface(int index, std::span<const Eigen::Vector3f> position, std::span<const Eigen::Vector3f> normal) {
  Soft& body = bodies_.at(index);
  if (position.size() != body.coarse || normal.size() != body.coarse) return;
  std::copy(position.begin(), position.end(), body.position.begin());
  std::copy(normal.begin(), normal.end(), body.normal.begin());
  body.refinement.apply(body.position, body.normal);
  if (body.finish == Finish::duct) body.wall.place(body.position, body.normal);
  if (body.displacement.empty()) return;
  float most = 0;
  for (std::size_t i = 0; i < body.rest.size(); ++i) {
    body.displacement[i] = (body.position[i] - body.rest[i]).norm();
    most = std::max(most, body.displacement[i]);
  }
  for (std::size_t i = 0; i < body.inner_displacement.size(); ++i)
    body.inner_displacement[i] = body.displacement[body.wall.inner().from[i]];
  if (most > legend_max_) legend_max_ = round_up(most);
}

bool Stage::set_tool(const ToolState& s) {
  if (s.tool >= tools_.size()) return false;
  Instrument& tool = tools_[s.tool];
  tool.view.tip = tip_pose(tool.trocar, {s.yaw, s.pitch, s.depth, s.roll, s.grip});
  const bool forceps = tool.view.jaw_length > 0;
  tool.view.jaw_opening = std::clamp(forceps ? s.opening : s.grip, 0.0, forceps ? std::numbers::pi : 1.2);
  tool.seen = true;
  return true;
}

void Stage::set_overlay(std::vector<std::string> lines, std::optional<Gauge> gauge) {
  overlay_ = {std::move(lines), gauge};
}

void Stage::add_views(const Soft& body, int id, int inner_id, Frame& frame) {
  MeshView view{.id = id,
                .shape = body.shape,
                .finish = body.finish,
                .colour = body.colour,
                .rest = body.texture.empty() ? body.rest : body.texture,
                .position = body.position,
                .normal = body.normal,
                .scalar = body.displacement,
                .triangles = body.refinement.triangles()};
  if (body.finish != Finish::duct) {
    frame.meshes.push_back(view);
    return;
  }
  const ThickWall::Side &outer = body.wall.outer(), &inner = body.wall.inner();
  view.position = outer.position;
  frame.meshes.push_back(view);
  view.id = inner_id;
  view.finish = Finish::mucosa;
  view.colour = mucosa_colour;
  view.rest = body.inner_texture;
  view.position = inner.position;
  view.normal = inner.normal;
  view.scalar = body.inner_displacement;
  view.triangles = inner.triangles;
  frame.meshes.push_back(view);
}

Frame Stage::frame() const {
  Frame frame;
  frame.camera = render_.camera;
  const int bodies = static_cast<int>(bodies_.size());
  for (int b = 0; b < bodies; ++b) add_views(bodies_[b], b, bodies + b, frame);
  for (std::size_t i = 0; i < backdrop_.size(); ++i) {
    const Rigid& part = backdrop_[i];
    frame.meshes.push_back({.id = -1 - static_cast<int>(i),
                            .finish = part.finish,
                            .colour = part.colour,
                            .rest = part.position,
                            .position = part.position,
                            .normal = part.normal,
                            .scalar = {},
                            .triangles = part.triangles,
                            .moving = false});
  }
  for (const Instrument& tool : tools_)
    if (tool.seen) frame.instruments.push_back(tool.view);
  if (render_.colour == "displacement") frame.legend = Legend{"displacement", legend_max_};
  if (render_.overlay) frame.overlay = overlay_;
  return frame;
}

Camera fit_camera(std::span<const SurfaceMap> surfaces) {
  Eigen::AlignedBox3d box;
  for (const SurfaceMap& map : surfaces)
    for (const auto& p : map.position) box.extend(p);
  Camera camera;
  if (box.isEmpty()) return camera;
  camera.target = box.center();
  camera.eye = box.center() + box.diagonal().norm() * Eigen::Vector3d(0.15, -0.85, 0.75);
  return camera;
}

}  // namespace palpate
