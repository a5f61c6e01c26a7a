#include "common/models/quasi_static/nonlinear.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <functional>
#include <numbers>
#include <stdexcept>

namespace palpate {
namespace {

constexpr double kRadius = 0.015, kHeight = 0.013;

class QuasiNonlinearLaw : public ::testing::Test {
 protected:
  QuasiNonlinearLaw() {
    char name[] = "/tmp/palpate_curves_XXXXXX";
    folder_ = mkdtemp(name);
    body.name = "specimen";
    body.material = {3000, 0.4, 1000};
    body.nonlinear = Nonlinear{MeasuredLaw{folder_ / "force.csv", folder_ / "radial.csv", kRadius, kHeight, 6, {}, 1}};
    write_force([](double x) { return 100 * x + 3e4 * x * x; });
    write_radial([](double x) { return 0.5 * x + 20 * x * x; });
  }
  ~QuasiNonlinearLaw() override { std::filesystem::remove_all(folder_); }

  void write(const std::string& name, const std::string& text) const { std::ofstream(folder_ / name) << text; }
  void write_force(const std::function<double(double)>& y, int points = 30) const {
    write("force.csv", "displacement_m,force_N\n" + rows(y, points));
  }
  void write_radial(const std::function<double(double)>& y) const {
    write("radial.csv", "displacement_m,radial_m\n" + rows(y, 30));
  }
  static std::string rows(const std::function<double(double)>& y, int points) {
    std::string text;
    for (int i = 0; i <= points; ++i) {
      const double x = 0.004 * i / points;
      char line[80];
      std::snprintf(line, sizeof line, "%.17g,%.17g\n", x, y(x));
      text += line;
    }
    return text;
  }
  MeasuredLaw& measured() { return std::get<MeasuredLaw>(body.nonlinear->law); }
  QuasiNonlinear law() const { return make_nonlinear(body, Archive{}).at(Eigen::Vector3d::Zero()); }
  std::string refusal() const {
    try {
      law();
    } catch (const std::runtime_error& error) {
      const std::string said = error.what();
      EXPECT_TRUE(said.starts_with(folder_.string())) << said;
      return said.substr(folder_.string().size() + 1);
    }
    return "accepted";
  }

  std::filesystem::path folder_;
  QuasiStaticSpec body;
};

TEST_F(QuasiNonlinearLaw, TurnsTheClosedLinearCurvesIntoTheMeasuredOnes) {
  const QuasiNonlinear q = law();
  for (double x = 1e-5; x <= 0.004; x += 1e-5) {
    const double force = std::numbers::pi * kRadius * kRadius * 3000 * x / kHeight,
                 radial = 0.4 * kRadius * x / kHeight;
    ASSERT_NEAR(force * q.force_scale(force), 100 * x + 3e4 * x * x, 1e-9);
    ASSERT_NEAR(radial * q.radial_scale(radial), 0.5 * x + 20 * x * x, 1e-12);
    ASSERT_GT(q.force_slope(force), 0);
  }
}

TEST_F(QuasiNonlinearLaw, TakesTheSlopesOfTheSpecimenFromTheArchive) {
  measured().specimen_mesh = "specimen.msh";
  EXPECT_THROW(law(), std::runtime_error);
  Archive archive;
  archive.specimen_force_slope = 250;
  archive.specimen_radial_slope = 0.3;
  const QuasiNonlinear q = make_nonlinear(body, archive).at(Eigen::Vector3d::Zero());
  const double x = 0.003;
  EXPECT_NEAR(250 * x * q.force_scale(250 * x), 100 * x + 3e4 * x * x, 1e-9);
  EXPECT_NEAR(0.3 * x * q.radial_scale(0.3 * x), 0.5 * x + 20 * x * x, 1e-12);
}

TEST_F(QuasiNonlinearLaw, SplitsADisplacementAlongAndAcrossThePress) {
  const QuasiNonlinear q = law();
  const Eigen::Vector3d press = Eigen::Vector3d(1, 2, -2) / 3, across = Eigen::Vector3d(2, 0, 1).normalized() * 0.001;
  const Eigen::Vector3d u = 0.002 * press + across;
  const Eigen::Vector3d expected = 0.002 * press + q.radial_scale(0.001) * across;
  EXPECT_NEAR((q.correct(u, press) - expected).norm(), 0, 1e-15);
  EXPECT_EQ(q.correct(u, Eigen::Vector3d::Zero()), u);
  EXPECT_EQ(q.correct(Eigen::Vector3d::Zero(), press), Eigen::Vector3d::Zero());
  EXPECT_NEAR((q.correct(0.01 * press, press) - 0.01 * press).norm(), 0, 1e-16);
}

TEST_F(QuasiNonlinearLaw, FieldKeepsWhatIsHeld) {
  const QuasiNonlinear q = law();
  const Eigen::Vector3d press = -Eigen::Vector3d::UnitZ();
  const std::vector<double> linear = {1e-3, 0, -1e-3, 0, 2e-3, -3e-3, 1e-3, 1e-3, 0};
  const std::vector<float> single(linear.begin(), linear.end());
  const std::vector<int> held = {1};
  std::vector<double> out(9);
  std::vector<float> out_single(9);
  add_corrected<double>(q, linear, press, out);
  keep_held<double>(held, linear, out);
  add_corrected<float>(q, single, press, out_single);
  keep_held<float>(held, single, out_single);
  for (int n : {0, 2}) {
    const Eigen::Vector3d u(linear.data() + 3 * n), corrected(out.data() + 3 * n);
    EXPECT_EQ(corrected, q.correct(u, press));
    EXPECT_GT((corrected - u).norm(), 1e-5);
  }
  EXPECT_TRUE(std::equal(out.begin() + 3, out.begin() + 6, linear.begin() + 3));
  EXPECT_TRUE(std::equal(out_single.begin() + 3, out_single.begin() + 6, single.begin() + 3));
  for (int i = 0; i < 9; ++i) EXPECT_NEAR(out_single[i], out[i], 1e-9);
  add_corrected<double>(q, linear, press, out);  // a second tool's
  for (int n : {0, 2})
    EXPECT_EQ(Eigen::Vector3d(out.data() + 3 * n), 2 * q.correct(Eigen::Vector3d(linear.data() + 3 * n), press));
}

TEST_F(QuasiNonlinearLaw, AForceThatFallsIsRefusedWithItsPlace) {
  write_force([](double x) { return 100 * x * (1 - x / 0.005); });
  EXPECT_EQ(refusal(),
            "force.csv: the force of the fit of degree 6 would fall while the tool advances, at a "
            "displacement of 0.0025 m");
}

TEST_F(QuasiNonlinearLaw, AFitThatOscillatesIsRefusedThoughTheDataRise) {
  write_force([](double x) { return x < 0.002 ? 1e-3 * x : 1 + 1e-3 * x; });
  measured().degree = 10;
  EXPECT_NE(refusal().find("would fall while the tool advances"), std::string::npos);
}

TEST_F(QuasiNonlinearLaw, MalformedCurvesAreRefusedWithTheLine) {
  const std::string header = "displacement_m,force_N\n";
  write("force.csv", header + "0,0\n0.001,1\n0.001,2\n");
  EXPECT_EQ(refusal(), "force.csv:4: the displacement 0.001 does not come after 0.001");
  write("force.csv", header + "-0.001,0\n");
  EXPECT_EQ(refusal(), "force.csv:2: the displacement -0.001 is negative; loading counts from 0");
  write("force.csv", header + "0,0.5\n0.001,1\n");
  EXPECT_EQ(refusal(), "force.csv:2: the curve must pass through zero, and is 0.5 without displacement");
  write("force.csv", header + "0,0\n0.001,nan\n");
  EXPECT_EQ(refusal(), "force.csv:3: 'nan' is not a finite number");
  write("force.csv", header + "0,0\n0.001,1\n0.002,2\n");
  EXPECT_EQ(refusal(), "force.csv:4: a fit of degree 6 needs as many points beyond zero, and there are 2");
  write("force.csv", "displacement_m,radial_m\n0,0\n");
  EXPECT_EQ(refusal(), "force.csv:1: the header must be 'displacement_m,force_N'");
}

TEST_F(QuasiNonlinearLaw, ARadialCurveNeedsAModelThatWidens) {
  body.material.poisson = 0;
  EXPECT_EQ(refusal(),
            "radial.csv: the radial curve needs a linear model that widens under a press: poisson must be "
            "greater than 0");
}

}  // namespace
}  // namespace palpate
