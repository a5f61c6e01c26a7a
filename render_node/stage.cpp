#include "render_node/stage.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "common/mesh/near_origin.hpp"
#include "common/mesh/normals.hpp"
#include "common/view/backdrop.hpp"
#include "render_node/clear_corner.hpp"

namespace palpate {
namespace {

/// The next "round" number that is at least `value`.
double round_up(double value) {
  const double decade = std::pow(10.0, std::floor(std::log10(value)));
  for (const double factor : {1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 8.0})
    if (factor * decade >= value) return factor * decade;
  return 10 * decade;
}

void add_parts(MeshView view, const PartsOnStage& parts, int moving_id, Frame& frame) {
  view.finish = Finish::membrane;
  view.colour = kPrecomputedColour;
  view.triangles = parts.precomputed();
  view.edges = parts.precomputed_edges();
  frame.meshes.push_back(view);
  view.id = moving_id;
  view.colour = kMovingColour;
  view.triangles = parts.moving();
  view.edges = parts.moving_edges();
  frame.meshes.push_back(view);
}

}  // namespace

Stage::Stage(const Scene& scene, std::span<const SurfaceMap> surfaces, const TriangleMesh& backdrop,
             std::vector<std::optional<VisualBody>> visuals, const Eigen::Vector3d& origin)
    : origin_(origin), render_(scene.render.value_or(Render{})) {
  if (!scene.render) render_.camera = fit_camera(surfaces);
  render_.camera.eye -= origin;
  render_.camera.target -= origin;
  for (std::size_t b = 0; b < surfaces.size(); ++b) {
    const SurfaceMap& map = surfaces[b];
    const BodyLook look = look_of(scene.bodies.at(b), map, render_);
    Soft body;
    body.coarse = map.position.size();
    body.max_triangles = look.max_triangles;
    body.finish = look.finish;
    body.colour = look.colour;
    body.rest = places_from(origin, map.position);
    if (b < visuals.size() && visuals[b]) add_visual(body, std::move(*visuals[b]), scene.bodies[b], map);
    refine(body, body.visual ? std::span<const std::array<int, 3>>() : map.triangles);
    body.position = body.rest;
    body.normal.resize(body.coarse);
    vertex_normals(std::span(body.rest).first(body.coarse), map.triangles, body.normal);
    body.normal.resize(body.refinement.vertices());
    body.refinement.apply(body.position, body.normal);
    if (look.finish == Finish::duct)
      add_wall(body, look);
    else
      body.texture = look.texture;
    bodies_.push_back(std::move(body));
  }
  const Backdrop sorted = sort_backdrop(backdrop);
  add_backdrop(sorted.bones, Finish::bone, kBoneColour);
  add_backdrop(sorted.lining, Finish::lining, kLiningColour);
  for (const Tool& tool : scene.tools)
    tools_.push_back({make_trocar(tool.pivot - origin, tool.axis, tool.up), instrument_of(tool)});
}

// A new surface over the body's nodes: what the picture sticks to is the rest shape refined alike.
void Stage::refine(Soft& body, std::span<const std::array<int, 3>> triangles) const {
  body.rest.resize(body.coarse);
  const int levels = body.parts ? 0 : refinement_levels(triangles.size(), body.max_triangles);
  body.refinement = Refinement(triangles, static_cast<int>(body.coarse), levels, body.rest);
  body.triangles.assign(triangles.begin(), triangles.end());
  if (body.parts) body.parts->sort(triangles);
  body.rest_normal.resize(body.coarse);
  vertex_normals(body.rest, triangles, body.rest_normal);
  body.rest.resize(body.refinement.vertices());
  body.rest_normal.resize(body.refinement.vertices());
  body.refinement.apply(body.rest, body.rest_normal);
  if (render_.colour == Colouring::displacement && body.finish != Finish::plastic)
    body.displacement.assign(body.rest.size(), 0.0f);
  ++body.shape;
}

void Stage::add_visual(Soft& body, VisualBody visual, const Body& spec, const SurfaceMap& map) const {
  body.uncut = map.triangles;
  body.visual.emplace(std::move(visual), counted_from(origin_, map.position), body.colour, visual_of(spec)->texture,
                      render_.colour == Colouring::displacement);
}

void Stage::add_wall(Soft& body, const BodyLook& look) const {
  body.wall = ThickWall(body.refinement.triangles(), body.refinement.vertices(), look.thickness);
  body.wall.place(body.position, body.normal);
  const std::vector<Eigen::Vector3f>& coarse = look.texture;
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

void Stage::colour_parts(int index, std::span<const std::array<int, 4>> moving) {
  Soft& body = bodies_.at(index);
  if (body.finish != Finish::tissue) return;
  body.parts.emplace(moving);
  set_triangles(index, std::vector(body.triangles));
}

void Stage::set_triangles(int index, std::span<const std::array<int, 3>> triangles) {
  Soft& body = bodies_.at(index);
  if (body.visual)
    refine(body, bared(body.uncut, triangles));
  else
    refine(body, triangles);
  body.position.resize(body.refinement.vertices());
  body.normal.resize(body.refinement.vertices());
  body.refinement.apply(body.position, body.normal);
}

void Stage::add_backdrop(const TriangleMesh& mesh, Finish finish, const std::array<double, 3>& colour) {
  if (mesh.triangles.empty()) return;
  Rigid part{places_from(origin_, mesh.nodes), {}, mesh.triangles, finish, colour};
  part.normal.resize(part.position.size());
  vertex_normals(part.position, part.triangles, part.normal);
  backdrop_.push_back(std::move(part));
}

// The nodes without what is finer than the mesh.
void Stage::smooth(Soft& body, std::span<const HertzDent> dents) {
  for (std::size_t n = 0; n < body.coarse; ++n)
    for (const HertzDent& dent : dents)
      body.position[n] -=
          dent.displacement(body.rest[n].cast<double>(), body.rest_normal[n].cast<double>()).cast<float>();
  vertex_normals(std::span(body.position).first(body.coarse), body.triangles,
                 std::span(body.normal).first(body.coarse));
}

void Stage::dent(Soft& body, const HertzDent& dent) {
  for (std::size_t v = 0; v < body.position.size(); ++v) {
    const Eigen::Vector3d rest = body.rest[v].cast<double>(), normal = body.rest_normal[v].cast<double>();
    if (dent.share(rest) == 0) continue;
    body.position[v] += dent.displacement(rest, normal).cast<float>();
    body.normal[v] = (body.normal[v] - dent.slope(rest, normal).cast<float>()).normalized();
  }
}

void Stage::set_surface(int index, std::span<const Eigen::Vector3f> position, std::span<const Eigen::Vector3f> normal,
                        std::span<const HertzDent> dents) {
  Soft& body = bodies_.at(index);
  if (position.size() != body.coarse || normal.size() != body.coarse) return;
  std::copy(position.begin(), position.end(), body.position.begin());
  std::copy(normal.begin(), normal.end(), body.normal.begin());
  if (!dents.empty()) smooth(body, dents);
  body.refinement.apply(body.position, body.normal);
  if (body.visual) body.visual->place(std::span(body.position).first(body.coarse), dents);
  for (const HertzDent& d : dents) dent(body, d);
  if (body.finish == Finish::duct) body.wall.place(body.position, body.normal);
  if (body.displacement.empty()) return;
  float most = body.visual ? body.visual->max_displacement() : 0;
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
  place(tool.view, tool.trocar, s);
  if (!std::exchange(tool.seen, true)) put_overlay_aside();
  return true;
}

// Where it stands from then on: it does not jump.
void Stage::put_overlay_aside() {
  std::vector<InstrumentView> seen;
  for (const Instrument& tool : tools_)
    if (tool.seen) seen.push_back(tool.view);
  overlay_.corner = clear_corner(render_.camera, seen, static_cast<double>(render_.width) / render_.height);
}

void Stage::set_overlay(std::vector<std::string> lines, std::optional<Gauge> gauge) {
  overlay_.lines = std::move(lines);
  overlay_.gauge = std::move(gauge);
}

void Stage::add_views(const Soft& body, int id, int inner_id, Frame& frame) {
  if (body.visual && body.triangles.empty()) return;  // it hides all of the own one
  MeshView view{.id = id,
                .shape = body.shape,
                .finish = body.finish,
                .colour = body.colour,
                .rest = body.texture.empty() ? body.rest : body.texture,
                .position = body.position,
                .normal = body.normal,
                .scalar = body.displacement,
                .triangles = body.refinement.triangles()};
  if (body.parts) return add_parts(view, *body.parts, inner_id, frame);
  if (body.finish != Finish::duct) {
    frame.meshes.push_back(view);
    return;
  }
  const ThickWall::Side &outer = body.wall.outer(), &inner = body.wall.inner();
  view.position = outer.position;
  frame.meshes.push_back(view);
  view.id = inner_id;
  view.finish = Finish::mucosa;
  view.colour = kMucosaColour;
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
  for (int b = 0, id = 2 * bodies; b < bodies; ++b) {
    if (!bodies_[b].visual) continue;
    bodies_[b].visual->add_views(id, b, frame);
    id += bodies_[b].visual->parts();
  }
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
  if (render_.colour == Colouring::displacement) frame.legend = Legend{"displacement", legend_max_};
  if (render_.overlay) frame.overlay = overlay_;
  return frame;
}

}  // namespace palpate
