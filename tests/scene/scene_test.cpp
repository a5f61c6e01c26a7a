#include "common/scene/scene.hpp"

#include <gtest/gtest.h>

#include "tests/scene/full_scene.hpp"

namespace palpate {
namespace {

TensorMassSpec tensor_mass_like(const MovingSpec& body) {
  TensorMassSpec spec;
  static_cast<MovingSpec&>(spec) = body;
  return spec;
}

class SceneFile : public ::testing::Test {
 protected:
  Scene parse(const std::string& text) const { return parse_scene(text, folder / "scene.toml"); }
  SceneFolder folder;
};

TEST_F(SceneFile, EveryKeyArrivesWhereItBelongs) {
  const Scene scene = load_scene(folder.write("scene.toml", kFullScene));
  EXPECT_EQ(scene.file, folder / "scene.toml");
  EXPECT_EQ(scene.title, "All \"keys\" at once");
  ASSERT_EQ(scene.bodies.size(), 8u);
  const auto& body = std::get<QuasiStaticSpec>(scene.bodies[0]);
  EXPECT_EQ(body.name, "liver");
  EXPECT_EQ(body.mesh, folder / "liver.msh");
  EXPECT_EQ(body.scale, 0.001);
  EXPECT_EQ(body.material.young, 6000);
  EXPECT_EQ(body.material.poisson, 0.45);
  EXPECT_EQ(body.material.density, 1060);
  ASSERT_EQ(body.fixed.size(), 3u);
  EXPECT_EQ(body.fixed[0].where.indices, (std::vector<int>{3, 1, 2}));
  EXPECT_EQ(body.fixed[0].axes, (std::array<bool, 3>{true, false, true}));
  EXPECT_EQ(body.fixed[1].where.box->max, Eigen::Vector3d(0.1, 0.2, 0.3));
  EXPECT_EQ(body.fixed[1].axes, (std::array<bool, 3>{true, true, true}));
  EXPECT_EQ(body.fixed[2].where.group, "attachment");
  ASSERT_EQ(body.materials.size(), 3u);
  EXPECT_EQ(body.materials[0].where.indices, (std::vector<int>{7, 8}));
  EXPECT_EQ(body.materials[0].material.young, 1e5);
  EXPECT_EQ(body.materials[0].material.poisson, 0.45);  // the body's
  EXPECT_EQ(body.materials[2].where.group, "7");
  EXPECT_EQ(body.materials[2].material.density, 900);
  const MeasuredLaw& measured = std::get<MeasuredLaw>(body.nonlinear->law);
  EXPECT_EQ(measured.radial_curve, folder / "radial.csv");
  EXPECT_EQ(measured.degree, 5);
  EXPECT_EQ(measured.specimen_scale, 0.1);
  EXPECT_EQ(body.touchable->indices, (std::vector<int>{10, 11}));
  EXPECT_EQ(as<MeshedSpec>(scene.bodies[1])->touchable->box->max, Eigen::Vector3d(1, 1, 0));
  const Relaxation& relaxation = *as<QuasiStaticSpec>(scene.bodies[1])->relaxation;
  EXPECT_EQ(relaxation.times, (std::vector{0.1, 2.0}));
  EXPECT_EQ(relaxation.shares, (std::vector{0.3, 0.25}));
  EXPECT_EQ(as<MeshedSpec>(scene.bodies[2])->touchable->group, "top");
  ASSERT_EQ(scene.tools.size(), 6u);
  const Tool& tool = scene.tools[0];
  EXPECT_NEAR((tool.axis - Eigen::Vector3d(1, 2, -3) / std::sqrt(14.0)).norm(), 0, 1e-15);
  EXPECT_EQ(std::get<ProbeSpec>(tool.end).radius, 0.006);
  EXPECT_EQ(std::get<ScriptedDeviceSpec>(tool.device).trajectory, folder / "move.csv");
  EXPECT_EQ(tool.max_force_rate, 4000);
  EXPECT_EQ(tool.force_scale, 0.5);
  EXPECT_TRUE(std::holds_alternative<BusDeviceSpec>(scene.tools[1].device));
  EXPECT_EQ(std::get<LogDeviceSpec>(scene.tools[2].device).trajectory, folder / "session.lcmlog");
  EXPECT_EQ(scene.contact.rule, ContactRule::alpha);
  EXPECT_EQ(scene.contact.bucket_size, 0.01);
  EXPECT_EQ(scene.network.domain, 7);
  EXPECT_EQ(scene.network.peers.size(), 2u);
  ASSERT_TRUE(scene.network.security);
  EXPECT_EQ(scene.network.security->keys, folder / "keys") << "which need not be there to read the scene";
  EXPECT_EQ(scene.rates.visual_hz, 90.5);
  EXPECT_EQ(scene.record->file, folder / "out/session.lcmlog");
  EXPECT_EQ(scene.render->camera.field_of_view, 60);
  EXPECT_EQ(scene.render->tissue_colour[2], 0.1);
  EXPECT_FALSE(scene.render->overlay);
}

TEST_F(SceneFile, KeysOfMovingTissueArriveWhereTheyBelong) {
  const Scene scene = parse(kFullScene);
  const auto &segment = std::get<HybridSpec>(scene.bodies[3]), &duct = std::get<HybridSpec>(scene.bodies[4]);
  const auto& web = std::get<SpringMassSpec>(scene.bodies[5]);
  EXPECT_FALSE(as<MovingSpec>(scene.bodies[0]));
  EXPECT_TRUE(as<MovingSpec>(scene.bodies[3]) && as<MovingSpec>(scene.bodies[5]));
  EXPECT_EQ(kind_of(scene.bodies[3]), "hybrid");
  EXPECT_EQ(segment.dynamic.integrator, Integrator::semi_implicit);
  EXPECT_EQ(segment.dynamic.precision, Precision::float64);
  EXPECT_EQ(segment.dynamic.step, 0.0005);
  EXPECT_EQ(segment.dynamic.damping, 12);
  EXPECT_EQ(segment.dynamic.gravity, Eigen::Vector3d(0, 0, -9.81));
  EXPECT_TRUE(segment.dynamic.corotational);
  EXPECT_EQ(segment.tearing->criterion, TearCriterion::mean_elongation);
  EXPECT_EQ(segment.tearing->threshold, 0.7);
  ASSERT_EQ(segment.hybrid.regions.size(), 3u);
  EXPECT_EQ(segment.hybrid.regions[0].indices, (std::vector<int>{4, 2}));
  EXPECT_EQ(segment.hybrid.regions[1].box->max, Eigen::Vector3d(0.01, 0.02, 0.03));
  EXPECT_EQ(segment.hybrid.regions[2].group, "5");
  EXPECT_TRUE(segment.hybrid.mesh.empty());
  EXPECT_EQ(duct.hybrid.mesh, folder / "coarse.msh");
  EXPECT_EQ(duct.hybrid.scale, 0.01);
  EXPECT_TRUE(duct.hybrid.regions.empty());
  EXPECT_EQ(web.dynamic.gravity, Eigen::Vector3d(0, 0, -1.5));
  EXPECT_EQ(web.dynamic.integrator, Dynamic{}.integrator);
  const auto &probe = std::get<ProbeSpec>(scene.tools[0].end), &hook = std::get<ProbeSpec>(scene.tools[1].end);
  EXPECT_EQ(probe.cautery->radius, 0.002);
  EXPECT_EQ(probe.jaws->length, 0.02);
  EXPECT_EQ(probe.jaws->width, 0.005);
  EXPECT_EQ(probe.jaws->closed_below, 0.2);
  EXPECT_FALSE(hook.cautery || hook.jaws);
}

TEST_F(SceneFile, KeysOfShellAndCatheterArriveWhereTheyBelong) {
  const Scene scene = parse(kFullScene);
  const auto& duct = std::get<ModalShellSpec>(scene.bodies[6]);
  const auto& wire = std::get<CatheterSpec>(scene.bodies[7]);
  EXPECT_FALSE(as<MovingSpec>(scene.bodies[6]) || as<MovingSpec>(scene.bodies[7]));
  EXPECT_EQ(duct.mesh, folder / "tube.stl");
  EXPECT_EQ(duct.fixed[0].axes, (std::array<bool, 3>{true, true, false}));
  EXPECT_FALSE(duct.fixed[0].rotations);
  EXPECT_EQ(duct.touchable->indices, (std::vector<int>{1, 2}));
  EXPECT_EQ(duct.shell.thickness, 0.001);
  EXPECT_EQ(duct.shell.bending, Bending::polynomial);
  EXPECT_EQ(duct.shell.modes, 40);
  EXPECT_EQ(duct.shell.damping, 3);
  EXPECT_FALSE(duct.shell.residual);
  EXPECT_FALSE(as<CatheterSpec>(scene.bodies[6]) || as<ShellSpec>(scene.bodies[7]));
  EXPECT_FALSE(as<MeshedSpec>(scene.bodies[7])) << "it has no mesh and is fixed nowhere";
  EXPECT_EQ(wire.material.young, 3e7);
  EXPECT_EQ(wire.material.poisson, 0.45);
  EXPECT_EQ(wire.catheter.inside, "cystic_duct");
  EXPECT_EQ(wire.catheter.tail, Eigen::Vector3d(-0.14, 0, 0.01));
  EXPECT_EQ(wire.catheter.tip, Eigen::Vector3d(-0.02, 0, 0.01));
  EXPECT_EQ(wire.catheter.radius, 0.0013);
  EXPECT_EQ(wire.catheter.particles, 61);
  EXPECT_EQ(wire.catheter.sleeve, 0.03);
  EXPECT_EQ(wire.catheter.damping, 4);
  EXPECT_EQ(wire.catheter.gravity, Eigen::Vector3d(0, 0, -9.5));
  EXPECT_EQ(wire.catheter.integrator, ChainIntegrator::semi_implicit);
  const Tool& tool = scene.tools[3];
  ASSERT_TRUE(std::holds_alternative<ForcepsSpec>(tool.end));
  EXPECT_EQ(tool.compliance, 0.0002);
  EXPECT_EQ(std::get<ForcepsSpec>(tool.end).jaws.length, 0.015);
  EXPECT_EQ(std::get<ForcepsSpec>(tool.end).jaws.radius, 0.0012);
  EXPECT_EQ(std::get<ForcepsSpec>(tool.end).jaws.max_open, 0.9);
  EXPECT_EQ(std::get<ForcepsSpec>(tool.end).jaws.grip_stiffness, 0.4);
  EXPECT_EQ(std::get<ForcepsSpec>(tool.end).jaws.friction, 0.6);
  EXPECT_TRUE(std::holds_alternative<ProbeSpec>(scene.tools[0].end));
}

TEST_F(SceneFile, AShellHasOneLawOfDampingAndIsClampedWhereItIsFixed) {
  const std::string shell =
      "[[body]]\nname = \"a\"\nmesh = \"tube.stl\"\nmodel = \"modal_shell\"\nyoung = 1\npoisson = 0\n"
      "fixed = [{ group = \"a\" }]\n";
  const auto wall = [](const Scene& scene) { return std::get<ModalShellSpec>(scene.bodies[0]); };
  const ModalShellSpec plain = wall(parse(shell + "shell = { thickness = 0.002 }\n"));
  EXPECT_TRUE(plain.fixed[0].rotations && plain.shell.residual);
  EXPECT_EQ(plain.shell.damping_ratio, 0.2);
  EXPECT_EQ(plain.shell.damping, 0);
  EXPECT_EQ(plain.shell.modes, 50);
  const Scene undamped = parse(shell + "shell = { thickness = 0.002, damping_ratio = 0 }\n");
  EXPECT_EQ(wall(undamped).shell.damping_ratio, 0);
  EXPECT_EQ(wall(parse(to_toml(undamped))).shell.damping_ratio, 0);
}

TEST_F(SceneFile, ACauteryCutsWithTheTipUnlessItsRadiusIsGiven) {
  const std::string tool = "[[tool]]\nname = \"a\"\npivot = [0, 0, 0]\ndevice = \"bus\"\nradius = 0.003\n";
  EXPECT_EQ(std::get<ProbeSpec>(parse(kMinimalScene + tool + "cautery = {}\n").tools[0].end).cautery->radius, 0.003);
  EXPECT_EQ(
      std::get<ProbeSpec>(parse(kMinimalScene + tool + "cautery = { radius = 0.001 }\n").tools[0].end).cautery->radius,
      0.001);
}

TEST_F(SceneFile, AbsentSectionsStayEmpty) {
  const Scene scene = parse(kMinimalScene);
  EXPECT_TRUE(scene.title.empty());
  EXPECT_TRUE(scene.tools.empty());
  EXPECT_FALSE(scene.record || scene.render);
  const auto& body = std::get<QuasiStaticSpec>(scene.bodies[0]);
  EXPECT_FALSE(body.nonlinear || body.touchable);
  EXPECT_FALSE(as<MovingSpec>(scene.bodies[0])) << "it has no tearing and no hybrid part";
  EXPECT_TRUE(body.materials.empty());
  EXPECT_EQ(scene.contact.friction, ContactSpec{}.friction);
}

TEST_F(SceneFile, ResolvedSceneReadsBackTheSame) {
  for (const std::string& text : {kFullScene, kMinimalScene}) {
    const std::string resolved = to_toml(parse(text));
    EXPECT_EQ(to_toml(parse(resolved)), resolved);
    EXPECT_EQ(scene_hash(parse(resolved)), scene_hash(parse(text)));
  }
}

TEST_F(SceneFile, DoublesRoundTripBitForBit) {
  Scene scene = parse(kMinimalScene);
  for (double scale : {0.1, 1.0 / 3, 5e-324, 1.7976931348623157e308, 6000.0, 1e22, 123456789.123456789, 1e16}) {
    as<MeshedSpec>(scene.bodies[0])->scale = scale;
    EXPECT_EQ(as<MeshedSpec>(parse(to_toml(scene)).bodies[0])->scale, scale);
  }
  scene.tools.emplace_back().name = "t";
  scene.tools[0].device = BusDeviceSpec{};
  scene.tools[0].pivot = {-0.0, 1.0 / 7, -1e-300};
  const Eigen::Vector3d back = parse(to_toml(scene)).tools[0].pivot;
  EXPECT_TRUE(std::signbit(back.x()));
  EXPECT_EQ(back, scene.tools[0].pivot);
  for (int k = 1; k < 200; ++k) {
    scene.tools[0].axis = Eigen::Vector3d(k, 1 - 3.7 * k, 0.1 * k * k).normalized();
    const Eigen::Vector3d axis = parse(to_toml(scene)).tools[0].axis;
    ASSERT_EQ(axis, scene.tools[0].axis);
  }
}

TEST_F(SceneFile, TextWithEscapesRoundTrips) {
  Scene scene = parse(kMinimalScene);
  scene.title = "tab\t quote\" backslash\\ newline\n bell\x07 delete\x7f umlaut \xc3\xa4";
  EXPECT_EQ(parse(to_toml(scene)).title, scene.title);
}

TEST_F(SceneFile, HashSeesWhatNodesMustAgreeOn) {
  const Scene scene = parse(kFullScene);
  const std::string hash = scene_hash(scene);
  EXPECT_EQ(hash.size(), 32u);
  const auto changed = [&](auto&& change) {
    Scene other = scene;
    change(other);
    return scene_hash(other) != hash;
  };
  EXPECT_TRUE(changed([](Scene& s) { as<SolidSpec>(s.bodies[0])->material.young *= 1 + 1e-15; }));
  EXPECT_TRUE(changed([](Scene& s) { as<SolidSpec>(s.bodies[0])->fixed[0].axes[1] = true; }));
  EXPECT_TRUE(
      changed([](Scene& s) { std::get<MeasuredLaw>(as<QuasiStaticSpec>(s.bodies[0])->nonlinear->law).degree = 6; }));
  EXPECT_TRUE(changed([](Scene& s) { as<QuasiStaticSpec>(s.bodies[0])->nonlinear->law = NeoHookeanLaw{}; }));
  EXPECT_TRUE(changed([](Scene& s) { as<QuasiStaticSpec>(s.bodies[0])->nonlinear.reset(); }));
  EXPECT_TRUE(changed([](Scene& s) { as<QuasiStaticSpec>(s.bodies[1])->relaxation->shares[1] = 0.2; }));
  EXPECT_TRUE(changed([](Scene& s) { std::get<ProbeSpec>(s.tools[0].end).radius = 0.007; }));
  EXPECT_TRUE(changed([](Scene& s) { s.contact.friction = 0.2; }));
  EXPECT_TRUE(changed([](Scene& s) { s.rates.haptic_hz = 1000; }));
  EXPECT_TRUE(changed([](Scene& s) { as<MovingSpec>(s.bodies[3])->dynamic.step = 0; }));
  EXPECT_TRUE(changed([](Scene& s) { as<MovingSpec>(s.bodies[3])->dynamic.gravity.x() = 1; }));
  EXPECT_TRUE(changed([](Scene& s) { as<MovingSpec>(s.bodies[3])->dynamic.precision = Precision::float32; }));
  EXPECT_TRUE(changed([](Scene& s) { as<MovingSpec>(s.bodies[3])->dynamic.integrator = Integrator::rk4; }));
  EXPECT_TRUE(changed([](Scene& s) { as<MovingSpec>(s.bodies[3])->dynamic.corotational = false; }));
  EXPECT_TRUE(changed([](Scene& s) { as<MovingSpec>(s.bodies[3])->dynamic.damping = 13; }));
  EXPECT_TRUE(changed([](Scene& s) { as<MovingSpec>(s.bodies[3])->tearing->threshold = 0.8; }));
  EXPECT_TRUE(changed([](Scene& s) { as<HybridSpec>(s.bodies[3])->hybrid.regions.pop_back(); }));
  EXPECT_TRUE(changed([](Scene& s) { as<HybridSpec>(s.bodies[4])->hybrid.scale = 1; }));
  EXPECT_TRUE(changed([](Scene& s) { s.bodies[5] = tensor_mass_like(*as<MovingSpec>(s.bodies[5])); }));
  EXPECT_TRUE(changed([](Scene& s) { std::get<ProbeSpec>(s.tools[0].end).cautery->radius = 0.003; }));
  EXPECT_TRUE(changed([](Scene& s) { std::get<ProbeSpec>(s.tools[0].end).jaws.reset(); }));
  EXPECT_TRUE(changed([](Scene& s) { as<ShellSpec>(s.bodies[6])->shell.modes = 50; }));
  EXPECT_TRUE(changed([](Scene& s) { as<ShellSpec>(s.bodies[6])->shell.damping = 2; }));
  EXPECT_TRUE(changed([](Scene& s) { as<ShellSpec>(s.bodies[6])->shell.residual = true; }));
  EXPECT_TRUE(changed([](Scene& s) { as<ShellSpec>(s.bodies[6])->fixed[0].rotations = true; }));
  EXPECT_TRUE(changed([](Scene& s) { as<CatheterSpec>(s.bodies[7])->catheter.particles = 60; }));
  EXPECT_TRUE(changed([](Scene& s) { as<CatheterSpec>(s.bodies[7])->catheter.inside.clear(); }));
  EXPECT_TRUE(changed([](Scene& s) { s.tools[3].end = ProbeSpec{}; }));
  EXPECT_TRUE(changed([](Scene& s) { s.tools[3].compliance = 1e-4; }));
  EXPECT_TRUE(changed([](Scene& s) { std::get<ForcepsSpec>(s.tools[3].end).jaws.friction = 0.8; }));
  EXPECT_FALSE(changed([](Scene& s) { as<HybridSpec>(s.bodies[4])->hybrid.mesh = "/elsewhere/coarse.msh"; }));
  EXPECT_FALSE(changed([](Scene& s) { s.title = "another"; }));
  EXPECT_FALSE(changed([](Scene& s) { s.network.domain = 8; }));
  EXPECT_FALSE(changed([](Scene& s) { s.network.security = std::nullopt; }));
  EXPECT_FALSE(changed([](Scene& s) { s.record.reset(); }));
  EXPECT_FALSE(changed([](Scene& s) { s.render.reset(); }));
  EXPECT_FALSE(changed(
      [](Scene& s) { s.tools[0].device = LogDeviceSpec{std::get<ScriptedDeviceSpec>(s.tools[0].device).trajectory}; }));
}

TEST_F(SceneFile, HashSeesTheCurvesContentsAndNotTheirPlace) {
  const SceneFolder elsewhere;
  const auto hash_in = [](const SceneFolder& f) { return scene_hash(parse_scene(kFullScene, f / "other.toml")); };
  EXPECT_EQ(hash_in(folder), hash_in(elsewhere));
  elsewhere.write("force.csv", "other bytes\n");
  EXPECT_NE(hash_in(folder), hash_in(elsewhere));
}

}  // namespace
}  // namespace palpate
