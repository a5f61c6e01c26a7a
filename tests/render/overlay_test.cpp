#include "render_node/overlay.hpp"

#include <gtest/gtest.h>

#include "render_node/clear_corner.hpp"
#include "render_node/font.hpp"
#include "tests/render/scenery.hpp"

namespace palpate {
namespace {

using namespace testing;

bool is_text(const std::uint8_t* p) {
  return p[0] > 190 && p[1] > 190 && p[2] > 190;
}

TEST(Overlay, TextIsBrightOnADarkPanel) {
  Frame frame = empty_frame();
  const Image without = picture(frame, 640, 480);
  frame.overlay = Overlay{{"haptic 1000 Hz", "force 1.83 N"}, {}};
  const Image with = picture(frame, 640, 480);
  EXPECT_EQ(share(without, is_text), 0);
  const double ink = share(with, is_text) * 640 * 480;
  EXPECT_GT(ink, 150);
  EXPECT_LT(ink, 1500);
  // All of it lies in the upper left corner.
  for (int y = 100; y < 480; ++y)
    for (int x = 0; x < 640; ++x) ASSERT_FALSE(is_text(with.pixel(x, y)));
}

TEST(Overlay, EveryWordLooksDifferent) {
  Frame frame = empty_frame();
  frame.overlay = Overlay{{"force 1.83 N"}, {}};
  const Image a = picture(frame, 640, 480);
  frame.overlay = Overlay{{"force 1.88 N"}, {}};
  EXPECT_GT(difference(a, picture(frame, 640, 480), 30), 0);
}

TEST(Overlay, GaugeGrowsWithTheValue) {
  Frame frame = empty_frame();
  const auto green = [](const std::uint8_t* p) { return p[1] > 180 && p[0] < 120; };
  double last = -1;
  for (const double value : {0.0, 1.0, 2.0, 3.0}) {
    frame.overlay = Overlay{{"force"}, Gauge{value, 4}};
    const double now = share(picture(frame, 640, 480), green);
    EXPECT_GT(now, last);
    last = now;
  }
}

TEST(Overlay, StandsInTheCornerThatTheInstrumentsLeaveFree) {
  const Camera camera{.eye = {0, -0.3, 0}};
  const auto towards = [](const Eigen::Vector3d& handle) {
    InstrumentView tool;
    tool.tip.linear() = Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitZ(), -handle).toRotationMatrix();
    return tool;
  };
  const InstrumentView left = towards({-1, 0, 0.75}), right = towards({1, 0, 0.75}), below = towards({-1, 0, -0.75});
  const auto corner = [&](std::vector<InstrumentView> tools) { return clear_corner(camera, tools, 4.0 / 3); };
  EXPECT_EQ(corner({}), Corner::upper_left);
  EXPECT_EQ(corner({right}), Corner::upper_left);
  EXPECT_EQ(corner({left}), Corner::upper_right);
  EXPECT_EQ(corner({left, right}), Corner::lower_left);
  EXPECT_EQ(corner({left, right, below}), Corner::lower_right);

  Frame frame = empty_frame();
  frame.overlay = Overlay{{"force 1.83 N"}, Gauge{1, 3, "N"}, Corner::lower_right};
  const Image image = picture(frame, 640, 480);
  for (int y = 0; y < 480; ++y)
    for (int x = 0; x < 640; ++x) ASSERT_TRUE((x > 400 && y > 380) || !is_text(image.pixel(x, y)));
}

TEST(Overlay, LatinLettersBeyondAsciiAreDrawn) {
  const FontAtlas font(default_font(), 16);
  Frame frame = empty_frame();
  frame.overlay = Overlay{{"\xC2\xB5\xC3\xA9\xE2\x82\xAC"}, {}};  // micro, e acute, and the euro, which becomes '?'
  const auto vertices = lay_out(frame, font, 640, 480);
  ASSERT_EQ(vertices.size(), 6u * 4);  // the panel and three characters
  EXPECT_FLOAT_EQ(vertices[6 * 1].u * static_cast<float>(font.width()), static_cast<float>(font.glyph(0xB5).x));
  EXPECT_FLOAT_EQ(vertices[6 * 3].u * static_cast<float>(font.width()), static_cast<float>(font.glyph('?').x));
}

TEST(Overlay, MissingFontIsNamed) {
  EXPECT_EQ(complaint([] { FontAtlas("/nonexistent.ttf", 12); }),
            "/nonexistent.ttf: not a readable font (package fonts-dejavu-core)");
}

TEST(Legend, StepsAreRound) {
  EXPECT_DOUBLE_EQ(legend_step(10, 5), 2);
  EXPECT_DOUBLE_EQ(legend_step(1, 5), 0.2);
  EXPECT_DOUBLE_EQ(legend_step(8, 5), 2);
  EXPECT_DOUBLE_EQ(legend_step(30, 5), 10);
}

/// Direction of a colour, brightness apart.
Eigen::Vector3d chroma(const std::uint8_t* p) {
  return (Eigen::Vector3d(p[0] * p[0], p[1] * p[1], p[2] * p[2]) + Eigen::Vector3d::Constant(1e-3)).normalized();
}

TEST(Legend, TissueTakesTheColoursOfTheScale) {
  // Displacement grows from left to right; every pixel of the middle row is looked up in the drawn scale.
  Ball ball = make_ball(0.09f, 64);
  for (const auto& p : ball.position) ball.scalar.push_back(0.006f * (p.x() + 0.09f) / 0.18f);
  Frame frame = empty_frame();
  frame.meshes.push_back(ball.view(1));
  frame.legend = Legend{"displacement", 0.006};
  const Image image = picture(frame, 640, 480);

  // The scale: the longest vertical run in which the colour changes from dark blue to yellow, near the right
  // edge.
  int bar_x = 0;
  for (int x = 500; x < 640 && bar_x == 0; ++x) {
    const std::uint8_t *top = image.pixel(x, 160), *bottom = image.pixel(x, 335);
    if (top[0] > 180 && top[1] > 190 && top[2] < 90 && bottom[2] > 70 && bottom[1] < 60) bar_x = x + 2;
  }
  ASSERT_GT(bar_x, 0);
  const auto looked_up = [&](const std::uint8_t* p) {
    double best = -1, at = 0;
    for (int y = 145; y < 340; ++y) {
      const double match = chroma(image.pixel(bar_x, y)).dot(chroma(p));
      if (match > best) best = match, at = y;
    }
    return at;
  };
  double last = 1e9;
  int reversals = 0;
  for (int x = 200; x <= 440; x += 24) {
    const double at = looked_up(image.pixel(x, 300));
    reversals += at > last + 4;
    last = at;
  }
  EXPECT_EQ(reversals, 0);
  EXPECT_GT(looked_up(image.pixel(210, 300)) - looked_up(image.pixel(430, 300)), 60);
}

TEST(Legend, ColourWithoutScaleIsRefused) {
  Ball ball = make_ball(0.05f, 8);
  ball.scalar.assign(ball.rest.size(), 0.0f);
  Frame frame = empty_frame();
  frame.meshes.push_back(ball.view(3));
  EXPECT_EQ(complaint([&] { picture(frame); }), "mesh 3: colour by scalar needs a legend with a positive range");
}

}  // namespace
}  // namespace palpate
