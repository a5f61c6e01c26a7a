#include "render_node/film.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/mount.h>
#include <sys/stat.h>

#include <fstream>

#include "tests/render/scenery.hpp"

namespace palpate {
namespace {

using namespace testing;

/// A picture of one grey with a bright bar that moves with `i`.
Image test_picture(int width, int height, int i) {
  Image image{width, height, std::vector<std::uint8_t>(4u * width * height, 60)};
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < 8; ++x) image.rgba[4 * (static_cast<std::size_t>(y) * width + (4 * i + x) % width)] = 250;
  return image;
}

std::string output_of(const std::string& command) {
  std::FILE* pipe = ::popen(command.c_str(), "r");
  std::string text(4096, '\0');
  text.resize(std::fread(text.data(), 1, text.size(), pipe));
  ::pclose(pipe);
  return text;
}

TEST(Png, ReadsBackWhatWasWritten) {
  const Folder folder;
  Image image = test_picture(61, 33, 3);
  for (std::size_t i = 0; i < image.rgba.size(); ++i)
    image.rgba[i] = i % 4 == 3 ? 255 : static_cast<std::uint8_t>(i * 7);
  write_png(image, folder.path / "a.png");
  const Image back = read_png(folder.path / "a.png");
  EXPECT_EQ(back.width, 61);
  EXPECT_EQ(back.height, 33);
  EXPECT_EQ(back.rgba, image.rgba);
  EXPECT_EQ(folder.files(), 1);
}

TEST(Png, FailuresNameTheFileAndLeaveNothing) {
  const Folder folder;
  EXPECT_EQ(complaint([] { write_png(test_picture(8, 8, 0), "/nonexistent/a.png"); }),
            "/nonexistent/a.png: cannot be written: No such file or directory");
  std::filesystem::create_directory(folder.path / "taken.png");
  EXPECT_NE(complaint([&] { write_png(test_picture(8, 8, 0), folder.path / "taken.png"); }), "");
  EXPECT_EQ(folder.files(), 1);
  std::ofstream(folder.path / "text.png") << "no picture";
  EXPECT_NE(complaint([&] { read_png(folder.path / "text.png"); }).find("text.png: "), std::string::npos);
}

TEST(Film, HasAllFramesAtItsRate) {
  const Folder folder;
  const auto file = folder.path / "a.mp4";
  Film film(file, 160, 120, 30);
  for (int i = 0; i < 40; ++i) film.add(test_picture(160, 120, i));
  film.add(test_picture(160, 120, 40), 5);
  EXPECT_FALSE(std::filesystem::exists(file));
  film.finish();
  EXPECT_EQ(film.frames(), 45);
  EXPECT_EQ(folder.files(), 1);
  EXPECT_EQ(output_of("ffprobe -v error -count_frames -select_streams v -show_entries "
                      "stream=codec_name,width,height,pix_fmt,r_frame_rate,nb_read_frames -of csv=p=0 " +
                      file.string()),
            "h264,160,120,yuv420p,30/1,45\n");
  EXPECT_EQ(output_of("ffprobe -v error -show_entries format=duration -of csv=p=0 " + file.string()), "1.500000\n");
}

TEST(Film, ColoursSurvive) {
  const Folder folder;
  const auto file = folder.path / "a.mp4";
  Image red{64, 48, {}};
  for (int i = 0; i < 64 * 48; ++i) red.rgba.insert(red.rgba.end(), {150, 50, 40, 255});
  Film film(file, 64, 48, 30);
  film.add(red, 10);
  film.finish();
  const std::string raw = output_of(
      fmt::format("ffmpeg -v error -i {} -frames:v 1 -vf crop=8:8:30:20 -f rawvideo -pix_fmt rgb24 -", file.string()));
  ASSERT_EQ(raw.size(), 8u * 8 * 3);
  EXPECT_NEAR(static_cast<unsigned char>(raw[0]), 150, 3);
  EXPECT_NEAR(static_cast<unsigned char>(raw[1]), 50, 3);
  EXPECT_NEAR(static_cast<unsigned char>(raw[2]), 40, 3);
}

TEST(Film, OddSidesArePadded) {
  const Folder folder;
  Film film(folder.path / "a.mp4", 61, 33, 30);
  film.add(test_picture(61, 33, 0), 3);
  film.finish();
  EXPECT_EQ(output_of("ffprobe -v error -select_streams v -show_entries stream=width,height -of csv=p=0 " +
                      (folder.path / "a.mp4").string()),
            "62,34\n");
}

TEST(Film, LeavesNothingWithoutFinish) {
  const Folder folder;
  {
    Film film(folder.path / "a.mp4", 160, 120, 30);
    film.add(test_picture(160, 120, 0));
  }
  EXPECT_EQ(folder.files(), 0);
}

TEST(Film, ItsNameMeansNothingElseToFfmpeg) {
  const Folder folder;
  const auto before = std::filesystem::current_path();
  std::filesystem::current_path(folder.path);
  for (const char* name : {"a:b.mp4", "-x.mp4"}) {
    Film film(name, 64, 48, 30);
    film.add(test_picture(64, 48, 0), 3);
    EXPECT_EQ(complaint([&] { film.finish(); }), "");
    EXPECT_TRUE(std::filesystem::is_regular_file(name)) << name;
  }
  std::filesystem::current_path(before);
  EXPECT_EQ(folder.files(), 2);
}

TEST(Film, NothingIsWrittenThroughALinkThatTakesItsTemporaryName) {
  const Folder folder;
  const auto victim = folder.path / "victim";
  std::ofstream(victim) << "precious";
  Film film(folder.path / "a.mp4", 64, 48, 30);
  for (const auto& entry : std::filesystem::directory_iterator(folder.path)) {
    if (entry.path() == victim) continue;
    std::filesystem::remove(entry.path());
    std::filesystem::create_symlink("victim", entry.path());
  }
  film.add(test_picture(64, 48, 0), 3);
  film.finish();
  EXPECT_EQ(std::filesystem::file_size(victim), 8u);
}

TEST(Film, SaysThatFfmpegIsMissing) {
  const Folder folder;
  const std::string path = ::getenv("PATH");
  ::setenv("PATH", folder.path.c_str(), 1);
  const std::string said = complaint([&] { Film(folder.path / "a.mp4", 160, 120, 30); });
  ::setenv("PATH", path.c_str(), 1);
  EXPECT_EQ(said, (folder.path / "a.mp4").string() + ": films need the program ffmpeg, which is not installed");
  EXPECT_EQ(folder.files(), 0);
}

TEST(Film, RefusesAFileItCannotWriteAndAPictureOfAnotherSize) {
  EXPECT_EQ(complaint([] { Film("/nonexistent/a.mp4", 160, 120, 30); }),
            "/nonexistent/a.mp4: cannot be written: No such file or directory");
  const Folder folder;
  Film film(folder.path / "a.mp4", 160, 120, 30);
  EXPECT_NE(complaint([&] { film.add(test_picture(80, 60, 0)); }).find("cannot take a picture of 80 x 60"),
            std::string::npos);
}

TEST(Film, DeadFfmpegIsASentenceAndNotASignal) {
  const Folder folder;
  const auto fake = folder.path / "ffmpeg";
  std::ofstream(fake) << "#!/bin/sh\nsleep 0.1\necho 'the encoder broke' >&2\nexit 1\n";
  ::chmod(fake.c_str(), 0755);
  const std::string path = ::getenv("PATH");
  ::setenv("PATH", (folder.path.string() + ":" + path).c_str(), 1);
  const std::string said = complaint([&] {
    Film film(folder.path / "a.mp4", 640, 480, 30);
    for (int i = 0; i < 100; ++i) film.add(test_picture(640, 480, i));
    film.finish();
  });
  ::setenv("PATH", path.c_str(), 1);
  EXPECT_EQ(said, (folder.path / "a.mp4").string() + ": the film ends early: ffmpeg says: the encoder broke");
  EXPECT_EQ(folder.files(), 1);  // the fake
}

TEST(Film, FullDiskIsASentence) {
  const Folder folder;
  const auto small = folder.path / "small";
  std::filesystem::create_directory(small);
  if (::mount("tmpfs", small.c_str(), "tmpfs", 0, "size=64k") != 0) GTEST_SKIP() << "needs the right to mount";
  const std::string said = complaint([&] {
    Film film(small / "a.mp4", 320, 240, 30);
    Image noise{320, 240, std::vector<std::uint8_t>(4u * 320 * 240)};
    unsigned seed = 1;
    for (int i = 0; i < 60; ++i) {
      for (auto& byte : noise.rgba) byte = static_cast<std::uint8_t>((seed = seed * 1664525u + 1013904223u) >> 24);
      film.add(noise);
    }
    film.finish();
  });
  const bool empty = std::filesystem::is_empty(small);
  ::umount(small.c_str());
  EXPECT_NE(said.find("No space left on device"), std::string::npos) << said;
  EXPECT_TRUE(empty);
}

}  // namespace
}  // namespace palpate
