#pragma once
#include <Eigen/Core>
#include <condition_variable>
#include <cstdint>
#include <mutex>
#include <optional>
#include <span>
#include <stop_token>
#include <thread>
#include <vector>

#include "common/describe/state.hpp"
#include "common/dynamics/condensed_part.hpp"
#include "common/dynamics/elastic_mesh.hpp"
#include "common/fem/assembly.hpp"
#include "common/fem/boundary_conditions.hpp"

namespace palpate {

/// Stiffness of one part of a body that is condensed onto some of its nodes, to be added where it is joined.
struct Condensation {
  std::vector<int> nodes;
  Eigen::MatrixXd stiffness;            ///< [N/m] 3 nodes x 3 nodes; rows of fixed axes are zero
  const CondensedPart* part = nullptr;  ///< what its other nodes do; outlives this
};

/// The static compliance of a dynamic body at a few of its nodes, for the local contact model. It is solved from the
/// remaining tetrahedra, mostly on a thread of its own; the loop asks and takes answers without waiting, and goes on
/// with the last answer meanwhile. A part that floats is held by its inertia at a fifth of a hertz.
class LocalStiffness {
 public:
  static constexpr int kMaxNodes = 64;

  /// Who solves: a thread, so that ask() returns at once; or ask() itself, so that what is known when does not depend
  /// on how fast a thread is.
  enum class Worker { thread, caller };

  struct Answer {
    std::vector<int> nodes;      ///< ascending
    Eigen::MatrixXd compliance;  ///< [m/N] 3n x 3n among them; rows of fixed axes are zero
    std::uint64_t topology = 0;  ///< cuts that it knows of
    int find(int node) const;    ///< place of a node, or -1
    Eigen::Matrix3d block(int i, int j) const { return compliance.block<3, 3>(3 * i, 3 * j); }
  };

  LocalStiffness(const ElasticMesh& mesh, Condensation joined, Worker worker);

  /// Wants these nodes (ascending, the first max_nodes count) after the removal of all of `removed` so far. The newest
  /// question is answered; false if the worker is at it, so that it was not taken.
  bool ask(std::span<const int> nodes, std::span<const int> removed);
  /// True if a newer answer has come; it is then current().
  bool take();
  const Answer& current() const { return current_; }

  /// The answers, the one that waits to be taken too; where the caller works. Restoring throws std::runtime_error on
  /// what cannot be.
  void state(State& s);

 private:
  struct Question {
    std::vector<int> nodes, removed;
  };
  void work(const std::stop_token& stop);
  void settle(std::optional<Answer> found);
  std::optional<Answer> answer(const Question& question);
  bool is_joined(int node) const { return joined_.part && joined_.part->owns(node); }
  template <class Visit>
  void for_each_share(int node, int axis, const DofMap& dofs, Visit&& visit) const;
  std::vector<int> moving_nodes(const std::vector<int>& nodes) const;
  /// What is left of the tissue: the same for all questions until more is removed.
  struct Left {
    std::vector<int> removed;
    DofMap dofs;
    NodeGraph graph;
    SparseMatrix matrix;
  };
  const Left& left_after(const std::vector<int>& removed);
  Answer solve(const Question& question);

  const ElasticMesh mesh_;
  const Condensation joined_;
  std::optional<Left> left_;  ///< of the newest question; who solves alone uses it
  Answer current_, next_;
  Question question_;
  bool asked_ = false, answered_ = false;
  std::mutex mutex_;
  std::condition_variable_any wake_;
  std::optional<std::jthread> worker_;  ///< none where the caller works
};

}  // namespace palpate
