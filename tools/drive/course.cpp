#include "tools/drive/course.hpp"

#include <fmt/format.h>

#include <stdexcept>

namespace palpate::drive {

Course::Course(const std::filesystem::path& file, const Scene& scene)
    : path_(file), file_(std::fopen(file.c_str(), "w")) {
  if (!file_) throw std::runtime_error(fmt::format("{}: cannot be written", file.string()));
  std::string heading = "time";
  for (const Tool& tool : scene.tools)
    for (const char* column : {"x", "y", "z", "fx", "fy", "fz", "grip"})
      heading += fmt::format(",{}.{}", tool.name, column);
  std::fputs((heading + "\n").c_str(), file_.get());
}

void Course::write(const sim::Simulator& simulator) {
  std::string line = fmt::format("{}", static_cast<double>(simulator.steps() - 1) * simulator.dt());
  for (int t = 0; t < simulator.tools(); ++t) {
    const sim::ToolView tool = simulator.tool(t);
    const Eigen::Vector3d tip = tool.pose.translation();
    line += fmt::format(",{},{},{},{},{},{},{}", tip.x(), tip.y(), tip.z(), tool.force.x(), tool.force.y(),
                        tool.force.z(), tool.grip_torque);
  }
  std::fputs((line + "\n").c_str(), file_.get());
}

void Course::finish() {
  if (std::fflush(file_.get()) != 0 || std::ferror(file_.get()))
    throw std::runtime_error(fmt::format("{}: cannot be written", path_.string()));
}

}  // namespace palpate::drive
