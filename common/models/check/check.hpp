#pragma once
#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "common/archive/archive.hpp"
#include "common/contact/spec.hpp"
#include "common/geometry/segment.hpp"
#include "common/mesh/shell_mesh.hpp"
#include "common/shell/spec.hpp"
#include "common/tool/spec.hpp"
#include "common/tool/trajectory.hpp"

namespace palpate {

/// A part of the run time and the memory it takes.
struct MemoryPart {
  std::string owner;  ///< the program, or "disk"
  std::string what;
  std::size_t bytes;
};

/// What a check of a body needs to know besides the body.
struct CheckSettings {
  const ContactSpec& contact;
  std::span<const Tool> tools;
  /// The motion of one of them, where it is known before the run.
  std::function<std::optional<Trajectory>(const Tool&)> script;
  double dt;  ///< [s] of a haptic step
  /// The archive on disk if it is good; empty if there is none or it is refused.
  std::function<std::optional<Archive>(ArchivePart)> stored;
  /// Another body of the scene as the wall that bodies may be led into; null if there is none of that name.
  std::function<const ShellSpec*(const std::string& body)> find_wall;
  /// Asks every body of the scene whether it can be led into that wall. Throws std::runtime_error.
  std::function<void(const ShellSpec& wall, const ShellMesh& mesh)> check_guests;
};

/// What a check says of a body.
struct CheckReport {
  std::function<void(const std::string& line)> say;  ///< called as the check goes on
  std::vector<MemoryPart> memory;
  std::vector<std::string> left_out;  ///< what a simpler body than others goes without
  std::vector<std::string> warnings;  ///< what is legal but likely not meant
  /// Whether a part of a tool meets the body at rest, or lies inside one that is solid.
  std::function<bool(const Segment& axis, double radius)> meets;
  bool sags = false;  ///< its weight takes it elsewhere
};

}  // namespace palpate
