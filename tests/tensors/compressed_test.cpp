#include <gtest/gtest.h>

#include <random>

#include "common/archive/archive.hpp"
#include "common/archive/load_sum.hpp"
#include "common/archive/scale_young.hpp"
#include "common/archive/static_solve.hpp"
#include "common/models/quasi_static/precompute.hpp"
#include "tests/fem/meshes_for_tests.hpp"
#include "tests/tensors/files_for_tests.hpp"
#include "tests/tensors/spread_holds.hpp"

namespace palpate {
namespace {

using Eigen::Matrix3d;
using Eigen::VectorXd;

Archive compute(const QuasiStaticSpec& body, TensorForm form) {
  return precompute(body, testing::make_organ({14, 10, 4}), nullptr, {}, Route::fastest, nullptr, form);
}

/// A part of the surface cannot be touched, and one node is fixed along an axis.
QuasiStaticSpec partly_touchable() {
  auto body = testing::make_body();
  body.touchable = NodeSelector{{{}, Box{{-1, -1, 0.005}, {1, 1, 1}}, ""}};
  body.fixed.push_back(
      {.where = {.indices = {}, .box = Box{{0.05, -1, 0.03}, {1, 1, 1}}}, .axes = {true, false, true}});
  return body;
}

/// What a node moves under its own force.
double mean_own(const Archive& archive) {
  const Compliance<double> compliance(archive, Compliance<double>::Rows::touchable);
  double sum = 0;
  for (int node = 0; node < compliance.row_nodes(); ++node) sum += compliance.block(node, node).trace() / 3;
  return sum / compliance.row_nodes();
}

/// The same body both ways, computed once for all tests.
struct Both {
  Archive dense = compute(partly_touchable(), TensorForm::dense);
  Archive compressed = compute(partly_touchable(), TensorForm::compressed);
  double own = mean_own(dense);  ///< [m/N]
};

const Both& both() {
  static const Both once;
  return once;
}

template <class Scalar>
Compliance<Scalar> of(const Archive& archive) {
  return Compliance<Scalar>(archive, Compliance<Scalar>::Rows::surface);
}

TEST(Compressed, IsTheDenseOneToAThousandth) {
  const auto dense = of<double>(both().dense), compressed = of<double>(both().compressed);
  ASSERT_GT(dense.row_nodes(), dense.column_nodes());
  ASSERT_GT(both().compressed.compressed->max_rank(), 0);
  double worst = 0;
  for (int i = 0; i < dense.row_nodes(); ++i)
    for (int j = 0; j < dense.column_nodes(); ++j)
      worst = std::max(worst, (dense.block(i, j) - compressed.block(i, j)).cwiseAbs().maxCoeff());
  EXPECT_LT(worst, 1e-3 * both().own);
  EXPECT_LT(compressed.bytes(), dense.bytes() / 3);
}

TEST(Compressed, IsSymmetricAndKeepsFixedAxesAtZero) {
  const auto c = of<double>(both().compressed);
  const SurfaceMap& map = both().compressed.surface;
  for (int i = 0; i < c.row_nodes(); ++i)
    for (int j = 0; j < c.column_nodes(); ++j) {
      const Matrix3d block = c.block(i, j);
      if (i < c.column_nodes()) {
        ASSERT_EQ(block, c.block(j, i).transpose());
      }
      for (int axis = 0; axis < 3; ++axis)
        if (map.fixed[i][axis]) {
          ASSERT_LT(block.row(axis).cwiseAbs().maxCoeff(), 1e-9 * both().own);
        }
    }
}

/// Forces here and there.
template <class Scalar>
void load(LoadSum<Scalar>& sum, int touchable) {
  std::mt19937 random(3);
  for (int k = 0; k < 40; ++k)
    sum.add(static_cast<int>(random() % touchable),
            typename LoadSum<Scalar>::Vector3(Scalar(random() % 7), -2, Scalar(random() % 5)));
}

template <class Scalar>
std::vector<Scalar> field(const Compliance<Scalar>& compliance) {
  LoadSum<Scalar> sum(compliance, 40);
  std::vector<Scalar> u(3 * compliance.row_nodes());
  load(sum, compliance.column_nodes());
  sum.everywhere(u);
  return u;
}

TEST(Compressed, SuperposesAsTheDenseOne) {
  const auto dense = of<double>(both().dense), compressed = of<double>(both().compressed);
  const std::vector<double> u = field(dense), v = field(compressed);
  const double size = *std::ranges::max_element(u, {}, [](double x) { return std::abs(x); });
  for (std::size_t i = 0; i < u.size(); ++i) ASSERT_NEAR(u[i], v[i], 1e-3 * std::abs(size));
  const std::vector<float> w = field(of<float>(both().compressed));
  for (std::size_t i = 0; i < u.size(); ++i) ASSERT_NEAR(v[i], w[i], 1e-5 * std::abs(size));

  LoadSum<double> sum(compressed, 40);
  load(sum, compressed.column_nodes());
  const std::vector<int> nodes{5, 120, 5, 33, 0};
  std::vector<double> some(3 * nodes.size());
  sum.at(nodes, some);
  for (std::size_t i = 0; i < some.size(); ++i) ASSERT_NEAR(some[i], v[3 * nodes[i / 3] + i % 3], 1e-12 * size);
}

TEST(Compressed, HeldNodesMoveTheSurfaceAsTheDenseOne) {
  const auto holds = testing::spread_holds(both().dense, 8);
  const auto a = solve_tensors(both().dense, holds), b = solve_tensors(both().compressed, holds);
  for (std::size_t n = 0; n < a.displacement.size(); ++n)
    EXPECT_LT((a.displacement[n] - b.displacement[n]).norm(), 1e-3 * 1e-2);
}

TEST(Compressed, IsWrittenAndReadBack) {
  const testing::TemporaryFolder folder;
  write_archive(both().compressed, folder / "a.h5");
  const Archive all = read_archive(folder / "a.h5", ArchivePart::surface, {});
  EXPECT_LT(std::filesystem::file_size(folder / "a.h5"), both().compressed.compressed->bytes() + 200000);
  const Archive some = read_archive(folder / "a.h5", ArchivePart::touchable, {});
  EXPECT_FALSE(read_archive(folder / "a.h5", ArchivePart::header, {}).compressed);
  ASSERT_TRUE(all.compressed && some.compressed);
  EXPECT_TRUE(all.compressed->has_others());
  EXPECT_FALSE(some.compressed->has_others());
  EXPECT_THROW(of<double>(some), std::runtime_error);
  EXPECT_THROW(solve_tensors(some, {}), std::runtime_error);
  const auto before = of<double>(both().compressed), whole = of<double>(all);
  const Compliance<double> part(some, Compliance<double>::Rows::touchable);
  for (int i = 0; i < whole.row_nodes(); ++i)
    for (int j = 0; j < whole.column_nodes(); ++j) {
      ASSERT_EQ(whole.block(i, j), before.block(i, j));
      if (i < part.row_nodes()) {
        ASSERT_EQ(part.block(i, j), whole.block(i, j));
      }
    }
}

TEST(Compressed, ScalesWithYoungsModulusAsAFreshOne) {
  auto stiff = partly_touchable();
  stiff.material.young *= 3;
  Archive scaled = both().compressed;
  scale_young(scaled, stiff.material.young);
  const Archive fresh = compute(stiff, TensorForm::compressed);
  const auto a = of<double>(scaled), b = of<double>(fresh);
  double worst = 0;
  for (int i = 0; i < a.row_nodes(); ++i)
    for (int j = 0; j < a.column_nodes(); ++j)
      worst = std::max(worst, (a.block(i, j) - b.block(i, j)).cwiseAbs().maxCoeff());
  EXPECT_LT(worst, 1e-6 * both().own / 3);
  const testing::TemporaryFolder folder;
  write_archive(scaled, folder / "a.h5");
  const Archive read = read_archive(folder / "a.h5", ArchivePart::surface, {});
  EXPECT_EQ(of<double>(read).block(3, 4), a.block(3, 4));
}

TEST(Compressed, QuadraticElementsAreCompressedLikewise) {
  auto body = testing::make_body();
  body.offline = Offline{.element = FiniteElement::p2};
  const TetMesh mesh = testing::make_organ({6, 5, 3});
  const auto make = [&](TensorForm form) { return precompute(body, mesh, nullptr, {}, Route::fastest, nullptr, form); };
  const Archive a = make(TensorForm::dense), b = make(TensorForm::compressed);
  const auto dense = of<double>(a), compressed = of<double>(b);
  const double own = mean_own(a);
  for (int i = 0; i < dense.row_nodes(); ++i)
    for (int j = 0; j < dense.column_nodes(); ++j)
      ASSERT_LT((dense.block(i, j) - compressed.block(i, j)).cwiseAbs().maxCoeff(), 1e-3 * own);
}

TEST(Compressed, SmallBodiesStayDense) {
  EXPECT_FALSE(precompute(testing::make_body(), testing::make_organ({4, 4, 3})).compressed);
  EXPECT_EQ(form_of(kMaxDense), TensorForm::dense);
  EXPECT_EQ(form_of(kMaxDense + 1), TensorForm::compressed);
}

class DamagedCompressed : public ::testing::Test {
 protected:
  /// The sentence with which the tensors are refused after a change.
  std::string after(const std::function<void(CompressedTensors&)>& change) const {
    CompressedTensors tensors = both().compressed.compressed->tensors();
    change(tensors);
    try {
      CompressedCompliance(std::move(tensors), both().compressed.surface.size());
    } catch (const std::invalid_argument& error) {
      return error.what();
    }
    return "";
  }
  /// Numbers before those of block k.
  static std::size_t numbers_before(const CompressedTensors& t, std::size_t k) {
    std::size_t numbers = 0;
    for (std::size_t i = 0; i < k; ++i) numbers += t.blocks[i].numbers();
    return numbers;
  }
  static std::size_t first_of_low_rank(const CompressedTensors& t) {
    return std::ranges::find_if(t.blocks, [&](const auto& b) { return b.rank > 0 && b.row_end <= t.touchable; }) -
           t.blocks.begin();
  }
};

TEST_F(DamagedCompressed, IsRefusedInWords) {
  EXPECT_EQ(after([](auto&) {}), "");
  EXPECT_EQ(after([](auto& t) { t.order[3] = t.order[4]; }), "its order of nodes does not fit");
  EXPECT_EQ(after([](auto& t) { t.order[3] = -1; }), "its order of nodes does not fit");
  EXPECT_EQ(after([](auto& t) { t.touchable = 1 << 30; }), "its order of nodes does not fit");
  EXPECT_EQ(after([](auto& t) { t.blocks[2].row_end = 1 << 30; }), "a block of its compliance is outside of it");
  EXPECT_EQ(after([](auto& t) { t.blocks[2].rank = 1 << 30; }), "a block of its compliance is outside of it");
  EXPECT_EQ(after([](auto& t) { t.values.pop_back(); }), "its blocks do not have as many numbers as there are");
  EXPECT_EQ(after([](auto& t) {
              t.values.resize(t.values.size() - t.blocks.back().numbers());
              t.blocks.pop_back();
            }),
            "a block of its compliance is missing");
  EXPECT_EQ(after([](auto& t) {
              t.blocks.push_back(t.blocks[1]);
              t.values.insert(t.values.end(), t.blocks[1].numbers(), 0.0f);
            }),
            "two blocks of its compliance overlap");
  EXPECT_EQ(after([](auto& t) {
              std::swap(t.blocks[1].row, t.blocks[1].column), std::swap(t.blocks[1].row_end, t.blocks[1].column_end);
            }),
            "a block of its compliance is above the diagonal");
  EXPECT_EQ(after([](auto& t) { t.values[0] = -1; }), "a node moves against its own force");
}

TEST_F(DamagedCompressed, NumbersThatNoComplianceHasAreRefused) {
  EXPECT_EQ(after([](auto& t) { t.values[9 + 1] = 10 * t.values[0]; }),
            "a node moves more under another's force than can be");
  EXPECT_EQ(after([](auto& t) {
              const std::size_t k = first_of_low_rank(t);
              t.values[numbers_before(t, k)] = 1e3f * t.values[0];
            }),
            "a node moves more under others' forces than can be");
  EXPECT_EQ(after([](auto& t) {
              const std::size_t k = first_of_low_rank(t);
              t.values[numbers_before(t, k + 1) - 1] = 2;
            }),
            "a factor of its compliance is not a unit");
}

TEST_F(DamagedCompressed, FilesAreRefusedByTheirName) {
  const testing::TemporaryFolder folder;
  write_archive(both().compressed, folder / "a.h5");
  const auto bytes = testing::read_bytes(folder / "a.h5");
  auto flipped = bytes;
  const auto& values = both().compressed.compressed->tensors().values;
  const auto* first = reinterpret_cast<const char*>(values.data());
  const auto place = std::search(flipped.begin(), flipped.end(), first, first + 64);
  ASSERT_NE(place, flipped.end());
  place[5] ^= 4;
  testing::write_bytes(folder / "b.h5", flipped, flipped.size());
  EXPECT_EQ(testing::refusal(folder / "b.h5"),
            (folder / "b.h5").string() + ": damaged: 'compressed/touchable' fails its checksum");
  testing::write_bytes(folder / "b.h5", bytes, bytes.size() / 2);
  EXPECT_NE(testing::refusal(folder / "b.h5"), "");

  Archive missing = both().compressed;
  missing.surface.fixed[0] = {true, true, true};
  missing.touchable_dofs.erase(missing.touchable_dofs.begin(), missing.touchable_dofs.begin() + 3);
  write_archive(missing, folder / "c.h5");
  EXPECT_EQ(testing::refusal(folder / "c.h5"),
            (folder / "c.h5").string() + ": damaged: its datasets do not fit together");
}

}  // namespace
}  // namespace palpate
