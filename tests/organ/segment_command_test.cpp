#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "common/mesh/measures.hpp"
#include "common/mesh/mesh_file.hpp"
#include "render_node/image.hpp"
#include "tests/organ/grey_phantom.hpp"
#include "tests/organ/surfaces_for_tests.hpp"
#include "tests/tools/program_result.hpp"
#include "tools/organ/label_volume.hpp"

namespace palpate {
namespace {

using namespace palpate::testing;

struct Agreement {
  double dice = 0, border_voxels = 0;  ///< the second: mean distance of the border's faces from the true surface
};

class SegmentCommand : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = std::make_unique<OwnFolder>("segment");
    write_file(*folder_ / "thin.inr", thin_.inr());
    write_file(*folder_ / "thick.inr", thick_.inr());
    write_file(*folder_ / "shaded.inr", shaded_.inr());
  }
  static void TearDownTestSuite() { folder_.reset(); }

  static ProgramResult segment(const std::string& arguments) {
    return run_program("cd " + folder_->path().string() + " && " + program("palpate") + " segment " + arguments);
  }
  static LabelVolume labels(const std::string& arguments, const std::string& output) {
    const ProgramResult result = segment(arguments + " -o " + output);
    EXPECT_EQ(result.status, 0) << result.err;
    said_ = result.out;
    return read_label_volume(*folder_ / output);
  }
  static Agreement agreement(const GreyPhantom& phantom, const LabelVolume& found) {
    const std::vector<char> truth = phantom.truth();
    double both = 0, either = 0, off = 0, faces = 0;
    std::size_t n = 0;
    const std::size_t stride[]{1, static_cast<std::size_t>(phantom.x), static_cast<std::size_t>(phantom.x) * phantom.y};
    phantom.each([&](const Eigen::Vector3d& v) {
      both += truth[n] && found.value[n], either += truth[n] + found.value[n];
      for (int a = 0; a < 3; ++a) {
        if (v[a] < 1 || found.value[n] == found.value[n - stride[a]]) continue;
        off += std::abs(phantom.organ(phantom.place_mm(v - 0.5 * Eigen::Vector3d::Unit(a))));
        ++faces;
      }
      ++n;
    });
    return {2 * both / either, off / faces / phantom.voxel_mm.mean()};
  }
  /// Points on the true border in the slice, as somebody would click them.
  static std::string clicked(const GreyPhantom& phantom, int slice) {
    std::string lines;
    const Eigen::Vector3d middle = phantom.middle_mm().cwiseQuotient(phantom.voxel_mm);
    for (int p = 0; p < 24; ++p) {
      const double angle = 2 * std::numbers::pi * p / 24;
      Eigen::Vector3d x(middle.x(), middle.y(), slice);
      while (phantom.organ(phantom.place_mm(x)) < 0) x += 0.1 * Eigen::Vector3d(std::cos(angle), std::sin(angle), 0);
      lines += fmt::format("{} {:.1f} {:.1f}\n", slice, x.x(), x.y());
    }
    return lines;
  }

  /// Of 120 in 60, grey values means over 4^3 parts of each voxel, with noise of this deviation.
  static void write_ball(const std::filesystem::path& file, double radius, double noise = 0) {
    BellNoise bell;
    write_phantom(file, {33, 33, 33}, 1, [&](int i, int j, int k) {
      int inside = 0;
      for (int s = 0; s < 64; ++s) {
        const Eigen::Vector3d part = 0.25 * Eigen::Vector3d(s % 4, s / 4 % 4, s / 16).array() - 0.375;
        inside += (Eigen::Vector3d(i, j, k) + part - Eigen::Vector3d(16.2, 15.7, 16)).norm() < radius;
      }
      return std::lround(60 + 60.0 * inside / 64 + noise * bell());
    });
  }

  inline static const GreyPhantom thin_{}, thick_{.neck_mm = 7}, shaded_{.shading = 0.2};
  inline static std::unique_ptr<OwnFolder> folder_;
  inline static std::string said_;
  inline static const std::string kSeed = " --seed-voxel 38,44,28";
};

TEST_F(SegmentCommand, ThroughAThinNeckTheRegionLeaksAndIsCutOffThere) {
  const Agreement leaked = agreement(thin_, labels("thin.inr --reach 0" + kSeed, "leaked.inr"));
  EXPECT_LT(leaked.dice, 0.97);
  EXPECT_GT(leaked.border_voxels, 0.5);
  const Agreement found = agreement(thin_, labels("thin.inr --neck 8" + kSeed, "found.inr"));
  EXPECT_GE(found.dice, 0.985) << said_;
  EXPECT_LE(found.border_voxels, 0.25) << said_;
  labels("thin.inr --neck 8" + kSeed, "again.inr");
  EXPECT_EQ(text_of(*folder_ / "found.inr"), text_of(*folder_ / "again.inr"));
}

TEST_F(SegmentCommand, WhereTheImageIsShadedContoursFindTheEdgesThatOneRangeMisses) {
  const Agreement region =
      agreement(shaded_, labels("shaded.inr --range 90:170 --reach 0 --neck 8" + kSeed, "region.inr"));
  const Agreement found = agreement(shaded_, labels("shaded.inr --range 90:170 --neck 8" + kSeed, "found.inr"));
  EXPECT_GE(found.dice, 0.97) << said_;
  EXPECT_LE(found.border_voxels, 0.5) << said_;
  LabelVolume truth = read_label_volume(*folder_ / "found.inr");
  std::ranges::copy(shaded_.truth(), truth.value.begin());
  const double least = agreement(shaded_, truth).border_voxels;  // whole voxels have no smooth border
  EXPECT_LT(found.border_voxels - least, 0.7 * (region.border_voxels - least))
      << found.border_voxels << " " << region.border_voxels << " " << least;
}

TEST_F(SegmentCommand, ThroughAThickNeckPointsSetByHandMendIt) {
  const Agreement leaked = agreement(thick_, labels("thick.inr --neck 8" + kSeed, "leaked.inr"));
  EXPECT_LT(leaked.dice, 0.97);
  EXPECT_GT(leaked.border_voxels, 0.5);
  write_file(*folder_ / "points.txt",
             "# slice x y\n" + clicked(thick_, 20) + "\n" + clicked(thick_, 28) + clicked(thick_, 36));
  const Agreement found = agreement(thick_, labels("thick.inr --neck 8 --points points.txt" + kSeed, "found.inr"));
  EXPECT_GE(found.dice, 0.97) << said_;
  EXPECT_LE(found.border_voxels, 0.5) << said_;
}

TEST_F(SegmentCommand, ASpoiltSliceIsBridgedBetweenPointsOnBothSides) {
  std::string bytes = text_of(*folder_ / "thin.inr");
  const std::size_t layer = 2 * static_cast<std::size_t>(thin_.x) * thin_.y;
  std::fill_n(bytes.begin() + 256 + static_cast<std::ptrdiff_t>(20 * layer), layer, '\0');
  write_file(*folder_ / "spoilt.inr", bytes);
  EXPECT_LT(agreement(thin_, labels("spoilt.inr --neck 8" + kSeed, "half.inr")).dice, 0.9);
  write_file(*folder_ / "both.txt", clicked(thin_, 18) + clicked(thin_, 22));
  const Agreement found =
      agreement(thin_, labels("spoilt.inr --neck 8 --points both.txt --seed-voxel 38,44,14" + kSeed, "bridged.inr"));
  EXPECT_GE(found.dice, 0.97) << said_;
  EXPECT_LE(found.border_voxels, 0.5) << said_;
}

TEST_F(SegmentCommand, LabelsAreWrittenWhereTheImageLiesAndOrganReadsThem) {
  std::string bytes = text_of(*folder_ / "thin.inr").substr(256);
  write_file(*folder_ / "turned.mha",
             "ObjectType = Image\nNDims = 3\nBinaryData = True\nBinaryDataByteOrderMSB = False\n"
             "TransformMatrix = 0 1 0 -1 0 0 0 0 1\nOffset = 10 20 30\nElementSpacing = 0.9 0.9 1.2\n"
             "DimSize = 96 88 56\nElementType = MET_SHORT\nElementDataFile = LOCAL\n" +
                 bytes);
  const std::string error = segment("turned.mha -o none.mha" + kSeed).err;
  if (error.find("without ITK") != std::string::npos) GTEST_SKIP() << error;
  const LabelVolume plain = labels("thin.inr --neck 8" + kSeed, "plain.mha");
  // The seed's voxel 38,44,28 lies at (10 - 0.9 x 44, 20 + 0.9 x 38, 30 + 1.2 x 28) mm.
  for (const char* name : {"turned-labels.mha", "turned-labels.nrrd"}) {
    const LabelVolume turned = labels("turned.mha --neck 8 --seed=-29.6,54.2,63.6", name);
    EXPECT_EQ(turned.value, plain.value) << name;
    EXPECT_TRUE(turned.shape.spacing.isApprox(Eigen::Vector3d(9e-4, 9e-4, 1.2e-3), 1e-9)) << name;
    const Eigen::Vector3d seed = turned.in_world(turned.shape.place(38, 44, 28));
    EXPECT_TRUE(seed.isApprox(Eigen::Vector3d(-0.0296, 0.0542, 0.0636), 1e-9)) << name << " " << seed.transpose();
  }
  EXPECT_NE(segment("turned.mha --neck 8 --seed=-29.6,54.2,63.6 -o t.inr").err.find("no place for the origin"),
            std::string::npos);
  const auto made = run_program(fmt::format("cd {} && {} organ plain.mha --label 1=liver --edge 0.009 -o liver.msh",
                                            folder_->path().string(), program("palpate")));
  ASSERT_EQ(made.status, 0) << made.err;
  const double volume = 9e-4 * 9e-4 * 1.2e-3 * static_cast<double>(std::ranges::count(plain.value, 1));
  EXPECT_NEAR(measures_of(load_tet_mesh(*folder_ / "liver.msh", 1)).volume, volume, 0.01 * volume);
}

TEST_F(SegmentCommand, AContourByHandThatIsLostIsWarnedOfAndNotCounted) {
  write_file(*folder_ / "corner.txt", "2 2 2\n2 9 2\n2 9 9\n2 2 9\n" + clicked(thin_, 28));
  const LabelVolume found = labels("thin.inr --neck 8 --points corner.txt --json" + kSeed, "corner.inr");
  const auto json = nlohmann::json::parse(said_);
  EXPECT_EQ(json["slices_by_hand"], 1);
  EXPECT_EQ(json["slices_by_hand_lost"], std::vector{2});
  ASSERT_EQ(json["warnings"].size(), 1u);
  EXPECT_NE(json["warnings"][0].get<std::string>().find("drawn by hand in slice 2:"), std::string::npos) << said_;
  const auto first = std::ranges::find(found.value, 1) - found.value.begin();
  EXPECT_EQ(json["first_slice"], found.shape.voxel_of(first)[2]);
}

TEST_F(SegmentCommand, ABallOfAFewVoxelsIsNotShrunk) {
  for (const auto& [radius, off] : {std::pair{9.0, 0.03}, {5.0, 0.1}}) {
    write_ball(*folder_ / "ball.inr", radius);
    const LabelVolume found = labels("ball.inr --range 90:255 --seed-voxel 16,16,16", "small.inr");
    const double ball = 4.0 / 3 * std::numbers::pi * std::pow(radius, 3);
    EXPECT_NEAR(static_cast<double>(std::ranges::count(found.value, 1)), ball, off * ball) << said_;
  }
}

TEST_F(SegmentCommand, TheRangeIsMidwayToTheSurroundingsHoweverMuchIsSmoothed) {
  for (const double noise : {0.0, 4.0})
    for (const double smoothing : {0.0, 1.0, 2.0, 3.0}) {
      write_ball(*folder_ / "ball.inr", 11, noise);
      const LabelVolume found =
          labels(fmt::format("ball.inr --smoothing {} --json --seed-voxel 16,16,16", smoothing), "s.inr");
      const auto json = nlohmann::json::parse(said_);
      EXPECT_NEAR(json["range"][0], 90, 4) << noise << " " << smoothing;
      EXPECT_GT(json["range"][1], 130) << noise << " " << smoothing;
      EXPECT_EQ(json["seeds"], (std::vector<std::vector<int>>{{16, 16, 16}}));
      const double ball = 4.0 / 3 * std::numbers::pi * std::pow(11.0, 3), off = smoothing > 2 ? 0.15 : 0.04;
      EXPECT_NEAR(json["label_voxels"], ball, off * ball) << noise << " " << smoothing;
    }
}

TEST_F(SegmentCommand, WhereTheSeedIsInNoPartOfItsOwnARangeIsAskedFor) {
  write_phantom(*folder_ / "wall.inr", {33, 33, 33}, 1, [](int i, int, int) { return i > 14 && i < 18 ? 120 : 60; });
  const ProgramResult refused = segment("wall.inr --seed-voxel 16,16,16 -o wall.mha");
  EXPECT_EQ(refused.status, 1);
  EXPECT_NE(refused.err.find("around the seeds fill the image"), std::string::npos) << refused.err;
  const LabelVolume found = labels("wall.inr --range 90:255 --seed-voxel 16,16,16", "wall.inr2.inr");
  EXPECT_NEAR(static_cast<double>(std::ranges::count(found.value, 1)), 3 * 33 * 33, 0.1 * 3 * 33 * 33);
}

TEST_F(SegmentCommand, NothingBrighterAroundTheOrganCutsNoHolesIntoIt) {
  write_ball(*folder_ / "ball.inr", 9, 12);
  const LabelVolume found = labels("ball.inr --reach 0 --neck 8 --seed-voxel 16,16,16", "small.inr");
  const double ball = 4.0 / 3 * std::numbers::pi * std::pow(9.0, 3);
  EXPECT_NEAR(static_cast<double>(std::ranges::count(found.value, 1)), ball, 0.1 * ball) << said_;
}

TEST_F(SegmentCommand, WhereNoEdgeIsAContourStaysWhereTheRegionEnds) {
  write_phantom(*folder_ / "slope.inr", {33, 33, 33}, 1, [&](int i, int j, int k) {
    return std::lround(200 - 4 * (Eigen::Vector3d(i, j, k) - Eigen::Vector3d(16.2, 15.7, 16)).norm());
  });
  const std::string arguments = "slope.inr --range 164:255 --seed-voxel 16,16,16";
  const LabelVolume region = labels(arguments + " --reach 0", "region.inr"), found = labels(arguments, "found.inr");
  EXPECT_NE(said_.find(" 0 % of their points on an edge"), std::string::npos) << said_;
  EXPECT_GT(std::ranges::count(found.value, 1), 0.9 * static_cast<double>(std::ranges::count(region.value, 1)));
}

TEST_F(SegmentCommand, ACavityIsFilledHoweverLarge) {
  constexpr double kBall = 18, kCavity = 7;  // [voxels] 6 % of the ball
  write_phantom(*folder_ / "hollow.inr", {48, 48, 48}, 1, [](int i, int j, int k) {
    const double r = (Eigen::Vector3d(i, j, k) - Eigen::Vector3d::Constant(23.5)).norm();
    return r < kBall && r > kCavity ? 120 : 60;
  });
  const LabelVolume found = labels("hollow.inr --range 90:255 --seed-voxel 24,24,11", "filled.inr");
  const double ball = 4.0 / 3 * std::numbers::pi * std::pow(kBall, 3);
  EXPECT_NEAR(static_cast<double>(std::ranges::count(found.value, 1)), ball, 0.02 * ball);
}

TEST_F(SegmentCommand, APictureOfEachSliceIsDrawn) {
  labels("thin.inr --neck 8 --preview pictures" + kSeed, "found.inr");
  for (const char* name : {"slice_0000.png", "slice_0028.png", "slice_0055.png"}) {
    const Image picture = read_png(*folder_ / "pictures" / name);
    int contour = 0;
    for (int y = 0; y < picture.height; ++y)
      for (int x = 0; x < picture.width; ++x) {
        const std::uint8_t* p = picture.pixel(x, y);
        contour += p[1] == 255 && p[0] < 100 && p[2] < 100;
      }
    EXPECT_EQ(picture.width, 2 * thin_.x * picture.height / thin_.y) << name;
    EXPECT_EQ(contour > 1000, std::string(name) == "slice_0028.png") << name << " " << contour;
  }
}

TEST_F(SegmentCommand, APreviewTakesAwayItsOlderPicturesAndNoFileOfAnotherKind) {
  write_ball(*folder_ / "ball.inr", 9);
  const std::string arguments = "ball.inr --seed-voxel 16,16,16 --preview again -o ball.mha";
  labels("thin.inr --neck 8 --preview again" + kSeed, "found.inr");
  ASSERT_TRUE(std::filesystem::exists(*folder_ / "again/slice_0055.png"));
  write_file(*folder_ / "again/notes.txt", "mine");
  EXPECT_EQ(segment(arguments).status, 0);
  EXPECT_TRUE(std::filesystem::exists(*folder_ / "again/slice_0032.png"));
  EXPECT_FALSE(std::filesystem::exists(*folder_ / "again/slice_0055.png"));
  EXPECT_EQ(text_of(*folder_ / "again/notes.txt"), "mine");
  write_file(*folder_ / "again/slice_0007.png", "mine");
  const ProgramResult refused = segment(arguments);
  EXPECT_EQ(refused.status, 1);
  EXPECT_NE(refused.err.find("again/slice_0007.png: not made by this command, so it stays; name another folder"),
            std::string::npos)
      << refused.err;
  EXPECT_EQ(text_of(*folder_ / "again/slice_0007.png"), "mine");
}

TEST_F(SegmentCommand, FiguresArePrintedAsOneLineOfJson) {
  const LabelVolume found = labels("thin.inr --neck 8 --json" + kSeed, "json.inr");
  EXPECT_EQ(std::ranges::count(said_, '\n'), 1) << said_;
  const auto json = nlohmann::json::parse(said_);
  const auto voxels = std::ranges::count(found.value, 1);
  EXPECT_EQ(json["voxels"], found.shape.count);
  EXPECT_EQ(json["label_voxels"], voxels);
  EXPECT_NEAR(json["volume_m3"], static_cast<double>(voxels) * found.shape.spacing.prod(), 1e-12);
  EXPECT_LT(json["range"][0], json["range"][1]);
  EXPECT_GT(json["points_on_edge"], 0.6);
}

TEST_F(SegmentCommand, MistakesAndDamageAreToldInASentence) {
  const auto refused = [&](const std::string& arguments, const std::string& said) {
    const ProgramResult result = segment(arguments + " -o refused.inr");
    EXPECT_EQ(result.status, 1) << arguments;
    EXPECT_NE(result.err.find(said), std::string::npos) << arguments << "\n" << result.err;
    EXPECT_FALSE(std::filesystem::exists(*folder_ / "refused.inr")) << arguments;
  };
  const ProgramResult nowhere = segment("none.inr -o nowhere/a.inr" + kSeed);  // before the image is read
  EXPECT_NE(nowhere.err.find("nowhere/a.inr: it cannot be written, since the folder "), std::string::npos)
      << nowhere.err;
  refused("thin.inr", "a --seed or --seed-voxel in the organ is asked for");
  refused("thin.inr --seed 1,2", "--seed 1,2: three numbers x,y,z are asked for");
  refused("thin.inr --seed 1,2,300",
          "--seed 1,2,300 lies at voxel 1.111,2.222,250, outside of the image's 96 x 88 x 56");
  refused("thin.inr --range 90" + kSeed, "--range 90: LOW:HIGH is asked for");
  refused("thin.inr --range 200:300" + kSeed, "the seed at voxel 38,44,28 has the smoothed grey value 1");
  refused("thin.inr --neck 90" + kSeed,
          "in a part thinner than --neck 90 mm: take one deeper inside, or a wider --range");
  const auto points = [&](const std::string& text, const std::string& said) {
    write_file(*folder_ / "bad.txt", text);
    refused("thin.inr --points bad.txt" + kSeed, said);
  };
  points("20 1 2\n\n20 3\n", "bad.txt:3: 2 words: SLICE X Y is asked for");
  points("20 1 2\n56 3 4\n", "bad.txt:2: '56' is no slice from 0 to 55");
  points("20 1 nan\n", "bad.txt:1: Y 'nan' is no number from 0 to 87, in voxels");
  points("20 1 2\n20 1 2\n", "bad.txt:2: the same point twice");
  points("20 1 2\n20 3 4\n21 5 6\n", "bad.txt:2: slice 20 has 2 points: a contour has three at least");
  points("28 1 1\n28 9 1\n28 1 9\n28 9 9\n",
         "bad.txt:4: the contour in slice 28 crosses itself: the line from its point 2 to 3 meets that from 4 to 1");
  points("28 1 2\n28 9 2\n28 9 9\n", "a seed lies outside of what is drawn by hand in slice 28");
  points("# none\n", "bad.txt: no point stands in it");
  const std::string good = text_of(*folder_ / "thin.inr");
  write_file(*folder_ / "cut.inr", good.substr(0, good.size() / 2));
  refused("cut.inr" + kSeed, "cut.inr: it ends before its last voxel");
  std::string nan =
      replaced(replaced(good.substr(0, 256), "signed fixed", "float\n\n\n\n\n\n\n"), "16 bits", "32 bits");
  write_file(*folder_ / "nan.inr", nan + std::string(4 * thin_.size(), '\xff'));
  refused("nan.inr" + kSeed, "nan.inr: its value at voxel 0,0,0 is nan");
}

}  // namespace
}  // namespace palpate
