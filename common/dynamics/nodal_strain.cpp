#include "common/dynamics/nodal_strain.hpp"

#include <algorithm>
#include <numeric>
#include <tuple>

#include "common/dynamics/stability.hpp"

namespace palpate {

using kernels::kNodeWidth;
using kernels::kStressSize;
using kernels::kTieSize;

namespace {

constexpr int kWindow = 256;  // rows whose patches stay near one another in memory

std::vector<std::span<const int>> lists_of(const NodalPatches& patches) {
  std::vector<std::span<const int>> lists;
  for (int p = 0; p < patches.size(); ++p) lists.push_back(patches.nodes(p));
  return lists;
}

}  // namespace

template <class Scalar>
NodalStrain<Scalar>::NodalStrain(const ElasticMesh& mesh, Integrator integrator, double damping)
    : LinearTissue<Scalar>(mesh, integrator, damping),
      patches_(mesh.rest, mesh.tetrahedra, mesh.materials, mesh.material_of),
      alive_(mesh.tetrahedra.size(), 1),
      volume_(patches_.size(), 0),
      around_(incidence(lists_of(patches_), mesh.nodes())) {
  bound_frequencies(mesh);
  lay_out_ties();
  lay_out_shares();
  for (int p = 0; p < patches_.size(); ++p) write_patch(p);
  rows_ = {patches_.size(), this->nodes(), node_.data(),   begin_.data(), column_.data(), tie_.data(),
           patch_.data(),   first_.data(), member_.data(), share_.data(), stress_.data()};
}

template <class Scalar>
void NodalStrain<Scalar>::bound_frequencies(const ElasticMesh& mesh) {
  for (int t = 0; t < static_cast<int>(mesh.tetrahedra.size()); ++t) {
    const auto& [a, b, c, d] = mesh.tetrahedra[t];
    const TetGradients tet = tet_gradients({mesh.rest[a], mesh.rest[b], mesh.rest[c], mesh.rest[d]});
    const Lame constants = lame(mesh.material(t));
    const double bound =
        averaged_frequency_squared(tet, constants, NodalPatches::kShare * constants.mu, mesh.material(t).density);
    frequency_squared_ = std::max(frequency_squared_, bound);
  }
}

/// Patches by the row of their own node, within a window of rows by their size, which is then foreseen; the own node is
/// left out.
template <class Scalar>
void NodalStrain<Scalar>::lay_out_ties() {
  std::vector<int> order(patches_.size());
  std::iota(order.begin(), order.end(), 0);
  std::ranges::sort(order, {}, [&](int p) {
    const int own = row(patches_.node(p));
    return std::tuple(own / kWindow, patches_.nodes(p).size(), own, p);
  });
  place_.resize(patches_.size());
  begin_.push_back(0);
  std::size_t most = 0;
  for (int at = 0; at < patches_.size(); ++at) {
    const int p = order[at];
    place_[p] = at;
    node_.push_back(row(patches_.node(p)));
    for (const int n : patches_.nodes(p))
      if (n != patches_.node(p)) column_.push_back(kNodeWidth * row(n));
    if (column_.size() % 2 != 0) column_.push_back(kNodeWidth * node_.back());
    begin_.push_back(static_cast<int>(column_.size()));
    most = std::max(most, patches_.nodes(p).size());
  }
  ties_.resize(most);
  tie_.assign(kTieSize * column_.size(), 0);
  patch_.assign(static_cast<std::size_t>(kTieSize) * patches_.size(), 0);
  stress_.assign(static_cast<std::size_t>(kStressSize) * patches_.size(), 0);
}

/// For each row the patches that it belongs to, in the order of their places.
template <class Scalar>
void NodalStrain<Scalar>::lay_out_shares() {
  std::vector<std::vector<std::array<int, 3>>> rows(this->nodes());  // place, patch, place in the patch's list
  for (int p = 0; p < patches_.size(); ++p)
    for (int j = 0; j < static_cast<int>(patches_.nodes(p).size()); ++j)
      rows[row(patches_.nodes(p)[j])].push_back({place_[p], p, j});
  share_of_.resize(patches_.size());
  for (int p = 0; p < patches_.size(); ++p) share_of_[p].resize(patches_.nodes(p).size());
  first_.push_back(0);
  for (auto& members : rows) {
    std::ranges::sort(members);
    for (const auto& [place, p, j] : members) {
      share_of_[p][j] = static_cast<int>(member_.size());
      member_.push_back(kStressSize * place);
    }
    if (member_.size() % 2 != 0) member_.push_back(member_.back());
    first_.push_back(static_cast<int>(member_.size()));
  }
  share_.assign(kTieSize * member_.size(), 0);
}

template <class Scalar>
void NodalStrain<Scalar>::write_patch(int patch) {
  const auto nodes = patches_.nodes(patch);
  const double volume = volume_[patch] = patches_.sum(patch, alive_, std::span(ties_).first(nodes.size()));
  const Lame& constants = patches_.lame(patch);
  const double each = volume > 0 ? 1 / volume : 0;
  Scalar* of_patch = &patch_[static_cast<std::size_t>(kTieSize) * place_[patch]];
  of_patch[0] = static_cast<Scalar>(each * constants.lambda);
  of_patch[1] = static_cast<Scalar>(each * constants.mu);
  of_patch[2] = static_cast<Scalar>(each * patches_.stabilisation(patch));
  Scalar* tie = &tie_[static_cast<std::size_t>(kTieSize) * begin_[place_[patch]]];
  for (std::size_t j = 0; j < nodes.size(); ++j) {
    Scalar* share = &share_[static_cast<std::size_t>(kTieSize) * share_of_[patch][j]];
    for (int k = 0; k < 3; ++k) share[k] = static_cast<Scalar>(ties_[j][k]);
    if (nodes[j] == patches_.node(patch)) continue;
    for (int k = 0; k < 4; ++k) tie[k] = static_cast<Scalar>(ties_[j][k]);
    tie += kTieSize;
  }
}

template <class Scalar>
void NodalStrain<Scalar>::rewrite(int tetrahedron) {
  if (!alive_[tetrahedron]) return;
  alive_[tetrahedron] = 0;
  for (const int patch : patches_.around(tetrahedron)) write_patch(patch);
}

template <class Scalar>
void NodalStrain<Scalar>::rk4_first(const Arrays& arrays, double damping) {
  this->of_type(this->kernels().patch_rk4_first_f, this->kernels().patch_rk4_first_d)(rows_, arrays, damping);
}

template <class Scalar>
void NodalStrain<Scalar>::rk4_second(const Arrays& arrays, double damping, double dt) {
  this->of_type(this->kernels().patch_rk4_second_f, this->kernels().patch_rk4_second_d)(rows_, arrays, damping, dt);
}

template <class Scalar>
void NodalStrain<Scalar>::semi_implicit(const Arrays& arrays, double damping, double dt) {
  this->of_type(this->kernels().patch_semi_implicit_f, this->kernels().patch_semi_implicit_d)(rows_, arrays, damping,
                                                                                              dt);
}

template <class Scalar>
void NodalStrain<Scalar>::forward_euler(const Arrays& arrays, double damping, double dt) {
  this->of_type(this->kernels().patch_forward_euler_f, this->kernels().patch_forward_euler_d)(rows_, arrays, damping,
                                                                                              dt);
}

/// What a patch exerts on the nodes of it that `take` is given, by their places in its list.
template <class Scalar>
template <class Take>
void NodalStrain<Scalar>::exert(int patch, Take&& take) const {
  if (volume_[patch] == 0) return;
  const auto nodes = patches_.nodes(patch);
  const int own = patches_.node(patch);
  const auto gradient = [&](std::size_t j) {
    const Scalar* g = &share_[static_cast<std::size_t>(kTieSize) * share_of_[patch][j]];
    return Eigen::Vector3d(g[0], g[1], g[2]);
  };
  Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
  Eigen::Vector3d tied = Eigen::Vector3d::Zero();
  const Scalar* tie = &tie_[static_cast<std::size_t>(kTieSize) * begin_[place_[patch]]];
  for (std::size_t j = 0; j < nodes.size(); ++j) {
    if (nodes[j] == own) continue;
    const Eigen::Vector3d d = displacement(nodes[j]) - displacement(own);
    sum += d * gradient(j).transpose();
    tied += tie[3] * d;
    tie += kTieSize;
  }
  const Eigen::Matrix3d stress = patch_stress(patches_.lame(patch), patches_.stabilisation(patch), volume_[patch], sum);
  for (std::size_t j = 0; j < nodes.size(); ++j)
    take(nodes[j], -stress * gradient(j) - (nodes[j] == own ? tied : Eigen::Vector3d::Zero()));
}

template <class Scalar>
Eigen::Vector3d NodalStrain<Scalar>::elastic_force(int node) const {
  Eigen::Vector3d force = Eigen::Vector3d::Zero();
  for (const int patch : around_.of(node))
    exert(patch, [&](int n, const Eigen::Vector3d& share) {
      if (n == node) force += share;
    });
  return force;
}

/// Half of minus force times displacement, the force being linear.
template <class Scalar>
double NodalStrain<Scalar>::elastic_energy() const {
  double sum = 0;
  for (int p = 0; p < patches_.size(); ++p)
    exert(p, [&](int n, const Eigen::Vector3d& share) { sum -= 0.5 * share.dot(displacement(n)); });
  return sum;
}

template class NodalStrain<float>;
template class NodalStrain<double>;

}  // namespace palpate
