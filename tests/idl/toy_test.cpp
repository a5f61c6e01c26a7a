#include <gtest/gtest.h>

#include <functional>
#include <limits>

#include "idl/checks.hpp"
#include "idl/fields.hpp"
#include "idl/limits.hpp"
#include "idl/topics.hpp"

/// The code that the generator writes for the toy, at work.
namespace palpate {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinite = std::numeric_limits<double>::infinity();

Dish dish() {
  Dish d{.name = "soup", .table = 4, .seq = 1, .weight = 0.5, .sauce = 0.5, .up = {0, 0.6, 0.8}, .complaint = late};
  d.rim = {1, 2, 3};
  d.tint = {1, 2, 3};
  d.peas.resize(2);
  d.forks = {{0, 1}};
  return d;
}

bool valid_with(const std::function<void(Dish&)>& change) {
  Dish d = dish();
  change(d);
  return valid(d);
}

TEST(ToyChecks, TakeWhatIsAtItsLimits) {
  EXPECT_TRUE(valid(dish()));
  EXPECT_TRUE(valid_with([](Dish& d) { d.table = 0; }));
  EXPECT_TRUE(valid_with([](Dish& d) { d.publish_ns = checks::kMaxTimeNs; }));
  EXPECT_TRUE(valid_with([](Dish& d) { d.publish_ns = -checks::kMaxTimeNs; }));
  EXPECT_TRUE(valid_with([](Dish& d) { d.weight = d.sauce = std::numeric_limits<double>::denorm_min(); }));
  EXPECT_TRUE(valid_with([](Dish& d) { d.sauce = -1; }));
  EXPECT_TRUE(valid_with([](Dish& d) { d.complaint = cold; }));
  EXPECT_TRUE(valid_with([](Dish& d) { d.note.assign(checks::kMaxText, 'x'); })) << "it is cut when it is sent";
  EXPECT_TRUE(valid_with([](Dish& d) { d.recipe.assign(checks::kMaxText, 'x'); }));
  EXPECT_TRUE(valid_with([](Dish& d) { d.stamp.resize(8); }));
  EXPECT_TRUE(valid_with([](Dish& d) { d.rim.resize(9), d.tint.resize(9); }));
  EXPECT_TRUE(valid_with([](Dish& d) { d.rim.clear(), d.tint.clear(); }));
  EXPECT_TRUE(valid_with([](Dish& d) { d.peas.resize(5); }));
  EXPECT_TRUE(valid_with([](Dish& d) { d.forks.resize(3); }));
}

TEST(ToyChecks, RefuseEachFieldBeyondItsLimits) {
  const std::function<void(Dish&)> changes[] = {
      [](Dish& d) { d.name.clear(); },
      [](Dish& d) { d.name.assign(checks::kMaxText + 1, 'x'); },
      [](Dish& d) { d.table = 5; },
      [](Dish& d) { d.seq = 0; },
      [](Dish& d) { d.publish_ns = checks::kMaxTimeNs + 1; },
      [](Dish& d) { d.publish_ns = std::numeric_limits<std::int64_t>::min(); },
      [](Dish& d) { d.weight = d.sauce = 0; },
      [](Dish& d) { d.weight = kInfinite; },
      [](Dish& d) { d.weight = kNan; },
      [](Dish& d) { d.sauce = -1.001; },
      [](Dish& d) { d.sauce = 0.501; },
      [](Dish& d) { d.sauce = kNan; },
      [](Dish& d) { d.warmth = std::numeric_limits<float>::infinity(); },
      [](Dish& d) {
        d.up = {0, 0, 1.001};
      },
      [](Dish& d) {
        d.up = {0, kNan, 1};
      },
      [](Dish& d) { d.complaint = 0; },
      [](Dish& d) { d.complaint = late + 1; },
      [](Dish& d) { d.courses_ns[1] = std::numeric_limits<std::int64_t>::max(); },
      [](Dish& d) { d.note.assign(checks::kMaxText + 1, 'x'); },
      [](Dish& d) { d.recipe.assign(checks::kMaxText + 1, 'x'); },
      [](Dish& d) { d.stamp.resize(9); },
      [](Dish& d) { d.rim.resize(2), d.tint.resize(2); },
      [](Dish& d) { d.rim.resize(12), d.tint.resize(12); },
      [](Dish& d) { d.rim[1] = kInfinite; },
      [](Dish& d) { d.tint.resize(2); },
      [](Dish& d) { d.tint[2] = std::numeric_limits<float>::quiet_NaN(); },
      [](Dish& d) { d.peas.resize(6); },
      [](Dish& d) { d.peas[1].centre[2] = kNan; },
      [](Dish& d) { d.forks.resize(4); },
      [](Dish& d) { d.forks[0].left = 2; },
      [](Dish& d) { d.forks[0].right = 2; },
  };
  for (const auto& change : changes) EXPECT_FALSE(valid_with(change)) << &change - changes;
}

TEST(ToyFields, AreVisitedInOrderAndTheKeysApart) {
  std::string names;
  Dish d = dish();
  fields([&](const char* name, auto&, const auto&) { names.append(name).append(" "); }, d, d);
  EXPECT_EQ(names,
            "name table seq publish_ns weight sauce warmth up corners complaint courses_ns note recipe stamp rim tint "
            "peas forks ");
  int keyed = 0;
  key_fields([&](const auto&) { ++keyed; }, d);
  EXPECT_EQ(keyed, 2);
  EXPECT_STREQ(name_of(&d), "Dish");
}

TEST(ToyTopics, HaveTheirRolesAsBits) {
  using namespace roles;
  EXPECT_EQ(topics::dish.writers, cook | waiter);
  EXPECT_EQ(topics::dish.readers, waiter | guest);
  EXPECT_EQ(topics::leftovers.writers, cook | waiter | guest);
  EXPECT_EQ(topics::leftovers.readers, 0u);
  EXPECT_EQ(topics::bill.qos.depth, kKeepAll);
  EXPECT_TRUE(topics::dish.qos.reliable && topics::dish.qos.transient_local);
  EXPECT_FALSE(topics::leftovers.qos.reliable);
  EXPECT_EQ(topics::leftovers.qos.recorder_depth, 9);
  EXPECT_STREQ(roles::names[2], "guest");
}

}  // namespace
}  // namespace palpate
