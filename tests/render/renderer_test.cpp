#include <gtest/gtest.h>

#include "common/geometry/direction.hpp"
#include "tests/render/scenery.hpp"

namespace palpate {
namespace {

using namespace testing;

constexpr int kCentreX = 160, kCentreY = 120;

TEST(Renderer, OrganCoversTheAreaOfItsSilhouette) {
  const Ball ball = make_ball(0.06f, 48);
  Frame frame = empty_frame();
  const Image without = picture(frame);
  frame.meshes.push_back(ball.view(1));
  const double covered = difference(picture(frame), without);
  // The ball's outline is a circle of tangent r / sqrt(d^2 - r^2) at distance 1, the picture 2 tan 25 deg
  // high.
  const double tangent = 0.06 / std::sqrt(0.3 * 0.3 - 0.06 * 0.06);
  const double half = std::tan(25 * std::numbers::pi / 180);
  const double expected = std::numbers::pi * tangent * tangent / (4 * half * half * 320.0 / 240.0);
  EXPECT_NEAR(covered, expected, 0.02 * expected);
}

TEST(Renderer, TissueIsRedAndLitFromTheCamera) {
  const Ball ball = make_ball(0.06f, 48);
  Frame frame = empty_frame();
  frame.meshes.push_back(ball.view(1));
  const Image image = picture(frame);
  double red = 0, green = 0, blue = 0, middle = 0, edge = 0;
  for (int y = kCentreY + 10; y < kCentreY + 40; ++y)
    for (int x = kCentreX - 30; x < kCentreX - 10; ++x) {
      red += image.pixel(x, y)[0];
      green += image.pixel(x, y)[1];
      blue += image.pixel(x, y)[2];
    }
  EXPECT_GT(red, 1.5 * green);
  EXPECT_GT(red, 1.5 * blue);
  for (int x = kCentreX - 10; x < kCentreX + 10; ++x) {
    middle += brightness(image, x, kCentreY + 15);
    edge += brightness(image, x, kCentreY + 49);
  }
  EXPECT_GT(middle, 1.3 * edge);
}

TEST(Renderer, TissueShinesWhereItMirrorsTheLight) {
  const Ball ball = make_ball(0.06f, 48);
  Frame frame = empty_frame();
  frame.meshes.push_back(ball.view(1));
  const Image image = picture(frame);
  EXPECT_GT(share(image, [](const std::uint8_t* p) { return p[1] > 120 && p[2] > 110; }), 0.0003);
}

TEST(Renderer, UpperRowsShowTheUpperEnd) {
  Ball ball = make_ball(0.03f, 24);
  for (auto& p : ball.position) p += Eigen::Vector3f(0.05f, 0, 0.06f);  // right and up
  Frame frame = empty_frame();
  const Image without = picture(frame);
  frame.meshes.push_back(ball.view(1));
  const Image image = picture(frame);
  EXPECT_NE(brightness(image, 205, 67), brightness(without, 205, 67));
  EXPECT_EQ(brightness(image, 115, 173), brightness(without, 115, 173));
}

TEST(Renderer, NearerThingsHideFartherOnes) {
  const Ball organ = make_ball(0.05f, 32);
  Ball wall = make_ball(0.05f, 32);
  for (auto& p : wall.position) p += Eigen::Vector3f(0.06f, 0.15f, 0);
  Frame alone = empty_frame(), both = empty_frame();
  alone.meshes.push_back(organ.view(1));
  both.meshes = {organ.view(1), wall.view(2, Finish::bone)};
  const Image a = picture(alone), b = picture(both);
  EXPECT_EQ(brightness(a, kCentreX, kCentreY), brightness(b, kCentreX, kCentreY));
  EXPECT_GT(difference(a, b), 0.01);  // the part that looks out behind the organ
  const std::uint8_t* bone = b.pixel(kCentreX + 52, kCentreY);
  EXPECT_GT(bone[0], 60);
  EXPECT_GT(bone[1], bone[0] / 3);  // paler than tissue
}

InstrumentView instrument_at(const Eigen::Vector3d& tip) {
  InstrumentView tool;
  tool.tip.translation() = tip;
  tool.tip.linear() = turn_between(Eigen::Vector3d::UnitZ(), Eigen::Vector3d(-0.8, 0, -0.6)).toRotationMatrix();
  return tool;
}

TEST(Renderer, InstrumentIsGreyAndShadesTheTissue) {
  const Ball ball = make_ball(0.06f, 48);
  Frame frame = empty_frame();
  frame.meshes.push_back(ball.view(1));
  const Image without = picture(frame);
  frame.instruments.push_back(instrument_at({0, -0.066, 0}));
  const Image with = picture(frame);
  const auto grey = [](const std::uint8_t* p) { return std::abs(p[0] - p[2]) < 30; };
  EXPECT_TRUE(grey(with.pixel(kCentreX, kCentreY)));
  EXPECT_FALSE(grey(without.pixel(kCentreX + 20, kCentreY + 20)));
  // Just below the tip the tissue lies in its shade.
  EXPECT_LT(brightness(with, kCentreX, kCentreY + 7), 0.9 * brightness(without, kCentreX, kCentreY + 7));
  // The shaft leaves the picture at the upper right.
  EXPECT_GT(
      std::abs(brightness(with, kCentreX + 40, kCentreY - 30) - brightness(without, kCentreX + 40, kCentreY - 30)), 5);
}

TEST(Renderer, OpenJawsLetTheBackgroundThrough) {
  Frame frame = empty_frame();
  const Image background = picture(frame);
  frame.instruments.push_back(instrument_at({0, -0.1, 0}));
  frame.instruments[0].tip.rotate(Eigen::AngleAxisd(0.5 * std::numbers::pi, Eigen::Vector3d::UnitZ()));
  EXPECT_NE(brightness(picture(frame), kCentreX, kCentreY), brightness(background, kCentreX, kCentreY));
  frame.instruments[0].jaw_opening = 1.0;
  const Image open = picture(frame);
  EXPECT_EQ(brightness(open, kCentreX, kCentreY), brightness(background, kCentreX, kCentreY));
  EXPECT_GT(difference(open, background), 0.01);
}

TEST(Renderer, TheSameFrameGivesTheSameBytes) {
  const Ball ball = make_ball(0.06f, 32);
  Frame frame = empty_frame();
  frame.meshes.push_back(ball.view(1));
  frame.instruments.push_back(instrument_at({0, -0.066, 0}));
  frame.overlay = Overlay{{"twice"}, Gauge{1, 2}};
  Renderer renderer(320, 240, 1);
  Image first, second;
  renderer.draw(frame, first);
  renderer.draw(frame, second);
  EXPECT_EQ(first.rgba, second.rgba);
  EXPECT_EQ(first.rgba, picture(frame).rgba);
}

TEST(Renderer, MovingVerticesShowAndComeBack) {
  Ball ball = make_ball(0.06f, 32);
  Frame frame = empty_frame();
  frame.meshes.push_back(ball.view(1));
  Renderer renderer(320, 240, 1);
  Image rest, pressed, back;
  renderer.draw(frame, rest);
  for (auto& p : ball.position) p.y() *= 0.5f;
  ball.update_normals();
  renderer.draw(frame, pressed);
  EXPECT_GT(difference(rest, pressed), 0.05);
  ball.position = ball.rest;
  ball.update_normals();
  renderer.draw(frame, back);
  EXPECT_EQ(rest.rgba, back.rgba);
}

TEST(Renderer, TextureSticksToRestPositions) {
  Ball ball = make_ball(0.06f, 48);
  Frame frame = empty_frame();
  frame.meshes.push_back(ball.view(1));
  const Image at_rest = picture(frame);
  const Eigen::Vector3f shift(0.5f, 0.25f, -0.125f);
  for (auto& p : ball.position) p += shift;
  frame.camera.eye += shift.cast<double>();
  frame.camera.target += shift.cast<double>();
  const Image moved = picture(frame);
  const auto patch = [](const Image& a, const Image& b) {
    long changed = 0;
    for (int y = kCentreY - 30; y < kCentreY + 30; ++y)
      for (int x = kCentreX - 30; x < kCentreX + 30; ++x)
        changed += std::abs(brightness(a, x, y) - brightness(b, x, y)) > 3;
    return static_cast<double>(changed) / 3600;
  };
  EXPECT_LT(patch(at_rest, moved), 0.02);
  for (auto& p : ball.rest) p += Eigen::Vector3f(0.0137f, 0.0071f, 0.0093f);
  EXPECT_GT(patch(at_rest, picture(frame)), 0.3);
}

TEST(Renderer, FourSamplesSoftenTheEdges) {
  Ball ball = make_ball(0.06f, 48);
  Frame frame = empty_frame();
  frame.meshes.push_back(ball.view(1));
  const Image hard = picture(frame, 320, 240, 1), soft = picture(frame, 320, 240, 4);
  const double changed = difference(hard, soft, 6);
  EXPECT_GT(changed, 0.001);  // the outline
  EXPECT_LT(changed, 0.05);   // and hardly anything else
}

TEST(Renderer, ResizingGivesThePictureOfThatSize) {
  const Ball ball = make_ball(0.06f, 32);
  Frame frame = empty_frame();
  frame.meshes.push_back(ball.view(1));
  Renderer renderer(320, 240, 1);
  Image image;
  renderer.draw(frame, image);
  renderer.resize(200, 160);
  renderer.draw(frame, image);
  EXPECT_EQ(image.width, 200);
  EXPECT_EQ(image.rgba.size(), 4u * 200 * 160);
  EXPECT_EQ(image.rgba, picture(frame, 200, 160).rgba);
}

TEST(Renderer, RefusesWhatItCannotDraw) {
  Renderer renderer(64, 64, 1);
  Image image;
  Ball ball = make_ball(0.05f, 8);
  Frame frame = empty_frame();
  frame.meshes.push_back(ball.view(7));
  ball.normal.pop_back();
  frame.meshes[0].normal = ball.normal;
  EXPECT_EQ(complaint([&] { renderer.draw(frame, image); }),
            "mesh 7: rest, position, normal and scalar differ in length");
  frame = empty_frame();
  frame.instruments.resize(9);
  EXPECT_EQ(complaint([&] { renderer.draw(frame, image); }), "a picture shows at most 8 instruments, not 9");
  frame = empty_frame();
  frame.camera.up = {0, 1, 0};
  EXPECT_EQ(complaint([&] { renderer.draw(frame, image); }), "the camera looks nowhere: check its eye, target and up");
  EXPECT_EQ(complaint([] { Renderer(0, 100); }), "a picture has 16 to 8192 pixels a side, not 0 x 100");
  renderer.draw(empty_frame(), image);  // and still works afterwards
  EXPECT_EQ(image.width, 64);
}

TEST(Renderer, DrawsEightInstruments) {
  Frame frame = empty_frame();
  const Ball ball = make_ball(0.06f, 16);
  frame.meshes.push_back(ball.view(1));
  for (int i = 0; i < 8; ++i) frame.instruments.push_back(instrument_at({0.02 * (i - 4), -0.07, 0}));
  const Image image = picture(frame);
  frame.instruments.resize(7);
  EXPECT_GT(difference(image, picture(frame)), 0.005);
}

}  // namespace
}  // namespace palpate
