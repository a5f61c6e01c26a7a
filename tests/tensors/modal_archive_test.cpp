#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <functional>
#include <set>

#include "common/archive/compliance.hpp"
#include "common/geometry/dense_solvers.hpp"
#include "common/mesh/shell_file.hpp"
#include "common/mesh/shell_generators.hpp"
#include "common/models/content_hash.hpp"
#include "common/models/modal_shell/precompute.hpp"
#include "common/scene/ensure_archive.hpp"
#include "common/scene/find_archive.hpp"
#include "common/shell/assembly.hpp"
#include "common/shell/boundary_conditions.hpp"
#include "tests/tensors/files_for_tests.hpp"

namespace palpate {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;
using testing::make_modal_archive;
using testing::TemporaryFolder;

TEST(ModalArchive, ReadsBackWhatWasWritten) {
  const TemporaryFolder folder;
  const auto archive = make_modal_archive(20, 8, 6);
  write_archive(archive, folder / "a.h5");
  EXPECT_TRUE(testing::same(read_archive(folder / "a.h5", ArchivePart::surface, {}), archive));
}

TEST(ModalArchive, TheHeaderHasFrequenciesAndTheTouchablePartHasShapes) {
  const TemporaryFolder folder;
  const auto archive = make_modal_archive(20, 8, 6);
  write_archive(archive, folder / "a.h5");
  const auto header = read_archive(folder / "a.h5", ArchivePart::header, {});
  EXPECT_EQ(header.modal->omega, archive.modal->omega);
  EXPECT_EQ(header.modal->thickness, archive.modal->thickness);
  EXPECT_EQ(header.modal->mass, archive.modal->mass);
  EXPECT_TRUE(header.modal->shape.empty());
  const auto touchable = read_archive(folder / "a.h5", ArchivePart::touchable, {});
  EXPECT_EQ(touchable.modal, archive.modal);
  EXPECT_TRUE(touchable.other_compliance.empty());
}

TEST(ModalArchive, AFlippedModeIsNamed) {
  const TemporaryFolder folder;
  const auto archive = make_modal_archive(20, 8, 6);
  write_archive(archive, folder / "a.h5");
  auto bytes = testing::read_bytes(folder / "a.h5");
  const auto* values = reinterpret_cast<const char*>(archive.modal->shape.data());
  const auto place = std::search(bytes.begin(), bytes.end(), values, values + 64);
  ASSERT_NE(place, bytes.end());
  place[17] ^= 4;
  testing::write_bytes(folder / "a.h5", bytes, bytes.size());
  EXPECT_NE(testing::refusal(folder / "a.h5").find("damaged: 'modal/shape' fails its checksum"), std::string::npos);
  EXPECT_EQ(testing::refusal(folder / "a.h5", ArchivePart::header), "");
}

TEST(ModalArchive, PartsThatDoNotFitTogetherAreRefused) {
  const TemporaryFolder folder;
  const std::vector<std::function<void(Archive&)>> damages{
      [](Archive& a) { a.modal->mass.pop_back(); },
      [](Archive& a) { a.modal->shape.resize(a.modal->shape.size() - 84); },
      [](Archive& a) { std::swap(a.modal->omega[0], a.modal->omega[1]); },
      [](Archive& a) { a.modal->omega[0] = 0; },
      [](Archive& a) { a.modal.reset(); },
      [](Archive& a) { a.parts.modal = false; },
  };
  for (const auto& damage : damages) {
    auto archive = make_modal_archive(20, 8, 6);
    damage(archive);
    write_archive(archive, folder / "a.h5");
    EXPECT_NE(testing::refusal(folder / "a.h5").find("damaged"), std::string::npos);
  }
}

/// A short clamped duct, 60 free nodes.
ModalShellSpec duct_body() {
  ModalShellSpec body;
  body.name = "duct";
  body.material = {1e5, 0.45, 1050};
  ShellBoundaryCondition end;
  end.where.group = "end0";
  body.fixed = {end};
  body.shell.thickness = 8e-4;
  body.shell.modes = 30;
  return body;
}

ShellMesh duct_mesh() {
  return make_tube(0.0045, 0.03, 12, 5);
}

/// K^-1 among translations, with no moments.
MatrixXd dense_compliance(const ShellSpec& body, const ShellMesh& mesh, const ShellDofs& dofs) {
  const ShellMaterial material{body.material.young, body.material.poisson, body.material.density, body.shell.thickness};
  const MatrixXd lower(assemble_shell_stiffness(mesh, material, Bending::discrete_kirchhoff, dofs, "test"));
  const MatrixXd whole = lower.selfadjointView<Eigen::Lower>();
  return invert_general(whole).topLeftCorner(dofs.translations(), dofs.translations());
}

TEST(ModalArchive, HoldsTheComplianceOfTheTranslationsAndTheModesOfTheShell) {
  const auto body = duct_body();
  const auto mesh = duct_mesh();
  const auto archive = precompute(body, mesh);
  const auto dofs = apply_boundary_conditions(mesh, body, "test");
  const MatrixXd expected = dense_compliance(body, mesh, dofs);
  const Compliance<double> compliance(archive, Compliance<double>::Rows::surface);
  const auto& surface = archive.surface;
  ASSERT_EQ(surface.size(), 72);
  ASSERT_EQ(surface.touchable, 60);
  const double scale = expected.cwiseAbs().maxCoeff();
  for (int i = 0; i < surface.size(); ++i)
    for (int j = 0; j < surface.touchable; ++j)
      for (int a = 0; a < 3; ++a)
        for (int b = 0; b < 3; ++b) {
          const int row = dofs.index(surface.node_number[i], a), column = dofs.index(surface.node_number[j], b);
          ASSERT_NEAR(compliance.column(j, b)[3 * i + a], row < 0 ? 0 : expected(row, column), 1e-9 * scale);
        }

  const ModalTensors& modal = *archive.modal;
  const Eigen::Map<const MatrixXd> shape(modal.shape.data(), 3 * surface.size(), modal.modes());
  VectorXd mass(3 * surface.size());
  for (int i = 0; i < mass.size(); ++i) mass[i] = modal.mass[i / 3];
  ASSERT_EQ(modal.modes(), 30);
  EXPECT_EQ(modal.thickness, 8e-4);
  EXPECT_LT((shape.transpose() * mass.asDiagonal() * shape - MatrixXd::Identity(30, 30)).cwiseAbs().maxCoeff(), 1e-10);
  EXPECT_EQ(shape.bottomRows(3 * 12).norm(), 0);  // the clamped ring
  // C M phi = phi / omega^2, the modes' rows and the compliance's being in one order.
  for (int m = 0; m < modal.modes(); ++m) {
    const VectorXd inertia = mass.cwiseProduct(shape.col(m));
    VectorXd answer = VectorXd::Zero(mass.size());
    for (int j = 0; j < 3 * surface.touchable; ++j)
      answer += inertia[j] * Eigen::Map<const VectorXd>(compliance.column(j / 3, j % 3), mass.size());
    EXPECT_LT((modal.omega[m] * modal.omega[m] * answer - shape.col(m)).norm(), 1e-7 * shape.col(m).norm()) << m;
  }
}

TEST(ModalArchive, TheResidualFlexibilityIsSemidefinite) {
  const auto archive = precompute(duct_body(), duct_mesh());
  const int t = 3 * archive.surface.touchable;
  const Compliance<double> compliance(archive, Compliance<double>::Rows::touchable);
  const Eigen::Map<const MatrixXd> shape(archive.modal->shape.data(), 3 * archive.surface.size(),
                                         archive.modal->modes());
  MatrixXd residual(t, t);
  for (int j = 0; j < t; ++j) residual.col(j) = Eigen::Map<const VectorXd>(compliance.column(j / 3, j % 3), t);
  const double largest = residual.diagonal().maxCoeff();
  for (int m = 0; m < archive.modal->modes(); ++m)
    residual -= shape.col(m).head(t) * shape.col(m).head(t).transpose() / std::pow(archive.modal->omega[m], 2);
  EXPECT_GT(symmetric_eigenvalues(residual).minCoeff(), -1e-9 * largest);
  EXPECT_GT(residual.diagonal().minCoeff(), 0);
}

TEST(ModalArchive, TouchableNodesComeFirstAndUnusedNodesAreLeftOut) {
  auto mesh = duct_mesh();
  mesh.nodes.insert(mesh.nodes.begin(), {1, 1, 1});  // used by no triangle
  for (auto& t : mesh.triangles)
    for (int& node : t) ++node;
  for (auto& [name, group] : mesh.groups)
    for (int& node : group.nodes) ++node;
  auto body = duct_body();
  body.touchable = NodeSelector{{{}, Box{{-1, -1, 0.02}, {1, 0, 1}}, ""}};
  body.fixed[0].axes = {true, true, true};
  const auto archive = precompute(body, mesh);
  const auto& surface = archive.surface;
  EXPECT_EQ(archive.mesh_nodes, 73);
  EXPECT_EQ(surface.size(), 72);
  ASSERT_GT(surface.touchable, 0);
  ASSERT_LT(surface.touchable, 40);
  for (int i = 0; i < surface.size(); ++i) {
    const int node = surface.node_number[i];
    EXPECT_GT(node, 0);
    EXPECT_EQ(surface.position[i], mesh.nodes[node]);
    EXPECT_EQ(i < surface.touchable, surface.position[i][2] >= 0.02 && surface.position[i][1] <= 0);
    const bool group_begins = i == 0 || i == surface.touchable;
    EXPECT_TRUE(group_begins || surface.node_number[i - 1] < node) << i;
  }
  EXPECT_EQ(archive.other_compliance.size(), archive.other_dofs.size() * archive.touchable_dofs.size());
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    for (int k = 0; k < 3; ++k) EXPECT_EQ(surface.node_number[surface.triangles[t][k]], mesh.triangles[t][k]);

  const auto all = precompute(duct_body(), duct_mesh());
  const Compliance<double> some(archive, Compliance<double>::Rows::surface),
      whole(all, Compliance<double>::Rows::surface);
  for (int j = 0; j < surface.touchable; ++j)
    for (int i = 0; i < surface.size(); ++i) {
      const auto place = [&](int k) {
        const auto& numbers = all.surface.node_number;
        return static_cast<int>(std::find(numbers.begin(), numbers.end(), surface.node_number[k] - 1) -
                                numbers.begin());
      };
      EXPECT_NEAR(some.column(j, 1)[3 * i], whole.column(place(j), 1)[3 * place(i)],
                  1e-9 * whole.column(place(j), 1)[3 * place(j) + 1]);
    }
}

std::string refusal(const ModalShellSpec& body, const ShellMesh& mesh) {
  try {
    precompute(body, mesh);
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return "";
}

bool says_of_duct(const std::string& sentence, const std::string& part) {
  return sentence.find("body 'duct'") != std::string::npos && sentence.find(part) != std::string::npos;
}

TEST(ModalArchive, BadShellsAreRefusedInWords) {
  const auto mesh = duct_mesh();
  auto body = duct_body();
  body.shell.modes = 181;
  EXPECT_TRUE(says_of_duct(refusal(body, mesh), "181 modes")) << refusal(body, mesh);
  EXPECT_TRUE(says_of_duct(refusal(body, mesh), "180 free")) << refusal(body, mesh);
  body.shell.modes = 180;
  EXPECT_EQ(refusal(body, mesh), "");
  body = duct_body();
  body.shell.thickness = 0.005;
  EXPECT_TRUE(says_of_duct(refusal(body, mesh), "thick")) << refusal(body, mesh);
  body = duct_body();
  body.fixed.clear();
  EXPECT_TRUE(says_of_duct(refusal(body, mesh), "unfixed")) << refusal(body, mesh);
  body = duct_body();
  body.touchable = NodeSelector{{{}, {}, "end0"}};
  EXPECT_TRUE(says_of_duct(refusal(body, mesh), "selects no free node")) << refusal(body, mesh);
}

class ShellFiles : public ::testing::Test {
 protected:
  ShellFiles() {
    unsetenv("PALPATE_CACHE");
    write_shell_mesh(duct_mesh(), folder / "duct.msh");
    scene.file = folder / "scene.toml";
    auto body = duct_body();
    body.mesh = folder / "duct.msh";
    scene.bodies = {body};
  }
  const Body& body() const { return scene.bodies[0]; }
  const ModalShellSpec& shell() const { return std::get<ModalShellSpec>(body()); }
  std::string with(const std::function<void(ModalShellSpec&)>& change) const {
    ModalShellSpec changed = shell();
    change(changed);
    return content_hash(changed);
  }

  TemporaryFolder folder;
  Scene scene;
};

TEST_F(ShellFiles, TheArchiveIsComputedOnceAndFound) {
  const auto first = ensure_archive(scene, body());
  EXPECT_FALSE(first.up_to_date);
  EXPECT_TRUE(ensure_archive(scene, body()).up_to_date);
  EXPECT_EQ(archive_path(body()), first.file);
  const auto archive = find_archive(scene, body(), ArchivePart::surface);
  auto expected = precompute(shell(), load_shell_mesh(shell().mesh, 1));
  expected.content_hash = content_hash(body());
  EXPECT_TRUE(testing::same(archive, expected));
}

TEST_F(ShellFiles, TheContentHashCoversWhatChangesAStoredNumber) {
  const std::vector<std::function<void(ModalShellSpec&)>> changes{
      [](ModalShellSpec&) {},
      [](ModalShellSpec& b) { b.shell.thickness = 9e-4; },
      [](ModalShellSpec& b) { b.shell.bending = Bending::polynomial; },
      [](ModalShellSpec& b) { b.shell.modes = 31; },
      [](ModalShellSpec& b) { b.material.density = 1000; },
      [](ModalShellSpec& b) { b.material.young = 2e5; },
      [](ModalShellSpec& b) { b.fixed[0].rotations = false; },
      [](ModalShellSpec& b) { b.fixed[0].axes[1] = false; },
  };
  QuasiStaticSpec solid;
  static_cast<MeshedSpec&>(solid) = shell();
  solid.fixed = {shell().fixed[0]};
  std::set<std::string> hashes{content_hash(solid)};
  for (const auto& change : changes) hashes.insert(with(change));
  EXPECT_EQ(hashes.size(), changes.size() + 1);
}

TEST_F(ShellFiles, TheContentHashLeavesOutDampingAndResidual) {
  const auto original = content_hash(body());
  EXPECT_EQ(with([](ModalShellSpec& b) { b.shell.damping_ratio = 0.5; }), original);
  EXPECT_EQ(with([](ModalShellSpec& b) { b.shell.damping = 3; }), original);
  EXPECT_EQ(with([](ModalShellSpec& b) { b.shell.residual = false; }), original);
  EXPECT_EQ(with([](ModalShellSpec& b) { b.name = "other"; }), original);
}

TEST_F(ShellFiles, AClosedEndIsRefusedWhereACatheterIsLedInAlone) {
  ShellMesh cup = duct_mesh();
  cup.nodes.push_back({0, 0, 0});
  for (int j = 0; j < 12; ++j) cup.triangles.push_back({static_cast<int>(cup.nodes.size()) - 1, (j + 1) % 12, j});
  write_shell_mesh(cup, folder / "duct.msh");
  CatheterSpec wire;
  wire.name = "wire";
  wire.catheter.inside = "duct";
  scene.bodies.push_back(wire);
  std::string sentence;
  try {
    ensure_archive(scene, body());
  } catch (const std::runtime_error& error) {
    sentence = error.what();
  }
  EXPECT_NE(sentence.find("and the surface has 1 boundary line"), std::string::npos) << sentence;
  as<CatheterSpec>(scene.bodies[1])->catheter.inside.clear();
  EXPECT_FALSE(ensure_archive(scene, body()).up_to_date);
}

/// A straight catheter from the origin to x = 0.1 m.
CatheterSpec catheter_body() {
  CatheterSpec body;
  body.name = "catheter";
  body.material = {1e6, 0.45, 1100};
  body.catheter.tip = {0.1, 0, 0};
  return body;
}

TEST(CatheterArchive, IsTheTubeAtRestAndNeedsNoFile) {
  Scene scene;
  scene.bodies = {catheter_body()};
  const auto state = ensure_archive(scene, scene.bodies[0]);
  EXPECT_TRUE(state.up_to_date);
  EXPECT_TRUE(state.file.empty());
  EXPECT_TRUE(archive_path(scene.bodies[0]).empty());
  const auto archive = load_or_precompute(scene, ArchivePart::surface)[0];
  EXPECT_EQ(archive.model, "catheter");
  EXPECT_EQ(archive.content_hash, content_hash(scene.bodies[0]));
  EXPECT_EQ(archive.surface.touchable, 0);
  ASSERT_GT(archive.surface.size(), 100);
  ASSERT_FALSE(archive.surface.triangles.empty());
  double enclosed = 0;
  for (const auto& [a, b, c] : archive.surface.triangles) {
    const auto& p = archive.surface.position;
    enclosed += p[a].dot(p[b].cross(p[c])) / 6;
  }
  const double radius = catheter_body().catheter.radius, ball = 4.0 / 3 * M_PI * std::pow(radius, 3);
  EXPECT_NEAR(enclosed, M_PI * radius * radius * 0.1 + ball, 0.06 * M_PI * radius * radius * 0.1);
  for (const auto& p : archive.surface.position) {
    const double along = std::clamp(p[0], 0.0, 0.1);
    EXPECT_NEAR((p - Eigen::Vector3d(along, 0, 0)).norm(), radius, 1e-6);
  }
}

TEST(CatheterArchive, TheContentHashCoversItsRestShapeAlone) {
  const auto original = content_hash(catheter_body());
  const auto with = [](const std::function<void(CatheterSpec&)>& change) {
    auto body = catheter_body();
    change(body);
    return content_hash(body);
  };
  std::set<std::string> hashes{original, with([](CatheterSpec& b) { b.catheter.tail[1] = 0.01; }),
                               with([](CatheterSpec& b) { b.catheter.tip[0] = 0.2; }),
                               with([](CatheterSpec& b) { b.catheter.radius = 0.001; }),
                               with([](CatheterSpec& b) { b.catheter.particles = 61; })};
  EXPECT_EQ(hashes.size(), 5u);
  EXPECT_EQ(with([](CatheterSpec& b) { b.catheter.damping = 1; }), original);
  EXPECT_EQ(with([](CatheterSpec& b) { b.material.young = 1; }), original);
}

}  // namespace
}  // namespace palpate
