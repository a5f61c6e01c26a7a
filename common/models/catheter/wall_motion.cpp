#include "common/models/catheter/wall_motion.hpp"

#include <algorithm>
#include <cmath>

namespace palpate {

constexpr int kSpread = 64;  // nodes whose motion stands for all

WallMotion::WallMotion(const DuctWall* wall) : wall_(wall) {
  if (!wall_) return;
  const auto modes = static_cast<Eigen::Index>(wall_->inverse().size());
  const int nodes = static_cast<int>(wall_->surface().positions().size()), spread = std::min(nodes, kSpread);
  nodes_.resize(nodes);
  before_.setZero(modes);
  now_.setZero(modes);
  rows_.resize(3, modes);
  spread_.resize(3 * spread, modes);
  moved_.setZero(3 * spread);
  for (int i = 0; i < spread; ++i)
    read_rows(static_cast<int>(static_cast<long>(i) * nodes / spread), spread_.data() + 3 * i * modes);
}

void WallMotion::read_rows(int node, double* rows) const {
  wall_->rows({{node, node, node}, {1, 0, 0}}, rows);
}

double WallMotion::expected() {
  if (now_.size() == 0) return 0;
  moved_.noalias() = spread_ * Eigen::Map<const Eigen::VectorXd>(wall_->free_motion().data(), now_.size());
  return std::sqrt(moved_.reshaped(3, moved_.size() / 3).colwise().squaredNorm().maxCoeff());
}

void WallMotion::set(std::span<const double> before, std::span<const double> now) {
  std::copy(before.begin(), before.end(), before_.begin());
  std::copy(now.begin(), now.end(), now_.begin());
  ++clock_;
}

const WallMotion::Node& WallMotion::at(int node) {
  Node& known = nodes_[node];
  if (now_.size() == 0 || known.stamp == clock_) return known;
  read_rows(node, rows_.data());
  known.before.noalias() = rows_ * before_;
  known.now.noalias() = rows_ * now_;
  known.stamp = clock_;
  return known;
}

Triangle WallMotion::before(int triangle) {
  Triangle corners = wall_->surface().corners(triangle);
  for (int v = 0; v < 3; ++v) corners[v] += at(wall_->surface().triangle(triangle)[v]).before;
  return corners;
}

Triangle WallMotion::now(int triangle) {
  Triangle corners = wall_->surface().corners(triangle);
  for (int v = 0; v < 3; ++v) corners[v] += at(wall_->surface().triangle(triangle)[v]).now;
  return corners;
}

}  // namespace palpate
