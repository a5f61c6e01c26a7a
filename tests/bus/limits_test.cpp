#include "idl/limits.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "common/bus/field_kinds.hpp"
#include "idl/fields.hpp"
#include "tests/bus/messages_for_tests.hpp"

/// No message with a number that nobody can reckon with is valid, wherever in the message it stands.
namespace palpate {
namespace {

using namespace palpate::testing;

template <class T>
using Of = std::numeric_limits<T>;

/// Spoils each number of a part of the message, one after the other. Counts them.
template <class M>
struct Spoiler {
  M& message;
  int spoiled = 0;

  template <class T>
  void try_values(const char* name, T& field, std::initializer_list<T> values) {
    const T good = field;
    for (const T value : values) {
      field = value;
      EXPECT_FALSE(valid(message)) << name_of(&message) << " with " << name << " " << value;
    }
    field = good;
    ++spoiled;
  }
  template <class T>
  void operator()(const char* name, T& field) {
    if constexpr (std::is_floating_point_v<T>) {
      try_values(name, field, {Of<T>::quiet_NaN(), Of<T>::infinity(), -Of<T>::infinity()});
    } else if constexpr (std::same_as<T, std::int64_t>) {
      try_values(name, field, {Of<T>::min(), Of<T>::max()});
    } else if constexpr (is_vector<T> || is_array<T>) {
      for (auto& element : field) (*this)(name, element);
    } else if constexpr (std::is_class_v<T> && !std::same_as<T, std::string>) {
      fields(*this, field);
    }
  }
};

TEST(Limits, EveryNumberThatIsNotFiniteAndEveryTimeBeyondItsBoundIsRefused) {
  for_each_message([]<class M>(M message) {
    ASSERT_TRUE(valid(message)) << name_of(&message);
    Spoiler<M> spoiler{message};
    fields(spoiler, message);
    EXPECT_GT(spoiler.spoiled, 0) << name_of(&message);
    EXPECT_TRUE(valid(message)) << name_of(&message);
  });
}

}  // namespace
}  // namespace palpate
