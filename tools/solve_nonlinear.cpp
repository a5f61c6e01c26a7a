#include "tools/solve_nonlinear.hpp"

#include <algorithm>
#include <set>

namespace palpate {

double correct_solution(const QuasiNonlinear& law, const std::vector<Constraint>& held, SolutionTable& table) {
  std::set<int> numbers;
  for (const Constraint& constraint : held)
    for (const Constraint::Term& term : constraint.terms) numbers.insert(term.node);
  std::vector<int> places;  // of the held nodes in the table, ascending
  Eigen::Vector3d resultant = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < table.node.size(); ++i) {
    if (!numbers.contains(table.node[i])) continue;
    places.push_back(static_cast<int>(i));
    resultant += table.force[i];
  }
  const double size = resultant.norm();
  if (!(size > 0)) return 1;
  const std::span<double> field(table.displacement.data()->data(), 3 * table.displacement.size());
  correct_radial<double>(law, field, resultant / size, places, field);
  const double scale = law.force_scale(size);
  for (Eigen::Vector3d& force : table.force) force *= scale;
  return scale;
}

}  // namespace palpate
