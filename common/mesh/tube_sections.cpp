#include <Eigen/Geometry>
#include <Eigen/SparseCholesky>
#include <algorithm>
#include <limits>
#include <set>
#include <stdexcept>

#include "common/mesh/shell_quality.hpp"

namespace palpate {
namespace {

using Line = std::array<Eigen::Vector3d, 2>;

double distance(const Eigen::Vector3d& point, const Line& line) {
  const Eigen::Vector3d along = line[1] - line[0];
  const double length = along.squaredNorm();
  const double s = length > 0 ? std::clamp((point - line[0]).dot(along) / length, 0.0, 1.0) : 0;
  return (line[0] + s * along - point).norm();
}

TubeSection section_of(const std::vector<Line>& lines) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  double total = 0;
  for (const Line& line : lines) {
    const double length = (line[1] - line[0]).norm();
    sum += 0.5 * length * (line[0] + line[1]);
    total += length;
  }
  TubeSection section{sum / total, std::numeric_limits<double>::infinity()};
  for (const Line& line : lines) section.radius = std::min(section.radius, distance(section.centre, line));
  return section;
}

std::vector<Line> mouth_lines(const ShellMesh& mesh, const std::vector<int>& loop) {
  std::vector<Line> lines;
  for (std::size_t i = 0; i < loop.size(); ++i)
    lines.push_back({mesh.nodes[loop[i]], mesh.nodes[loop[(i + 1) % loop.size()]]});
  return lines;
}

/// Where the level crosses the triangles.
std::vector<Line> level_lines(const ShellMesh& mesh, const std::vector<double>& value, double level) {
  std::vector<Line> lines;
  for (const auto& t : mesh.triangles) {
    std::vector<Eigen::Vector3d> cut;
    for (int c = 0; c < 3; ++c) {
      const int a = t[c], b = t[(c + 1) % 3];
      if ((value[a] < level) == (value[b] < level)) continue;
      const double s = (level - value[a]) / (value[b] - value[a]);
      cut.push_back((1 - s) * mesh.nodes[a] + s * mesh.nodes[b]);
    }
    if (cut.size() == 2) lines.push_back({cut[0], cut[1]});
  }
  return lines;
}

/// The harmonic function of tube_sections() per node; nodes that no triangle uses have 0.
std::vector<double> harmonic(const ShellMesh& mesh, const std::vector<std::vector<int>>& mouths) {
  std::vector<double> value(mesh.nodes.size(), 0);
  std::vector<int> unknown(mesh.nodes.size(), 0);
  for (int m : {0, 1})
    for (int n : mouths[m]) {
      value[n] = m;
      unknown[n] = -1;
    }
  std::set<std::array<int, 2>> pairs;
  for (const auto& t : mesh.triangles)
    for (int c = 0; c < 3; ++c) pairs.insert({std::min(t[c], t[(c + 1) % 3]), std::max(t[c], t[(c + 1) % 3])});
  std::vector<int> degree(mesh.nodes.size(), 0);
  for (const auto& pair : pairs)
    for (int n : pair) ++degree[n];
  int count = 0;
  for (std::size_t n = 0; n < unknown.size(); ++n) unknown[n] = unknown[n] < 0 || degree[n] == 0 ? -1 : count++;
  if (count == 0) return value;

  std::vector<Eigen::Triplet<double>> entries;
  Eigen::VectorXd right = Eigen::VectorXd::Zero(count);
  for (std::size_t n = 0; n < unknown.size(); ++n)
    if (unknown[n] >= 0) entries.emplace_back(unknown[n], unknown[n], degree[n]);
  for (const auto& [a, b] : pairs)
    for (const auto& [row, column] : {std::pair(a, b), std::pair(b, a)}) {
      if (unknown[row] < 0) continue;
      if (unknown[column] >= 0)
        entries.emplace_back(unknown[row], unknown[column], -1.0);
      else
        right[unknown[row]] += value[column];
    }
  Eigen::SparseMatrix<double> matrix(count, count);
  matrix.setFromTriplets(entries.begin(), entries.end());
  const Eigen::VectorXd solved = Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>>(matrix).solve(right);
  for (std::size_t n = 0; n < unknown.size(); ++n)
    if (unknown[n] >= 0) value[n] = solved[unknown[n]];
  return value;
}

}  // namespace

std::vector<TubeSection> tube_sections(const ShellMesh& mesh, int count) {
  const auto mouths = boundary_loops(mesh.triangles);
  if (mouths.size() != 2) throw std::runtime_error("a shell that has not two mouths is no tube");
  const std::vector<double> value = harmonic(mesh, mouths);
  std::vector<TubeSection> sections{section_of(mouth_lines(mesh, mouths[0]))};
  for (int k = 1; k < count; ++k)
    sections.push_back(section_of(level_lines(mesh, value, k / static_cast<double>(count))));
  sections.push_back(section_of(mouth_lines(mesh, mouths[1])));
  return sections;
}

double lumen_radius(const ShellMesh& mesh) {
  double least = std::numeric_limits<double>::infinity();
  for (const TubeSection& section : tube_sections(mesh)) least = std::min(least, section.radius);
  return least;
}

}  // namespace palpate
