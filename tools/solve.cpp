#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <numeric>
#include <optional>
#include <set>
#include <stdexcept>

#include "common/archive/static_solve.hpp"
#include "common/fem/selection.hpp"
#include "common/mesh/mesh_file.hpp"
#include "common/mesh/shell_file.hpp"
#include "common/mesh/surface.hpp"
#include "common/models/static_state.hpp"
#include "common/scene/ensure_archive.hpp"
#include "common/scene/find_archive.hpp"
#include "common/scene/moved_files.hpp"
#include "common/scene/scene_changes.hpp"
#include "common/shell/boundary_conditions.hpp"
#include "tools/hold_argument.hpp"
#include "tools/shared/choose_body.hpp"
#include "tools/shared/commands.hpp"
#include "tools/shared/set_option.hpp"
#include "tools/solution_file.hpp"
#include "tools/solve_dynamic.hpp"

namespace palpate {
namespace {

struct SolveArguments {
  std::string scene, body, method = "tensors", csv, vtu;
  std::vector<std::string> set, holds, touches, forces, pressures;
  std::array<double, 3> gravity{};  // [m/s^2]
  bool plain = false, json = false, dynamic = false;
  double seconds = 0, every = 0;
  std::string precision, states;
};

bool falls(const SolveArguments& arguments) {
  return arguments.gravity != std::array{0.0, 0.0, 0.0};
}

/// A static state, and what was held for it.
struct Solved {
  SolutionTable table;
  std::vector<Constraint> held;
};

std::vector<int> nodes_of(const NamedSpec& body, const Selector&) {
  throw std::runtime_error(fmt::format("--hold: body '{}' has no mesh, and so no groups", body.name));
}
std::vector<int> nodes_of(const SolidSpec& body, const Selector& group) {
  return select_nodes(load_tet_mesh(body.mesh, body.scale), group, "--hold");
}
std::vector<int> nodes_of(const ShellSpec& body, const Selector& group) {
  return select_nodes(load_shell_mesh(body.mesh, body.scale), group, "--hold");
}

/// Every hold and touch of the command line; positions, numbers and triangles are those of the surface.
std::vector<Constraint> constraints_of(const Body& body, const SolveArguments& arguments, int mesh_nodes,
                                       const std::vector<Eigen::Vector3d>& position,
                                       const std::vector<int>& node_number,
                                       const std::vector<std::array<int, 3>>& triangles) {
  const auto group = [&](const std::string& name) {
    return std::visit([&](const auto& spec) { return nodes_of(spec, Selector{.group = name}); }, body);
  };
  auto constraints = parse_holds(arguments.holds, mesh_nodes, group);
  for (const auto& text : arguments.touches) {
    const auto touch = touch_constraints(parse_touch(text), position, node_number, triangles);
    constraints.insert(constraints.end(), touch.begin(), touch.end());
  }
  return constraints;
}

/// Every load of the command line, by mesh nodes.
StaticLoads loads_of(const Body& body, const SolveArguments& arguments, int mesh_nodes) {
  StaticLoads loads{.nodes = parse_forces(arguments.forces, mesh_nodes),
                    .gravity = Eigen::Vector3d(arguments.gravity.data())};
  if (arguments.pressures.empty()) return loads;
  const TetMesh mesh = std::visit([](const auto& spec) { return direct_problem(spec); }, body).mesh;
  const auto triangles = extract_surface(mesh).triangles;
  const auto group = [&](const std::string& name) { return select_nodes(mesh, {.group = name}, "--pressure"); };
  for (const std::string& text : arguments.pressures) {
    const auto more = parse_pressure(text, triangles, group);
    loads.pressures.insert(loads.pressures.end(), more.begin(), more.end());
  }
  return loads;
}

std::vector<Eigen::Matrix3d> stress_of(const NamedSpec&, const TetMesh&, const std::vector<Eigen::Vector3d>&) {
  return {};
}
std::vector<Eigen::Matrix3d> stress_of(const SolidSpec& body, const TetMesh& mesh,
                                       const std::vector<Eigen::Vector3d>& displacement) {
  return element_stresses(mesh, material_field(body, mesh), displacement);
}

Solved solve_by_direct(const Body& body, const SolveArguments& arguments) {
  const DirectProblem problem = std::visit([](const auto& spec) { return direct_problem(spec); }, body);
  const TetMesh& mesh = problem.mesh;
  SolutionTable table;
  table.node.resize(mesh.nodes.size());
  std::iota(table.node.begin(), table.node.end(), 0);
  table.position = mesh.nodes;
  if (!problem.rest.empty()) {
    const std::vector<Eigen::Vector3d> sag = problem.solve({}, problem.rest).displacement;
    for (std::size_t n = 0; n < sag.size(); ++n) table.position[n] += sag[n];
  }
  table.tetrahedra = mesh.tetrahedra;
  const auto triangles = extract_surface(mesh).triangles;
  const auto constraints =
      constraints_of(body, arguments, static_cast<int>(mesh.nodes.size()), table.position, table.node, triangles);
  const auto solution = problem.solve(constraints, loads_of(body, arguments, static_cast<int>(mesh.nodes.size())));
  table.displacement = solution.displacement;
  table.force = solution.force;
  table.stress = std::visit([&](const auto& spec) { return stress_of(spec, mesh, table.displacement); }, body);
  return {table, constraints};
}

/// The surface in ascending mesh node number. An archive knows no reactions, so that a CSV leaves out the
/// nodes that are fixed along all axes.
SolutionTable sorted_table(const SurfaceMap& surface, const SurfaceSolution& solution) {
  std::vector<int> order(surface.size()), place(surface.size());
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(), [&](int a, int b) { return surface.node_number[a] < surface.node_number[b]; });
  SolutionTable table;
  for (int i = 0; i < surface.size(); ++i) {
    place[order[i]] = i;
    table.node.push_back(surface.node_number[order[i]]);
    table.position.push_back(surface.position[order[i]]);
    table.displacement.push_back(solution.displacement[order[i]]);
    table.force.push_back(solution.force[order[i]]);
    const auto& fixed = surface.fixed[order[i]];
    table.listed.push_back(!fixed[0] || !fixed[1] || !fixed[2]);
  }
  for (const auto& triangle : surface.triangles)
    table.triangles.push_back({place[triangle[0]], place[triangle[1]], place[triangle[2]]});
  return table;
}

/// An archive knows its nodes' responses alone: a pressure becomes forces at corners.
std::vector<NodalLoad> nodal_loads(const Archive& archive, const StaticLoads& given) {
  const SurfaceMap& surface = archive.surface;
  std::vector<Eigen::Vector3d> position(archive.mesh_nodes);
  for (int i = 0; i < surface.size(); ++i) position[surface.node_number[i]] = surface.position[i];
  std::vector<NodalLoad> loads = given.nodes;
  for (const SurfacePressure& p : given.pressures)
    for (const NodalLoad& load : corner_loads(p, position)) loads.push_back(load);
  return loads;
}

Solved solve_by_tensors(const Scene& scene, const Body& body, const SolveArguments& arguments) {
  ensure_archive(scene, body);
  const auto archive = find_archive(scene, body, ArchivePart::surface);
  const auto& surface = archive.surface;
  const auto held =
      constraints_of(body, arguments, archive.mesh_nodes, surface.position, surface.node_number, surface.triangles);
  if (arguments.plain) return {sorted_table(surface, superpose_tensors(archive, held, Superposition::plain)), held};
  const auto loads = nodal_loads(archive, loads_of(body, arguments, archive.mesh_nodes));
  return {sorted_table(surface, solve_tensors(archive, held, loads)), held};
}

/// Places of the held nodes in the table, ascending.
std::vector<int> held_places(const Solved& solved) {
  std::set<int> numbers;
  for (const Constraint& constraint : solved.held)
    for (const Constraint::Term& term : constraint.terms) numbers.insert(term.node);
  std::vector<int> places;
  for (std::size_t i = 0; i < solved.table.node.size(); ++i)
    if (numbers.contains(solved.table.node[i])) places.push_back(static_cast<int>(i));
  return places;
}

/// [body.nonlinear], where the body has one. Returns how many times the linear forces the corrected ones are.
std::optional<double> correct(const Scene& scene, const Body& body, bool given_forces, Solved& solved) {
  const StaticCorrection correction = std::visit([](const auto& spec) { return static_correction(spec); }, body);
  if (!correction) return {};
  if (given_forces)
    throw std::runtime_error(
        fmt::format("--force, --pressure, --gravity: body '{}' has [body.nonlinear], whose law is of tissue held at "
                    "displacements: give --hold "
                    "or --touch",
                    name_of(body)));
  ensure_archive(scene, body);  // it holds the press of the specimen
  const Archive archive = find_archive(scene, body, ArchivePart::header);
  return correction(archive,
                    {held_places(solved), solved.table.position, solved.table.displacement, solved.table.force});
}

struct Summary {
  std::size_t furthest = 0;  ///< row of the table with the largest displacement
  double displacement = 0;   ///< [m] its size
  double force = 0;          ///< [N] the largest of a node's
};

Summary summarise(const SolutionTable& table) {
  Summary summary;
  for (std::size_t i = 0; i < table.node.size(); ++i) {
    if (table.displacement[i].norm() > table.displacement[summary.furthest].norm()) summary.furthest = i;
    summary.force = std::max(summary.force, table.force[i].norm());
  }
  summary.displacement = table.displacement[summary.furthest].norm();
  return summary;
}

void print_summary(const SolutionTable& table, const std::string& method, std::optional<double> corrected) {
  const Summary of = summarise(table);
  if (corrected) fmt::print("corrected by [body.nonlinear]: forces are {:.4g} times the linear ones\n", *corrected);
  fmt::print("{}: {} nodes, largest displacement {:.6g} m at node {}, largest nodal force {:.6g} N\n", method,
             table.node.size(), of.displacement, table.node[of.furthest], of.force);
}

void print_json(const SolutionTable& table, const std::string& method, std::optional<double> corrected) {
  const Summary of = summarise(table);
  nlohmann::ordered_json figures{{"method", method},
                                 {"nodes", table.node.size()},
                                 {"max_displacement_m", of.displacement},
                                 {"max_displacement_node", table.node[of.furthest]},
                                 {"max_nodal_force_n", of.force}};
  if (corrected) figures["correction"] = *corrected;
  fmt::print("{}\n", figures.dump());
}

void check_model(const Body& body) {
  if (!std::visit([](const auto& spec) { return has_static_states(spec); }, body))
    throw std::runtime_error(
        fmt::format("body '{}' is a {}, which has no static state to solve for", name_of(body), kind_of(body)));
}

bool loaded(const SolveArguments& arguments) {
  return !arguments.forces.empty() || !arguments.pressures.empty() || falls(arguments);
}

void solve_motion(const SolveArguments& arguments) {
  if (arguments.seconds == 0) throw std::runtime_error("--dynamic: for how long? Give --seconds");
  solve_dynamic({arguments.scene, arguments.body, arguments.set, arguments.seconds, arguments.every,
                 arguments.precision, arguments.csv, arguments.states, arguments.json});
}

void solve(const SolveArguments& arguments) {
  if (arguments.dynamic) return solve_motion(arguments);
  if (arguments.holds.empty() && arguments.touches.empty() && !loaded(arguments))
    throw std::runtime_error("nothing is held or loaded: give --hold, --touch, --force, --pressure or --gravity");
  if (falls(arguments) && arguments.method != "direct")
    throw std::runtime_error("--gravity: an archive knows no loads inside: take --method direct");
  if (arguments.plain && arguments.method == "direct")
    throw std::runtime_error("--plain: it is tensors that are summed: take --method tensors");
  const Scene scene = load_scene(arguments.scene, parse_changes(arguments.set));
  keep_files_of(scene, {arguments.csv, arguments.vtu});
  const Body& body = choose_body(scene, arguments.body);
  check_model(body);
  Solved solved =
      arguments.method == "direct" ? solve_by_direct(body, arguments) : solve_by_tensors(scene, body, arguments);
  const auto corrected = correct(scene, body, loaded(arguments), solved);
  const SolutionTable& table = solved.table;
  require_numbers(table.node, table.displacement, table.force);
  if (!arguments.csv.empty()) write_csv(table, arguments.csv);
  if (!arguments.vtu.empty()) write_vtu(table, arguments.vtu);
  if (arguments.json)
    print_json(table, arguments.method, corrected);
  else
    print_summary(table, arguments.method, corrected);
}

}  // namespace

void add_solve_command(cli::Command& app) {
  cli::Command command = app.add_command("solve", "Compute a static state of a body, or its motion, offline");
  auto arguments = std::make_shared<SolveArguments>();
  command.add_option("SCENE", arguments->scene, "Scene file").required();
  add_set_option(command, arguments->set);
  command.add_option("--body", arguments->body, "Name of the body; needed where the scene has several");
  command
      .add_option("--hold", arguments->holds,
                  "\"NODE:ux,uy,uz\": hold a node (0-based, of the mesh file) at a displacement in metres; an empty "
                  "component leaves that axis free; \"GROUP:ux,uy,uz\": each node of a group of the mesh")
      .one_value_each_time();
  command
      .add_option("--touch", arguments->touches,
                  "\"x,y,z:dx,dy,dz\": move the surface point nearest to x,y,z by dx,dy,dz (barycentric rule)")
      .one_value_each_time();
  command
      .add_option(
          "--force", arguments->forces,
          "\"NODE:fx,fy,fz\": load a node by a force in newtons; several add up, and go with --hold and --touch")
      .one_value_each_time();
  command
      .add_option("--pressure", arguments->pressures,
                  "\"GROUP:p\": press on the triangles of the surface whose corners are in a group of the mesh, by p "
                  "pascals against their normals")
      .one_value_each_time();
  command.add_option("--gravity", arguments->gravity, "x y z: the body's own weight, in m/s2; with --method direct");
  command.add_option("--method", arguments->method, "tensors: through the archive; direct: the full system afresh")
      .one_of({"tensors", "direct"})
      .show_default();
  command
      .add_flag("--plain", arguments->plain,
                "sum what each held node would do alone, without what the others do to it (TVCG99 fig. 10): to see "
                "what the correction is worth")
      .excludes({"--touch", "--force", "--pressure", "--gravity"});
  command
      .add_option("--csv", arguments->csv,
                  "Write node,x,y,z,ux,uy,uz,fx,fy,fz: force on the tissue; with direct at all nodes, reactions of "
                  "fixed axes included; with tensors at the free nodes of the surface, reactions left at zero")
      .output_file(".csv");
  command
      .add_option("--vtu", arguments->vtu,
                  "Write a file for ParaView, with direct also the stress in each element, as of linear ones")
      .output_file(".vtu");
  const cli::Option dynamic =
      command
          .add_flag("--dynamic", arguments->dynamic,
                    "in place of a static state the motion of a body that has inertia, with the scene's tools, in lock "
                    "step from rest; the CSV has time,node,x,y,z,ux,uy,uz,vx,vy,vz at every moving node")
          .excludes({"--hold", "--touch", "--force", "--pressure", "--gravity", "--plain", "--vtu"});
  command.add_option("--seconds", arguments->seconds, "With --dynamic: how long").positive().needs(dynamic);
  command.add_option("--every", arguments->every, "Seconds from state to state (default: the last one alone)")
      .positive()
      .needs(dynamic);
  command
      .add_option("--states", arguments->states,
                  "With --dynamic: a new folder of VTU files and the list of their times")
      .needs(dynamic);
  command.add_option("--precision", arguments->precision, "Of its motion (default: the scene's)")
      .one_of({"single", "double"})
      .needs(dynamic);
  command.add_flag("--json", arguments->json, "Print one line of JSON");
  command.examples(
      {"palpate solve scenes/plate.toml --touch \"0,0,0.01:0,0,-0.004\" --vtu out/plate.vtu",
       "palpate solve scenes/plate.toml --force \"12:0,0,-0.5\" --method direct --csv out/plate.csv",
       "palpate solve scenes/plate.toml --set body.poisson=0.3 --hold 900:0,0,-0.001 --json",
       "palpate solve scenes/plate_cut.toml --dynamic --seconds 2 --every 0.02 --states out/plate_states"});
  command.does([arguments] { solve(*arguments); });
}

}  // namespace palpate
