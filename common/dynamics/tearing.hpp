#pragma once
#include <Eigen/Core>
#include <array>
#include <span>
#include <vector>

#include "common/dynamics/elastic_mesh.hpp"
#include "common/dynamics/spec.hpp"

namespace palpate {

using Corners = std::array<Eigen::Vector3d, 4>;  ///< [m]

/// |V - V0| / V0, the present volume being signed: an inverted tetrahedron exceeds 1.
double volume_change(const Corners& rest, const Corners& present);
/// Mean of (l - l0) / l0 over the six edges; shortened edges count negative.
double mean_elongation(const Corners& rest, const Corners& present);
/// Largest (l - l0) / l0 of the six edges; negative if all are shorter.
double max_elongation(const Corners& rest, const Corners& present);

/// Looks for tetrahedra that are deformed beyond a threshold.
class TearSearch {
 public:
  /// Throws std::runtime_error if the threshold is not positive or the limit below one.
  TearSearch(const ElasticMesh& mesh, TearCriterion criterion, double threshold, int limit);

  /// These are gone: they tear no more.
  void remove(std::span<const int> tetrahedra);
  bool alive(int tetrahedron) const { return alive_[tetrahedron]; }

  /// Tetrahedra whose measure exceeds the threshold at the given node positions [m], worst first and of equal
  /// ones the lower number first, at most `limit`. They stay alive until remove(). Allocates nothing; valid
  /// until the next call.
  std::span<const int> find(std::span<const Eigen::Vector3d> position);

  /// The measure of one tetrahedron.
  double measure(int tetrahedron, std::span<const Eigen::Vector3d> position) const;

 private:
  struct Found {
    double measure;
    int tetrahedron;
  };
  std::vector<Eigen::Vector3d> rest_;
  std::vector<std::array<int, 4>> tetrahedra_;
  std::vector<char> alive_;
  TearCriterion criterion_;
  double threshold_;
  int limit_;
  std::vector<Found> found_;
  std::vector<int> worst_;
};

}  // namespace palpate
