#include "common/sim/deformer.hpp"

#include <gtest/gtest.h>

#include "common/archive/compliance.hpp"
#include "common/bus/memory_bus.hpp"
#include "common/node/contact_feed.hpp"
#include "tests/models/duct_scene.hpp"

namespace palpate {
namespace {

using namespace testing;

/// u = Phi X' + C f in double precision, from the archive alone.
std::vector<Eigen::Vector3d> reference(const Archive& archive, const ModalState& state) {
  const Compliance<double> compliance(archive, Compliance<double>::Rows::surface);
  const int n = archive.surface.size();
  std::vector<Eigen::Vector3d> u(n, Eigen::Vector3d::Zero());
  for (int row = 0; row < 3 * n; ++row) {
    double& sum = u[row / 3][row % 3];
    for (std::size_t m = 0; m < state.coordinates.size(); ++m)
      sum += archive.modal->shape[3 * n * m + row] * state.coordinates[m];
    for (const ShellForce& f : state.forces)
      for (int axis = 0; axis < 3; ++axis)
        sum += compliance.column(static_cast<int>(f.node), axis)[row] * f.force[axis];
  }
  return u;
}

bool at_rest(const Deformer& deformer, int body) {
  for (const Eigen::Vector3f& u : deformer.surface(body).displacement)
    if (u.norm() > 1e-7f) return false;
  return true;
}

TEST(Deformer, RebuildsAModalShellLikeDoublePrecision) {
  const DuctScene s;
  Deformer deformer(s.scene, s.archives);
  EXPECT_TRUE(at_rest(deformer, kDuctBody));
  const ModalState state = s.modal_state();
  ASSERT_TRUE(deformer.take(state));
  EXPECT_TRUE(deformer.fresh());
  deformer.deform();
  EXPECT_FALSE(deformer.fresh());
  const std::vector<Eigen::Vector3d> expected = reference(s.archives[kDuctBody], state);
  double largest = 0, error = 0;
  for (std::size_t n = 0; n < expected.size(); ++n) {
    largest = std::max(largest, expected[n].norm());
    error = std::max(error, (deformer.surface(kDuctBody).displacement[n].cast<double>() - expected[n]).norm());
    EXPECT_EQ(deformer.surface(kDuctBody).position[n],
              s.archives[kDuctBody].surface.position[n].cast<float>() + deformer.surface(kDuctBody).displacement[n]);
  }
  EXPECT_GT(largest, 1e-4);
  EXPECT_LT(error, 1e-5 * largest);
  EXPECT_EQ(deformer.run(), 5u);
  EXPECT_EQ(deformer.step(), 6u);
  EXPECT_EQ(deformer.sense_ns(), 900);
}

TEST(Deformer, WithoutForcesOnlyTheModesShow) {
  const DuctScene s;
  Deformer deformer(s.scene, s.archives);
  ModalState state = s.modal_state();
  state.forces.clear();
  std::fill(state.coordinates.begin(), state.coordinates.end(), 0.0);
  state.coordinates[3] = 1e-4;
  ASSERT_TRUE(deformer.take(state));
  deformer.deform();
  const auto& shape = s.archives[kDuctBody].modal->shape;
  const std::size_t rows = 3 * s.archives[kDuctBody].surface.position.size();
  for (std::size_t row = 0; row < rows; ++row)
    EXPECT_NEAR(deformer.surface(kDuctBody).displacement[row / 3][static_cast<int>(row % 3)],
                1e-4 * shape[3 * rows + row], 1e-9);
}

TEST(Deformer, DrawsACatheterAsATubeAboutItsParticles) {
  const DuctScene s;
  Deformer deformer(s.scene, s.archives);
  EXPECT_TRUE(at_rest(deformer, kCatheterBody));
  const CatheterState state = s.catheter_state(0.01, 5e-5);
  ASSERT_TRUE(deformer.take(state));
  deformer.deform();
  std::vector<Eigen::Vector3f> line;
  for (std::size_t i = 0; i < state.position.size(); i += 3)
    line.emplace_back(static_cast<float>(state.position[i]), static_cast<float>(state.position[i + 1]),
                      static_cast<float>(state.position[i + 2]));
  const auto distance = [&](const Eigen::Vector3f& p) {
    float least = 1;
    for (std::size_t i = 0; i + 1 < line.size(); ++i) {
      const Eigen::Vector3f edge = line[i + 1] - line[i];
      const float t = std::clamp((p - line[i]).dot(edge) / edge.squaredNorm(), 0.0f, 1.0f);
      least = std::min(least, (p - line[i] - t * edge).norm());
    }
    return least;
  };
  int on_wall = 0;
  for (const Eigen::Vector3f& p : deformer.surface(kCatheterBody).position) {
    EXPECT_LT(distance(p), 0.00125f * 1.1f);
    on_wall += distance(p) > 0.00125f * 0.9f;
  }
  EXPECT_GT(on_wall, 10 * DuctScene::kParticles);
  for (const Eigen::Vector3f& n : deformer.surface(kCatheterBody).normal) EXPECT_NEAR(n.norm(), 1, 1e-4);
}

TEST(Deformer, RefusesWhatDoesNotFitAndKeepsNothingOfIt) {
  const DuctScene s;
  Deformer deformer(s.scene, s.archives);
  const auto modal = [&](auto&& change) {
    ModalState state = s.modal_state();
    change(state);
    return deformer.take(state);
  };
  const auto surface = static_cast<std::uint32_t>(s.archives[kDuctBody].surface.size());
  EXPECT_FALSE(modal([](ModalState& m) { m.body = 3; }));
  EXPECT_FALSE(modal([](ModalState& m) { m.body = kOrganBody; }));
  EXPECT_FALSE(modal([](ModalState& m) { m.body = kCatheterBody; }));
  EXPECT_FALSE(modal([](ModalState& m) { m.coordinates.pop_back(); }));
  EXPECT_FALSE(modal([](ModalState& m) { m.coordinates.push_back(0); }));
  EXPECT_FALSE(modal([&](ModalState& m) { m.forces[2].node = surface; }));
  const auto catheter = [&](auto&& change) {
    CatheterState state = s.catheter_state(0.01);
    change(state);
    return deformer.take(state);
  };
  EXPECT_FALSE(catheter([](CatheterState& m) { m.body = kDuctBody; }));
  EXPECT_FALSE(catheter([](CatheterState& m) { m.body = 9; }));
  EXPECT_FALSE(catheter([](CatheterState& m) { m.position.resize(m.position.size() - 3); }));
  ContactState contacts{.run = 5};
  contacts.forces.push_back({kDuctBody, surface, {1, 0, 0}});
  EXPECT_FALSE(deformer.take(contacts));
  const auto organ = static_cast<std::uint32_t>(s.archives[kOrganBody].surface.size());
  for (const HeldContact& held : {HeldContact{.body = 9}, HeldContact{.body = kOrganBody, .nodes = {0, 0, organ}}}) {
    ContactState state{.run = 5};
    state.contacts.push_back(held);
    EXPECT_FALSE(deformer.take(state));
  }
  for (const std::uint32_t tool : {1u, 1u << 31}) EXPECT_FALSE(deformer.take(ContactState{.tool = tool, .run = 5}));
  EXPECT_EQ(deformer.run(), 0u);
  EXPECT_FALSE(deformer.fresh());
  EXPECT_TRUE(deformer.contacts().empty());
}

TEST(Deformer, NodalForcesOfContactsShapeQuasiStaticBodiesAlone) {
  const DuctScene s;
  Deformer deformer(s.scene, s.archives);
  ContactState contacts{.run = 5, .seq = 1, .step = 9, .sense_ns = 1100, .press = {0, 0, 1}};
  contacts.forces.push_back({kOrganBody, 1, {0, 0, 2}});
  contacts.forces.push_back({kDuctBody, 4, {0, 0, 2}});
  ASSERT_TRUE(deformer.take(contacts));
  deformer.deform();
  EXPECT_FALSE(at_rest(deformer, kOrganBody));
  EXPECT_TRUE(at_rest(deformer, kDuctBody));
  EXPECT_EQ(deformer.contacts().size(), 1u);
}

TEST(Deformer, LoadsOfThePastShapeABodyThatRelaxesAsForcesDo) {
  DuctScene s;
  CreepState past{.body = kOrganBody, .run = 5, .seq = 1, .step = 9, .sense_ns = 1100};
  past.loads = {{1, {0, 0, 2}}, {1, {0, 1, 0}}};
  Deformer elastic(s.scene, s.archives);
  EXPECT_FALSE(elastic.hears(past));
  EXPECT_FALSE(elastic.take(past)) << "it has no past";

  as<QuasiStaticSpec>(s.scene.bodies[kOrganBody])->relaxation = Relaxation{{1}, {0.5}};
  Deformer relaxing(s.scene, s.archives), forced(s.scene, s.archives);
  ASSERT_TRUE(relaxing.take(past));
  relaxing.deform();
  ContactState contacts{.run = 5, .seq = 1, .step = 9, .sense_ns = 1100};
  contacts.forces.push_back({kOrganBody, 1, {0, 1, 2}});
  ASSERT_TRUE(forced.take(contacts));
  forced.deform();
  EXPECT_FALSE(at_rest(relaxing, kOrganBody));
  const auto &u = relaxing.surface(kOrganBody).displacement, &expected = forced.surface(kOrganBody).displacement;
  for (std::size_t n = 0; n < u.size(); ++n) EXPECT_LT((u[n] - expected[n]).norm(), 1e-8) << n;

  past.loads[1].node = static_cast<std::uint32_t>(s.archives[kOrganBody].surface.size());
  EXPECT_FALSE(relaxing.take(past));
}

TEST(Deformer, ContactsAreNoNewsWhereNothingIsQuasiStatic) {
  DuctScene s;
  s.scene.bodies.erase(s.scene.bodies.begin());
  s.archives.erase(s.archives.begin());
  Deformer deformer(s.scene, s.archives);
  EXPECT_TRUE(deformer.take(ContactState{.run = 5, .seq = 1, .step = 9, .sense_ns = 1100}));
  EXPECT_EQ(deformer.contacts().size(), 1u);
  deformer.deform();
  ModalState state = s.modal_state();
  state.body = 0;
  ASSERT_TRUE(deformer.take(state));
  EXPECT_EQ(deformer.step(), 6u);  // not the contacts' 9: those are not in the picture
}

TEST(Deformer, OnlyWhatNewsCameOfIsRebuilt) {
  const DuctScene s;
  Deformer deformer(s.scene, s.archives);
  ASSERT_TRUE(deformer.take(s.modal_state()));
  deformer.deform();
  ASSERT_TRUE(deformer.take(s.catheter_state(0.01)));
  deformer.deform();
  EXPECT_FALSE(deformer.changed(kOrganBody));
  EXPECT_FALSE(deformer.changed(kDuctBody));
  EXPECT_TRUE(deformer.changed(kCatheterBody));
  EXPECT_FALSE(at_rest(deformer, kDuctBody));
}

TEST(Deformer, ShapesFollowTheNewestRun) {
  const DuctScene s;
  Deformer deformer(s.scene, s.archives);
  ModalState first = s.modal_state();
  ASSERT_TRUE(deformer.take(first));
  deformer.deform();
  CatheterState second = s.catheter_state(0.01);
  second.run = 6;
  second.step = 1;  // a new loop counts from the beginning
  second.sense_ns = 2000;
  ASSERT_TRUE(deformer.take(second));
  deformer.deform();
  EXPECT_TRUE(at_rest(deformer, kDuctBody));  // the new run has not said anything of it
  EXPECT_FALSE(at_rest(deformer, kCatheterBody));
  EXPECT_EQ(deformer.run(), 6u);
  EXPECT_EQ(deformer.step(), 1u);

  EXPECT_FALSE(deformer.take(first));  // late
  EXPECT_FALSE(deformer.fresh());
  EXPECT_EQ(deformer.run(), 6u);
  first.sense_ns = 3000;  // played again
  EXPECT_TRUE(deformer.take(first));
  deformer.deform();
  EXPECT_FALSE(at_rest(deformer, kDuctBody));
  EXPECT_TRUE(at_rest(deformer, kCatheterBody));
}

/// A haptic node with run 5, and a node that rebuilds.
struct Feeding {
  DuctScene s;
  std::shared_ptr<MemoryNetwork> network = make_memory_network();
  std::unique_ptr<Bus> haptic_bus = make_memory_bus(network), bus = make_memory_bus(network);
  Presence haptic{*haptic_bus, "haptic", 5, "scene", "archive"};
  Presence presence{*bus, "deform", 0, "scene", "archive"};
  std::unique_ptr<Writer<ModalState>> modes = haptic_bus->writer(topics::modal_state);
  std::unique_ptr<Writer<CatheterState>> catheters = haptic_bus->writer(topics::catheter_state);
  Feeding() { presence.watch(); }
};

TEST(ContactFeed, TakesReducedStatesOfTheSameScene) {
  Feeding f;
  Deformer deformer(f.s.scene, f.s.archives);
  ContactFeed feed(*f.bus, f.presence, deformer);
  EXPECT_FALSE(feed.take());
  ASSERT_TRUE(f.modes->write(f.s.modal_state()));
  ASSERT_TRUE(f.catheters->write(f.s.catheter_state(0.01)));
  EXPECT_TRUE(feed.take());
  deformer.deform();
  EXPECT_FALSE(at_rest(deformer, kDuctBody));
  EXPECT_FALSE(at_rest(deformer, kCatheterBody));
  EXPECT_FALSE(feed.take());

  ModalState foreign = f.s.modal_state();
  foreign.run = 77;
  ASSERT_TRUE(f.modes->write(foreign));
  EXPECT_FALSE(feed.take());
  EXPECT_EQ(feed.refused(), 1u);
  EXPECT_EQ(deformer.run(), 5u);
}

TEST(ContactFeed, AsksForNothingThatTheSceneDoesNotNeed) {
  Feeding f;
  f.s.scene.bodies.resize(1);
  f.s.archives.resize(1);
  Deformer organ(f.s.scene, f.s.archives);
  const ContactFeed feed(*f.bus, f.presence, organ);
  EXPECT_EQ(f.modes->readers(), 0);
  EXPECT_EQ(f.catheters->readers(), 0);
  const DuctScene whole;
  Deformer all(whole.scene, whole.archives);
  const ContactFeed feed_of_all(*f.bus, f.presence, all);
  EXPECT_EQ(f.modes->readers(), 1);
  EXPECT_EQ(f.catheters->readers(), 1);
}

TEST(ContactFeed, HandsOnTheContactsOfAHapticNodeThatFellSilentThoughAStrangerWrites) {
  Feeding f;
  Deformer deformer(f.s.scene, f.s.archives);
  ContactFeed feed(*f.bus, f.presence, deformer);
  auto contacts = f.haptic_bus->writer(topics::contact_state);
  const auto stranger_bus = make_memory_bus(f.network);
  const auto stranger = stranger_bus->writer(topics::contact_state);
  const auto held = stranger_bus->reader(topics::held_contacts);
  ContactState state{.tool = 0, .run = 5, .seq = 1, .step = 6, .sense_ns = 900};
  state.contacts.emplace_back();
  ASSERT_TRUE(contacts->write(state));
  ContactState foreign = state;
  foreign.run = 77, foreign.tool = 1;  // of the same tool it would hide the true one
  std::int64_t now = 1'000'000'000;
  const auto look = [&] {
    ASSERT_TRUE(stranger->write(foreign));
    feed.take();
    feed.watch_haptic(now += 50'000'000);
  };
  for (int k = 0; k < 3; ++k) look();
  EXPECT_FALSE(held->take()) << "it may only be slow";
  contacts.reset();
  for (int k = 0; k < 5; ++k) look();
  const auto handed_on = held->take();
  ASSERT_TRUE(handed_on);
  EXPECT_EQ(handed_on->run, 5u);
  EXPECT_FALSE(held->take()) << "once";
}

TEST(ContactFeed, ANodeThatComesBackShowsTheShapeAgainWithTheNextMessage) {
  Feeding f;
  for (int life = 0; life < 2; ++life) {
    Deformer deformer(f.s.scene, f.s.archives);
    ContactFeed feed(*f.bus, f.presence, deformer);
    EXPECT_FALSE(feed.take());
    EXPECT_TRUE(at_rest(deformer, kDuctBody));
    EXPECT_EQ(deformer.run(), 0u);
    ASSERT_TRUE(f.modes->write(f.s.modal_state()));
    EXPECT_TRUE(feed.take());
    deformer.deform();
    EXPECT_FALSE(at_rest(deformer, kDuctBody));
  }
}

}  // namespace
}  // namespace palpate
