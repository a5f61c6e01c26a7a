#pragma once
#include <filesystem>
#include <string>
#include <vector>

namespace palpate {

/// What is asked of the motion of a body.
struct DynamicArguments {
  std::string scene, body;
  std::vector<std::string> set;       ///< for parse_changes()
  double seconds = 0, every = 0;      ///< [s] how long, and from state to state that is written; 0: the last one alone
  std::string precision;              ///< single | double; empty: the scene's
  std::filesystem::path csv, states;  ///< a file, a new folder of files for ParaView; empty: none
  bool json = false;
};

/// Moves the whole scene on in lock step, from rest, and writes the states of one body of moving tissue: its nodes'
/// displacements and velocities. Throws std::runtime_error of a body that has no inertia, of a time from state to state
/// that is less than a tick, of a folder that holds something else, or if it is stopped.
void solve_dynamic(const DynamicArguments& arguments);

}  // namespace palpate
