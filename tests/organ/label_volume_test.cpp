#include "tools/organ/label_volume.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/organ/dicom_for_tests.hpp"
#include "tests/organ/images_for_tests.hpp"
#include "tests/organ/phantom_image.hpp"
#include "tests/organ/surfaces_for_tests.hpp"
#include "tests/tools/program_result.hpp"
#include "tools/organ/image_checks.hpp"

namespace palpate {
namespace {

using namespace palpate::testing;

/// Two layers of 3 x 2 voxels, numbered, of 1 x 2 x 3 mm.
class LabelImages : public ::testing::Test {
 protected:
  void SetUp() override {
    for (int i = 0; i < 12; ++i) voxels_ += static_cast<char>(i);
    try {
      read_label_volume(write_file(folder_ / "none.nrrd", ""));
    } catch (const std::runtime_error& error) {
      if (std::string(error.what()).find("without ITK") != std::string::npos) GTEST_SKIP() << error.what();
    }
  }
  std::string mha(const std::string& first_axis) const { return meta_header(first_axis) + voxels_; }
  /// Where the voxel of this label lies in the world [m].
  static Eigen::Vector3d place(const LabelVolume& v, int label) {
    for (int k = 0; k < v.shape.count[2]; ++k)
      for (int j = 0; j < v.shape.count[1]; ++j)
        for (int i = 0; i < v.shape.count[0]; ++i)
          if (v.value[v.shape.index(i, j, k)] == label) return v.in_world(v.shape.place(i, j, k));
    return Eigen::Vector3d::Constant(99);
  }
  std::string voxels_;
  const OwnFolder folder_{"label-images"};
};

TEST_F(LabelImages, MetaImageAndNrrdHaveTheirVoxelsWhereTheirHeadersSay) {
  const LabelVolume meta = read_label_volume(write_file(folder_ / "a.mha", mha("1")));
  EXPECT_TRUE(place(meta, 11).isApprox(Eigen::Vector3d(0.012, 0.022, 0.033))) << place(meta, 11).transpose();
  const LabelVolume nrrd = read_label_volume(write_file(folder_ / "a.nrrd", nrrd_header() + voxels_));
  EXPECT_TRUE(place(nrrd, 11).isApprox(Eigen::Vector3d(0.002, 0.002, 0.003))) << place(nrrd, 11).transpose();
}

TEST_F(LabelImages, AnEndingMayBeInCapitals) {
  const std::string inr = inr_header({3, 2, 2}, {1, 2, 3});
  for (const auto& [name, header] :
       {std::pair{"A.INR", inr}, {"A.MHA", meta_header()}, {"A.Nrrd", nrrd_header()}, {"A.NII", nifti_header()}})
    EXPECT_EQ(read_label_volume(write_file(folder_ / name, header + voxels_)).value.back(), 11) << name;
  EXPECT_THROW(read_label_volume(write_file(folder_ / "CUT.MHA", mha("1").substr(0, mha("1").size() - 5))),
               std::runtime_error);
}

TEST_F(LabelImages, AMirroredImageIsTurnedRightHandedAndStaysInPlace) {
  const LabelVolume mirrored = read_label_volume(write_file(folder_ / "m.mha", mha("-1")));
  EXPECT_GT(mirrored.turn.determinant(), 0);
  EXPECT_TRUE(place(mirrored, 11).isApprox(Eigen::Vector3d(0.008, 0.022, 0.033))) << place(mirrored, 11).transpose();
}

TEST_F(LabelImages, OfAFolderWithSeveralDicomSeriesOneIsChosen) {
  std::filesystem::create_directories(folder_ / "series");
  const auto write = [&](const std::string& series, int number) {
    write_file(folder_ / ("series/" + series + "-" + std::to_string(number)),
               DicomPicture(series, number, 30 + 3 * number, 3, voxels_.substr(6 * number, 6)).bytes());
  };
  write("1.2.3.4", 0), write("1.2.3.4", 1);
  const auto read = [&](const std::string& series) { return read_label_volume(folder_ / "series", series); };
  const LabelVolume alone = read("");
  EXPECT_EQ(alone.shape.count, (std::array{3, 2, 2}));
  EXPECT_TRUE(place(alone, 11).isApprox(Eigen::Vector3d(0.012, 0.022, 0.033))) << place(alone, 11).transpose();
  write("1.2.3.5", 0);
  try {
    read("");
    FAIL() << "one of two series was taken unasked";
  } catch (const std::runtime_error& error) {
    const std::string said = error.what();
    EXPECT_NE(said.find("2 DICOM series lie in this folder, choose by --series: 1.2.3.4"), std::string::npos) << said;
    EXPECT_NE(said.find("of 2 pictures"), std::string::npos) << said;
  }
  EXPECT_THROW(read("9"), std::runtime_error);
}

TEST_F(LabelImages, ASeriesThatIsNotEvenlySpacedIsRefusedWithThePlace) {
  int series = 0;
  const auto folder_of = [&](const std::vector<double>& places) {
    const std::filesystem::path folder = folder_ / ("even-" + std::to_string(++series));
    std::filesystem::create_directories(folder);
    for (int n = 0; n < static_cast<int>(places.size()); ++n)
      write_file(folder / std::to_string(n), DicomPicture("1.2.3.4", n, places[n], 3, voxels_.substr(0, 6)).bytes());
    return folder;
  };
  const auto expect_refused = [&](const std::vector<double>& places, const std::string& words) {
    const std::filesystem::path folder = folder_of(places);
    for (const bool grey : {false, true}) try {
        grey ? void(read_grey_volume(folder)) : void(read_label_volume(folder));
        ADD_FAILURE() << "read without a word where this is due: " << words;
      } catch (const std::runtime_error& error) {
        EXPECT_NE(std::string(error.what()).find(words), std::string::npos) << error.what();
      }
  };
  expect_refused({0, 3, 6, 12, 15},
                 "1 slice is missing between (10, 20, 6) mm and (10, 20, 12) mm, where others lie 3 mm apart: put it");
  expect_refused({0, 3, 12, 15, 18, 24, 27},
                 "2 slices are missing between (10, 20, 3) mm and (10, 20, 12) mm, where others lie 3 mm apart, and 1 "
                 "more elsewhere: put them");
  expect_refused({0, 3, 6, 10, 13}, "not evenly spaced: 4 mm between (10, 20, 6) mm and (10, 20, 10) mm, and 3 mm");
  expect_refused({0, 3, 3, 6}, "two of its 4 slices lie at (10, 20, 3) mm");
  // Places are written with few digits.
  const LabelVolume rounded = read_label_volume(folder_of({0, 2.9, 6, 9.1, 12}));
  EXPECT_NEAR(rounded.shape.spacing.z(), 0.003, 1e-9);
}

TEST_F(LabelImages, ASliceThatIsCutShortOrUnlikeTheOthersIsRefusedByItsName) {
  int series = 0;
  const auto expect_refused = [&](const auto& spoilt, const std::string& words) {
    const std::filesystem::path folder = folder_ / ("unlike-" + std::to_string(++series));
    std::filesystem::create_directories(folder);
    for (int n = 0; n < 5; ++n) {
      const std::string bytes = DicomPicture("1.2.3.4", n, 3 * n, 3, voxels_.substr(0, 6)).bytes();
      write_file(folder / ("slice" + std::to_string(n)), n == 2 ? spoilt(bytes) : bytes);
    }
    try {
      read_label_volume(folder);
      ADD_FAILURE() << "read without a word where this is due: " << words;
    } catch (const std::runtime_error& error) {
      EXPECT_NE(std::string(error.what()).find(words), std::string::npos) << error.what();
    }
  };
  const auto with = [](const std::string& here, const std::string& there) {
    return [=](std::string bytes) { return bytes.replace(bytes.find(here), here.size(), there); };
  };
  const auto cut = [](const std::string& bytes) { return bytes.substr(0, bytes.size() - 1); };
  expect_refused(cut, "its slice slice2 ends before its last pixel");
  expect_refused(with("10\\20\\", "10\\29\\"), "its slice at (10, 29, 6) mm lies 9 mm beside the first one's normal");
  expect_refused(with("10\\20\\", "na\\20\\"), "its slice slice2 does not say where it lies (Image Position)");
  expect_refused(with("2\\1 \x28", "3\\1 \x28"), "its slice slice2 has pixels of 1 x 3 mm, and the first one 1 x 2 mm");
  expect_refused(with("1\\0\\0\\0\\1\\0", "0\\1\\0\\1\\0\\0"), "its slice slice2 lies otherwise than the first one");
}

TEST_F(LabelImages, ASliceThatIsCutWithinItsHeaderIsRefused) {
  const std::filesystem::path folder = folder_ / "cut-header";
  std::filesystem::create_directories(folder);
  const auto bytes_of = [&](int n) { return DicomPicture("1.2.3.4", n, 3 * n, 3, voxels_.substr(0, 6)).bytes(); };
  for (int n = 0; n < 5; ++n) write_file(folder / ("slice" + std::to_string(n)), bytes_of(n));
  const std::string whole = bytes_of(2);
  int named = 0;
  for (std::size_t size = 100; size < whole.size() - 6; size += 9) {
    write_file(folder / "slice2", whole.substr(0, size));
    try {
      read_label_volume(folder);
      ADD_FAILURE() << "read, cut to " << size << " bytes of " << whole.size();
    } catch (const std::runtime_error& error) {
      const std::string said = error.what();
      const bool names = said.find("its slice slice2 cannot be read: its header is cut short") != std::string::npos;
      EXPECT_TRUE(names || said.find("its slice slice2 ends before") != std::string::npos ||
                  said.find("1 slice is missing between (10, 20, 3) mm and (10, 20, 9) mm") != std::string::npos)
          << size << " bytes: " << said;
      named += names;
    }
  }
  EXPECT_GT(named, 3);
}

TEST(SlicePlaces, SlicesOfATiltedScannerLieAslantAndAreRefused) {
  const auto stack = [](double aside) {
    SlicePlaces slices{{}, Eigen::Vector3d::UnitZ(), 0.8};
    for (int k = 0; k < 20; ++k) slices.first_mm.emplace_back(0, aside * k, 2 * k);
    return slices;
  };
  EXPECT_NO_THROW(check_even(stack(0.001)));
  try {
    check_even(stack(0.3));
    FAIL() << "read as upright";
  } catch (const std::runtime_error& error) {
    EXPECT_NE(std::string(error.what()).find("the last one, at (0, 5.7, 38) mm, lies 5.7 mm beside"), std::string::npos)
        << error.what();
  }
}

TEST_F(LabelImages, ValuesThatAreNoWholeNumbersAreNoLabels) {
  const auto image = [&](const std::string& name, float last) {
    std::vector<float> values(12, 2);
    values[11] = last;
    const std::string bytes(reinterpret_cast<const char*>(values.data()), 4 * values.size());
    const bool inr = name.ends_with(".inr");
    const std::string header =
        inr ? inr_header({3, 2, 2}, {1, 2, 3}, "float", 32) : replaced(meta_header(), "MET_UCHAR", "MET_FLOAT");
    return write_file(folder_ / name, header + bytes);
  };
  for (const char* name : {"a.inr", "a.mha"}) {
    EXPECT_EQ(read_label_volume(image(name, 7)).value.back(), 7) << name;
    for (const auto& [value, told] :
         {std::pair{1.5f, "1.5"}, {NAN, "nan"}, {5e9f, "5000000000"}, {-3e9f, "-3000000000"}})
      try {
        read_label_volume(image(name, value));
        ADD_FAILURE() << name << " was read, with a label of " << told;
      } catch (const std::runtime_error& error) {
        const std::string words = fmt::format("{}: its value at voxel 2,1,1 is {}, and labels are whole", name, told);
        EXPECT_NE(std::string(error.what()).find(words), std::string::npos) << error.what();
      }
    EXPECT_EQ(read_grey_volume(image(name, 1.5)).value.back(), 1.5) << name;
  }
}

TEST_F(LabelImages, LabelsGoUpTo32BitsWithOrWithoutASign) {
  const auto read = [&](const std::string& name, std::int64_t first, std::int64_t last, bool has_sign) {
    std::string bytes(48, '\0');
    std::memcpy(bytes.data(), &first, 4), std::memcpy(bytes.data() + 44, &last, 4);
    const bool inr = name.ends_with(".inr");
    const std::string header = inr ? inr_header({3, 2, 2}, {1, 2, 3}, has_sign ? "signed fixed" : "unsigned fixed", 32)
                                   : replaced(nrrd_header(), "uchar", has_sign ? "int" : "uint");
    return read_label_volume(write_file(folder_ / name, header + bytes));
  };
  for (const char* name : {"a.inr", "a.nrrd"}) {
    const LabelVolume high = read(name, 70000, 4000000000, false), low = read(name, kLeastLabel, -5, true);
    EXPECT_EQ(label_at(high, 0), 70000) << name;
    EXPECT_EQ(label_at(high, 11), 4000000000) << name;
    EXPECT_EQ(label_at(low, 0), kLeastLabel) << name;
    EXPECT_EQ(label_at(low, 11), -5) << name;
  }
  std::vector<double> both(12, 0);
  both[1] = -1, both[11] = 4e9;
  const std::string bytes(reinterpret_cast<const char*>(both.data()), 8 * both.size());
  try {
    read_label_volume(write_file(folder_ / "both.nrrd", replaced(nrrd_header(), "uchar", "double") + bytes));
    FAIL() << "-1 and 4e9 were read";
  } catch (const std::runtime_error& error) {
    EXPECT_NE(std::string(error.what()).find("its label at voxel 1,0,0 is below 0 and that at voxel 2,1,1 above"),
              std::string::npos)
        << error.what();
  }
}

TEST_F(LabelImages, AGreyValueThatIsNoNumberIsRefusedWithItsVoxel) {
  std::vector<float> values(12, 2);
  values[7] = NAN;
  const std::string bytes(reinterpret_cast<const char*>(values.data()), 4 * values.size());
  for (const auto& [name, header] : {std::pair{"n.inr", inr_header({3, 2, 2}, {1, 2, 3}, "float", 32)},
                                     {"n.mha", replaced(meta_header("-1"), "MET_UCHAR", "MET_FLOAT")}})
    try {
      read_grey_volume(write_file(folder_ / name, header + bytes));
      ADD_FAILURE() << name << " was read";
    } catch (const std::runtime_error& error) {
      const std::string words = fmt::format("{}: its value at voxel 1,0,1 is nan, which is no finite number", name);
      EXPECT_NE(std::string(error.what()).find(words), std::string::npos) << error.what();
    }
}

TEST_F(LabelImages, ANiftiImageLiesWhereItsSformSays) {
  const LabelVolume turned = read_label_volume(write_file(folder_ / "t.nii", nifti_header() + voxels_));
  // Voxel (2, 1, 1) lies at (8, 22, 33) there, which to the left and to the back is (-8, -22, 33).
  EXPECT_TRUE(place(turned, 11).isApprox(Eigen::Vector3d(-0.008, -0.022, 0.033))) << place(turned, 11).transpose();
  EXPECT_GT(turned.turn.determinant(), 0);
}

TEST_F(LabelImages, DamageIsRefused) {
  const auto refused = [&](const std::string& name, const std::string& bytes) {
    EXPECT_THROW(read_label_volume(write_file(folder_ / name, bytes)), std::runtime_error) << name;
  };
  const std::string good = mha("1");
  refused("cut.mha", good.substr(0, good.size() - 5));
  refused("huge.mha", replaced(good, "3 2 2", "60000 60000 60000"));
  refused("word.nii", "no image");
  refused("word.nrrd", "NRRD0004\ntype: uchar\n");
  EXPECT_THROW(read_label_volume(folder_.path()), std::runtime_error);
}

// Room is made for all that a header announces: a few hundred bytes must not ask for gigabytes.
TEST_F(LabelImages, AHeaderThatAnnouncesMoreThanItsFileCanHoldIsRefusedFirst) {
  std::string nifti = nifti_header();
  for (const std::size_t at : {42, 44, 46}) nifti.replace(at, 2, "\xe8\x03");  // 1000
  for (const auto& [name, bytes] :
       {std::pair{"huge.nii", nifti}, {"huge.nrrd", replaced(nrrd_header(), "sizes: 3 2 2", "sizes: 1000 1000 1000")}})
    try {
      read_label_volume(write_file(folder_ / name, bytes + voxels_));
      FAIL() << name;
    } catch (const std::runtime_error& error) {
      EXPECT_NE(std::string(error.what()).find("it ends before its last voxel"), std::string::npos) << error.what();
    }
}

TEST_F(LabelImages, WhatIsSaidOfAFileHasNoAddressesInIt) {
  std::string said;
  try {
    read_label_volume(write_file(folder_ / "lacks.mha", replaced(mha("1"), "3 2 2", "3 2")));
  } catch (const std::runtime_error& error) {
    said = error.what();
  }
  EXPECT_NE(said.find("lacks.mha: ITK refuses it: "), std::string::npos) << said;
  EXPECT_EQ(said.find("0x"), std::string::npos) << said;
  EXPECT_EQ(said.find('\n'), std::string::npos) << said;
}

}  // namespace
}  // namespace palpate
