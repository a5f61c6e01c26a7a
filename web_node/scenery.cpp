#include "web_node/scenery.hpp"

#include "common/mesh/near_origin.hpp"
#include "common/mesh/normals.hpp"
#include "common/models/marked_to_resect.hpp"
#include "common/tool/instrument.hpp"
#include "common/view/backdrop.hpp"
#include "common/view/instrument.hpp"
#include "common/view/looks.hpp"
#include "web_node/protocol.hpp"

namespace palpate::web {
namespace {

using nlohmann::json;

json of(const Eigen::Vector3d& v) {
  return {v.x(), v.y(), v.z()};
}

const char* name_of(Finish finish) {
  switch (finish) {
    case Finish::tissue:
      return "tissue";
    case Finish::membrane:
      return "membrane";
    case Finish::duct:
      return "duct";
    case Finish::plastic:
      return "plastic";
    case Finish::bone:
      return "bone";
    case Finish::lining:
      return "lining";
    case Finish::mucosa:
      break;
  }
  return "mucosa";
}

json visual_of(const VisualBody& visual, const std::array<double, 3>& tissue, Container& to) {
  const VisualMesh& mesh = visual.mesh;
  json parts = json::array();
  bool textured = false;
  for (const VisualMesh::Part& part : mesh.parts) {
    const PartLook look = look_of(part, tissue);
    parts.push_back({{"finish", name_of(look.finish)},
                     {"colour", look.colour},
                     {"textured", part.textured},
                     {"first", part.first},
                     {"count", part.count},
                     {"triangles", to.add(part.triangles)}});
    textured |= part.textured;
  }
  std::vector<int> cells, cell;
  std::vector<float> weights, image;
  for (const auto& nodes : visual.binding.cells) cells.insert(cells.end(), nodes.begin(), nodes.end());
  for (const VisualBinding::Tie& tie : visual.binding.ties) {
    cell.push_back(tie.cell);
    weights.insert(weights.end(), tie.weight.begin(), tie.weight.end());
  }
  json out{{"position", to.add(mesh.position)},
           {"node", to.add_integers(mesh.node)},
           {"nodes", mesh.nodes},
           {"cells", to.add_integers(cells)},
           {"tetrahedra", visual.binding.tetrahedra},
           {"cell", to.add_integers(cell)},
           {"weight", to.add_numbers(weights)},
           {"parts", parts}};
  if (!textured) return out;
  for (const Eigen::Vector2f& place : mesh.image) image.insert(image.end(), place.begin(), place.end());
  out["image"] = to.add_numbers(image);
  out["texture"] = to.add_bytes(visual.texture);
  return out;
}

json body_of(const Body& spec, const SurfaceMap& surface, const Render& render, const std::optional<VisualBody>& visual,
             const Eigen::Vector3d& origin, Container& to) {
  const BodyLook look = look_of(spec, surface, render);
  json body{{"name", name_of(spec)},       {"finish", name_of(look.finish)},
            {"colour", look.colour},       {"max_triangles", look.max_triangles},
            {"thickness", look.thickness}, {"rest", to.add(places_from(origin, surface.position))}};
  if (!look.texture.empty()) body["texture"] = to.add(look.texture);
  if (const Box* marked = marked_to_resect(spec)) body["marked"] = {of(marked->min - origin), of(marked->max - origin)};
  if (visual) body["visual"] = visual_of(*visual, look.colour, to);
  return body;
}

json tool_of(const Tool& tool, const Eigen::Vector3d& origin, Container& to) {
  const InstrumentView view = instrument_of(tool);
  const InstrumentShape shape = make_instrument(view);
  const EndAbilities can = abilities_of(tool);
  const Steel steel = steel_of(view);
  json parts = json::array();
  for (const InstrumentPart& part : shape.parts)
    parts.push_back(
        {{"position", to.add(part.position)}, {"normal", to.add(part.normal)}, {"triangles", to.add(part.triangles)}});
  return {{"name", tool.name},
          {"max_force", tool.max_force},
          {"tip_radius", view.tip_radius},
          {"shaft_radius", view.shaft_radius},
          {"shaft_length", view.shaft_length},
          {"jaw_length", view.jaw_length},
          {"jaw_radius", view.jaw_radius},
          {"polish", steel.polish},
          {"bare", steel.bare},
          {"grips", can.turning.has_value() || can.closing.has_value()},
          {"cuts", can.cautery.has_value()},
          {"pivot", of(tool.pivot - origin)},
          {"parts", parts}};
}

void add_backdrop(const TriangleMesh& mesh, Finish finish, const std::array<double, 3>& colour,
                  const Eigen::Vector3d& origin, Container& to, json& list) {
  if (mesh.triangles.empty()) return;
  const std::vector<Eigen::Vector3f> position = places_from(origin, mesh.nodes);
  std::vector<Eigen::Vector3f> normal(position.size());
  vertex_normals(position, mesh.triangles, normal);
  list.push_back({{"finish", name_of(finish)},
                  {"colour", colour},
                  {"position", to.add(position)},
                  {"normal", to.add(normal)},
                  {"triangles", to.add(mesh.triangles)}});
}

}  // namespace

std::string scenery_message(const Scene& scene, std::span<const SurfaceMap> surfaces, const TriangleMesh& backdrop,
                            std::span<const std::optional<VisualBody>> visuals, const Eigen::Vector3d& origin) {
  Container container;
  const Render render = scene.render.value_or(Render{});
  const Camera camera = scene.render ? render.camera : fit_camera(surfaces);
  json bodies = json::array(), tools = json::array(), behind = json::array();
  for (std::size_t b = 0; b < scene.bodies.size(); ++b)
    bodies.push_back(body_of(scene.bodies[b], surfaces[b], render, visuals[b], origin, container));
  for (const Tool& tool : scene.tools) tools.push_back(tool_of(tool, origin, container));
  const Backdrop sorted = sort_backdrop(backdrop);
  add_backdrop(sorted.bones, Finish::bone, kBoneColour, origin, container, behind);
  add_backdrop(sorted.lining, Finish::lining, kLiningColour, origin, container, behind);
  return container.finish(Kind::scenery, {{"title", scene.title.empty() ? scene.file.stem().string() : scene.title},
                                          {"camera",
                                           {{"eye", of(camera.eye - origin)},
                                            {"target", of(camera.target - origin)},
                                            {"up", of(camera.up)},
                                            {"field_of_view", camera.field_of_view},
                                            {"aspect", static_cast<double>(render.width) / render.height}}},
                                          {"colour", word_of(render.colour)},
                                          {"mucosa_colour", kMucosaColour},
                                          {"bodies", bodies},
                                          {"tools", tools},
                                          {"backdrop", behind}});
}

std::string topology_message(std::uint32_t number, std::span<const BodyTopology> topologies) {
  Container container;
  json bodies = json::array(), pieces = json::array();
  for (const BodyTopology& body : topologies) {
    bodies.push_back(container.add(body.triangles));
    pieces.push_back(body.pieces.empty() ? json() : container.add_integers(body.pieces));
  }
  return container.finish(Kind::topology, {{"number", number}, {"bodies", bodies}, {"pieces", pieces}});
}

}  // namespace palpate::web
