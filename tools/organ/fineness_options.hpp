#pragma once
#include <string>
#include <vector>

#include "common/cli/command_line.hpp"
#include "common/mesh/measures.hpp"
#include "tools/organ/organ_mesh.hpp"
#include "tools/organ/output.hpp"

namespace palpate {

/// The options that `palpate mesh` and `palpate organ` share.
struct MeshOptions {
  std::string output, report, scene;
  int nodes = 1500;
  double edge = 0, inside = 0, deviation = 0, density = kTissueDensity, tool_radius = 0;
  std::vector<std::string> fine, groups;
  bool json = false;
  const char* if_strange = "is --unit right?";  ///< asked where the mesh is no organ's by its size
};

void add_mesh_options(cli::Command& command, MeshOptions& options);

/// Throws std::runtime_error where a place cannot be read, a tool has no group to be opposite to, or the folder of a
/// file that will be written is not there.
MeshFineness fineness_of(const MeshOptions& options);

/// Where tools touch a surface that is told by points of it [m], if --tool-radius (opposite to the first group) or
/// --for asks for it: edges there are half the tip's radius. Throws std::runtime_error.
void add_touched_places(MeshFineness& fineness, const MeshOptions& options, const std::vector<Eigen::Vector3d>& surface,
                        Output& out);

/// Gives the mesh the groups that are asked for. Throws std::runtime_error.
void add_groups(TetMesh& mesh, const MeshOptions& options);

/// Writes the mesh where it was asked for, all of it or nothing, and tells its measures and what it will take. Throws
/// std::runtime_error.
void write_mesh(const TetMesh& mesh, const MeshOptions& options, Output& out);

/// Both.
void finish_mesh(TetMesh mesh, const MeshOptions& options, Output& out);

/// Progress, on standard error.
void say_progress(const std::string& line);

}  // namespace palpate
