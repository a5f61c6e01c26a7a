#pragma once
#include <Eigen/Core>
#include <functional>
#include <memory>
#include <span>

#include "common/archive/archive.hpp"
#include "common/archive/compressed_compliance.hpp"
#include "common/fem/progress.hpp"

namespace palpate {

/// [m/N] displacement of every surface node, three rows each, under unit forces on some, three columns each; zero along
/// fixed axes.
using ColumnsOf = std::function<Eigen::MatrixXd(std::span<const int> nodes)>;

/// The compliance of a surface as blocks, asked for cluster by cluster and never there as a whole: what is far apart of
/// each other as U V^T, V orthonormal, of the lowest rank that leaves out kLeftOut at most.
std::shared_ptr<const CompressedCompliance> compress(const SurfaceMap& surface, const ColumnsOf& columns_of,
                                                     const Progress& progress = {});

/// [bytes] About what it will take, by where the nodes are.
std::size_t compressed_bytes(const SurfaceMap& surface);

/// [1] Root mean square of the entries that a block of low rank is off by, over what a node moves under its own force.
inline constexpr double kLeftOut = 1e-5;

}  // namespace palpate
