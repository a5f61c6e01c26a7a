// Archives whose checksums are right and whose contents are not: they are refused in words, or what is run with them
// gives forces that a hand can stand.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <fstream>

#include "common/archive/static_solve.hpp"
#include "tests/fuzz/hdf5_contents.hpp"
#include "tests/fuzz/rounds.hpp"
#include "tests/sim/played_scenes.hpp"
#include "tests/tensors/compressed_copy.hpp"
#include "tests/tensors/files_for_tests.hpp"

namespace palpate {
namespace {

using testing::any_of;
using testing::Hdf5Contents;
using testing::PlayedScene;

/// Changes one thing in the contents, or some; says what.
class Spoiler {
 public:
  explicit Spoiler(unsigned seed) : random_(seed) {}

  std::string spoil(Hdf5Contents& contents) {
    const auto attributes = contents.attributes.size(), datasets = contents.datasets.size();
    const std::size_t chosen = random_() % (attributes + 4 * datasets);
    if (chosen < attributes) return spoil_attribute(*std::next(contents.attributes.begin(), chosen));
    return spoil_dataset(*std::next(contents.datasets.begin(), (chosen - attributes) / 4));
  }

 private:
  template <class Named>
  std::string spoil_attribute(Named& named) {
    auto& value = named.second;
    if (auto* number = std::get_if<double>(&value)) *number = any_of(testing::kExtremeNumbers, random_);
    if (auto* whole = std::get_if<std::int64_t>(&value)) *whole = whole_number(*whole);
    if (auto* text = std::get_if<std::string>(&value))
      if (named.first != "content_hash") *text = std::string(random_() % 300, 'x');
    return named.first;
  }
  std::int64_t whole_number(std::int64_t was) {
    if (random_() % 8 == 0) return std::numeric_limits<std::int64_t>::min() + static_cast<std::int64_t>(random_() % 2);
    if (random_() % 2) return was + static_cast<std::int64_t>(random_() % 5) - 2;
    return any_of(testing::kExtremeIntegers, random_);
  }

  template <class Named>
  std::string spoil_dataset(Named& named) {
    return named.first +
           std::visit([&](auto& values) { return spoil_values(values, named.second.columns); }, named.second.values);
  }
  template <class T>
  std::string spoil_values(std::vector<T>& values, std::size_t columns) {
    if (values.empty()) return ", of which nothing is left";
    const std::size_t at = any_place(values.size());
    switch (random_() % 8) {
      case 0:
        return resize(values, columns);
      case 1:
        std::ranges::copy(std::vector<T>(values.begin(), values.begin() + columns),
                          values.begin() + at / columns * columns);
        return fmt::format(", row {} as the first", at / columns);
      case 2:
        for (T& value : values) value = extreme(value);
        return ", all";
      case 3:
        std::swap(values[at], values[any_place(values.size())]);
        return fmt::format(", {} exchanged", at);
      default:
        values[at] = extreme(values[at]);
        return fmt::format(" at {}: {}", at, values[at]);
    }
  }
  template <class T>
  std::string resize(std::vector<T>& values, std::size_t columns) {
    const std::size_t rows = values.size() / columns;
    const std::size_t now = any_of(std::array<std::size_t, 5>{0, 1, rows / 2, rows - 1, rows + 1}, random_);
    values.resize(now * columns, values[0]);
    return fmt::format(": {} rows for {}", now, rows);
  }
  std::size_t any_place(std::size_t size) {
    const std::size_t place = random_() % 4;
    return place == 0 ? 0 : place == 1 ? size - 1 : random_() % size;
  }
  double extreme(double was) {
    switch (random_() % 4) {
      case 0:
        return -was;
      case 1:
        return was * std::pow(10., static_cast<int>(random_() % 13) - 6);
      default:
        return any_of(testing::kExtremeNumbers, random_);
    }
  }
  float extreme(float was) { return static_cast<float>(extreme(double{was})); }
  std::int32_t extreme(std::int32_t was) { return static_cast<std::int32_t>(whole_number(was)); }

  std::mt19937 random_;
};

/// Runs the scene over the whole of its motion, ten times as fast. False if it is refused.
bool run(const PlayedScene& played) {
  constexpr int kSteps = 65, kSpeed = 10;
  try {
    sim::Simulator simulator(played.scene, played.archives);
    simulator.start(played.inputs(0));
    for (int i = 1; i <= kSteps; ++i) {
      simulator.step(played.inputs(kSpeed * i));
      for (int t = 0; t < simulator.tools(); ++t) {
        EXPECT_TRUE(simulator.tool(t).force.allFinite());
        EXPECT_LE(simulator.tool(t).force.norm(), played.scene.tools[t].max_force * (1 + 1e-9));
      }
    }
    for (int b = 0; b < simulator.bodies(); ++b) simulator.surface(b);
    return true;
  } catch (const std::runtime_error&) {
    return false;
  }
}

void solve(const Archive& archive) {
  if (archive.touchable_dofs.empty()) return;
  const auto [node, axis] = archive.touchable_dofs[archive.touchable_dofs.size() / 2];
  try {
    solve_tensors(archive, {{{{archive.surface.node_number[node], axis, 1.0}}, 1e-3}});
  } catch (const std::runtime_error&) {
  }
}

class ArchiveFuzz : public ::testing::Test {
 protected:
  void spoil(PlayedScene played, int rounds, unsigned seed) {
    const testing::TemporaryFolder folder;
    played.archives[0].content_hash = kHash;
    write_archive(played.archives[0], folder / "good.h5");
    EXPECT_TRUE(run(played)) << played.name;
    const Hdf5Contents good(folder / "good.h5");
    Spoiler spoiler(seed);
    int refused = 0, not_run = 0, run_on = 0;
    testing::fuzz(rounds, 6, [&](int round) {
      Hdf5Contents contents = good;
      std::string what = spoiler.spoil(contents);
      for (int more = round % 3; more > 1; --more) what += "; " + spoiler.spoil(contents);
      SCOPED_TRACE(fmt::format("{} round {}: {}", played.name, round, what));
      contents.write(folder / "bad.h5");
      std::ofstream(folder / "what.txt") << what;  // they are left where the test does not live to tell
      try {
        played.archives[0] = read_archive(folder / "bad.h5", ArchivePart::surface, kHash);
      } catch (const std::runtime_error& error) {
        EXPECT_TRUE(std::string(error.what()).starts_with((folder / "bad.h5").string() + ": ")) << error.what();
        ++refused;
        return;
      }
      solve(played.archives[0]);
      ++(run(played) ? run_on : not_run);
    });
    EXPECT_GT(refused, 0);
    EXPECT_GT(run_on, 0);
    fmt::print("{}: {} refused, {} not run, {} run\n", played.name, refused, not_run, run_on);
  }

 private:
  static constexpr const char* kHash = "0123456789abcdef0123456789abcdef";
};

TEST_F(ArchiveFuzz, OfTensors) {
  spoil(testing::pressed_block(), 150, 1);
}

TEST_F(ArchiveFuzz, OfCompressedTensors) {
  auto played = testing::pressed_block();
  played.archives[0] = testing::compressed_copy(played.archives[0]);
  spoil(std::move(played), 150, 7);
}

TEST_F(ArchiveFuzz, OfTissueThatRelaxes) {
  spoil(testing::relaxing_block(), 80, 2);
}

TEST_F(ArchiveFuzz, OfTetrahedraWithInertia) {
  spoil(testing::cut_block<TensorMassSpec>(), 80, 3);
}

TEST_F(ArchiveFuzz, OfSprings) {
  spoil(testing::cut_block<SpringMassSpec>(), 80, 4);
}

TEST_F(ArchiveFuzz, OfTwoPartsThatAreConnected) {
  spoil(testing::cut_block<HybridSpec>(), 150, 5);
}

TEST_F(ArchiveFuzz, OfModesWithACatheterInThem) {
  spoil(testing::fed_catheter(), 150, 6);
}

}  // namespace
}  // namespace palpate
