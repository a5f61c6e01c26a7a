#include "common/sim/local_stiffness.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <exception>
#include <numbers>
#include <stdexcept>

#include "common/fem/assembly.hpp"
#include "common/fem/dense.hpp"
#include "common/fem/factorisation.hpp"
#include "common/fem/ordering.hpp"
#include "common/log/log.hpp"
#include "common/realtime/settings.hpp"

namespace palpate {
namespace {

constexpr double kFloatingHz = 0.2;  // far below an organ's lowest frequency

// K + w^2 M over the free dofs of the remaining tetrahedra, with what is joined to it.
SparseMatrix static_matrix(const TetMesh& mesh, const MaterialField& materials, const DofMap& dofs,
                           const NodeGraph& graph, const Condensation& joined) {
  SparseMatrix k = assemble_stiffness(mesh, materials, dofs, graph);
  std::vector<Eigen::Triplet<double, std::int64_t>> extra;
  const double w = 2 * std::numbers::pi * kFloatingHz;
  for (std::size_t t = 0; t < mesh.tetrahedra.size(); ++t) {
    const auto& tet = mesh.tetrahedra[t];
    const double volume =
        tet_gradients({mesh.nodes[tet[0]], mesh.nodes[tet[1]], mesh.nodes[tet[2]], mesh.nodes[tet[3]]}).volume;
    for (int node : tet)
      for (int axis = 0; axis < 3; ++axis)
        if (dofs.is_free(node, axis))
          extra.emplace_back(dofs.index(node, axis), dofs.index(node, axis),
                             w * w * materials.at(static_cast<int>(t)).density * volume / 4);
  }
  const int n = 3 * static_cast<int>(joined.nodes.size());
  for (int i = 0; i < n; ++i)
    for (int j = 0; j <= i; ++j) {
      const int a = dofs.index(joined.nodes[i / 3], i % 3), b = dofs.index(joined.nodes[j / 3], j % 3);
      if (a >= 0 && b >= 0) extra.emplace_back(std::max(a, b), std::min(a, b), joined.stiffness(i, j));
    }
  SparseMatrix more(k.rows(), k.cols());
  more.setFromTriplets(extra.begin(), extra.end());
  k += more;
  k.makeCompressed();
  return k;
}

}  // namespace

int LocalStiffness::Answer::find(int node) const {
  const auto at = std::lower_bound(nodes.begin(), nodes.end(), node);
  return at != nodes.end() && *at == node ? static_cast<int>(at - nodes.begin()) : -1;
}

LocalStiffness::LocalStiffness(const ElasticMesh& mesh, Condensation joined, Worker worker)
    : mesh_(mesh), joined_(std::move(joined)) {
  if (worker == Worker::thread) worker_.emplace([this](const std::stop_token& stop) { work(stop); });
}

bool LocalStiffness::ask(std::span<const int> nodes, std::span<const int> removed) {
  const std::unique_lock lock(mutex_, std::try_to_lock);
  if (!lock || asked_) return false;
  question_.nodes.assign(nodes.begin(), nodes.begin() + std::min<std::size_t>(nodes.size(), kMaxNodes));
  question_.removed.assign(removed.begin(), removed.end());
  if (worker_) {
    asked_ = true;
    wake_.notify_one();
  } else {
    settle(answer(question_));
  }
  return true;
}

bool LocalStiffness::take() {
  const std::unique_lock lock(mutex_, std::try_to_lock);
  if (!lock || !answered_) return false;
  std::swap(current_, next_);
  answered_ = false;
  return true;
}

void LocalStiffness::work(const std::stop_token& stop) {
  leave_realtime();
  while (true) {
    Question question;
    {
      std::unique_lock lock(mutex_);
      if (!wake_.wait(lock, stop, [this] { return asked_; })) return;
      question = question_;
    }
    std::optional<Answer> found = answer(question);
    const std::lock_guard lock(mutex_);
    settle(std::move(found));
    asked_ = false;
  }
}

void LocalStiffness::settle(std::optional<Answer> found) {
  if (!found) return;  // the last answer stands
  next_ = std::move(*found);
  answered_ = true;
}

// None where what is left is too badly shaped.
std::optional<LocalStiffness::Answer> LocalStiffness::answer(const Question& question) {
  try {
    return solve(question);
  } catch (const std::exception& error) {
    log_warning(fmt::format("stiffness near the tools: {}", error.what()));
    return std::nullopt;
  }
}

// The free dofs with which a node goes along an axis, and how far: its own; of the joined part's nodes those of the
// nodes that join it.
template <class Visit>
void LocalStiffness::for_each_share(int node, int axis, const DofMap& dofs, Visit&& visit) const {
  if (!is_joined(node)) {
    if (dofs.is_free(node, axis)) visit(dofs.index(node, axis), 1.0);
    return;
  }
  const std::span<const double> follow = joined_.part->follow(node, axis);
  for (std::size_t k = 0; k < follow.size(); ++k) {
    const int dof = dofs.index(joined_.nodes[k / 3], static_cast<int>(k % 3));
    if (dof >= 0) visit(dof, follow[k]);
  }
}

// The nodes whose free dofs these go with.
std::vector<int> LocalStiffness::moving_nodes(const std::vector<int>& nodes) const {
  std::vector<int> moving;
  for (const int node : nodes)
    if (!is_joined(node)) moving.push_back(node);
  if (moving.size() == nodes.size()) return moving;
  for (const int node : joined_.nodes)
    if (std::ranges::find(moving, node) == moving.end()) moving.push_back(node);
  return moving;
}

const LocalStiffness::Left& LocalStiffness::left_after(const std::vector<int>& removed) {
  if (left_ && left_->removed == removed) return *left_;
  left_.reset();
  std::vector<bool> gone(mesh_.tetrahedra.size(), false);
  for (int t : removed) gone[t] = true;
  TetMesh mesh{.nodes = mesh_.rest, .tetrahedra = {}, .groups = {}};
  MaterialField materials{mesh_.materials, {}, {}};
  for (std::size_t t = 0; t < gone.size(); ++t) {
    if (gone[t]) continue;
    mesh.tetrahedra.push_back(mesh_.tetrahedra[t]);
    if (!mesh_.material_of.empty()) materials.of_element.push_back(mesh_.material_of[t]);
  }
  if (mesh_.element == TetElement::nodal_strain) materials.nodal_strain.assign(mesh.tetrahedra.size(), 1);
  Left left{removed, DofMap(mesh), {}, {}};
  for (int node = 0; node < mesh_.nodes(); ++node)
    for (int axis = 0; axis < 3; ++axis)
      if (mesh_.fixed[node][axis] && left.dofs.index(node, axis) != DofMap::kUnused) left.dofs.fix(node, axis);
  left.dofs.number();
  left.graph = node_graph(mesh, materials);
  left.matrix = static_matrix(mesh, materials, left.dofs, left.graph, joined_);
  return left_.emplace(std::move(left));
}

LocalStiffness::Answer LocalStiffness::solve(const Question& question) {
  Answer answer{.nodes = question.nodes, .compliance = {}, .topology = question.removed.size()};
  const auto n = static_cast<Eigen::Index>(answer.nodes.size());
  answer.compliance.setZero(3 * n, 3 * n);
  for (Eigen::Index i = 0; i < n; ++i)
    for (Eigen::Index j = 0; j < n; ++j)
      if (is_joined(answer.nodes[i]) && is_joined(answer.nodes[j]))
        answer.compliance.block<3, 3>(3 * i, 3 * j) = joined_.part->compliance(answer.nodes[i], answer.nodes[j]);
  if (n == 0) return answer;
  const Left& left = left_after(question.removed);
  const std::vector<int> moving = moving_nodes(answer.nodes);
  const std::vector<std::int64_t> last = dof_order(left.dofs, moving);
  const auto count = static_cast<Eigen::Index>(last.size());
  if (count == 0) return answer;

  Factorisation factor(left.matrix, dof_order(left.dofs, interior_first_order(left.graph, moving)));
  factor.factorise(left.matrix);
  Eigen::MatrixXd among = factor.trailing_factor(static_cast<int>(count));
  invert_from_cholesky(among);
  among.triangularView<Eigen::StrictlyUpper>() = among.transpose();

  std::vector<int> place(left.dofs.size(), -1);
  for (Eigen::Index i = 0; i < count; ++i) place[last[i]] = static_cast<int>(i);
  std::vector<Eigen::Triplet<double>> shares;
  for (int row = 0; row < 3 * n; ++row)
    for_each_share(answer.nodes[row / 3], row % 3, left.dofs,
                   [&](int dof, double share) { shares.emplace_back(row, place[dof], share); });
  Eigen::SparseMatrix<double> goes_with(3 * n, count);
  goes_with.setFromTriplets(shares.begin(), shares.end());
  answer.compliance += goes_with * (goes_with * among).transpose();
  return answer;
}

namespace {

void visit(State& s, LocalStiffness::Answer& answer) {
  std::vector<double> compliance(answer.compliance.data(), answer.compliance.data() + answer.compliance.size());
  s.list(answer.nodes);
  s.list(compliance);
  s.value(answer.topology);
  if (!s.restoring()) return;
  const std::size_t rows = 3 * answer.nodes.size();
  s.require(compliance.size() == rows * rows, "the recorded state holds a stiffness that cannot be");
  const auto n = static_cast<Eigen::Index>(rows);
  answer.compliance = Eigen::Map<const Eigen::MatrixXd>(compliance.data(), n, n);
}

}  // namespace

void LocalStiffness::state(State& s) {
  visit(s, current_);
  visit(s, next_);
  s.value(answered_);
}

}  // namespace palpate
