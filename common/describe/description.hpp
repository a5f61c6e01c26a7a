#pragma once
#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cstddef>
#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "common/describe/range.hpp"
#include "common/describe/words.hpp"

namespace palpate {

enum class Need { optional, required };

/// Who depends on a value: what is stored in an archive (`inertia`: in that of a body that has inertia) goes into its
/// content hash; what the nodes of one system must agree on, and what is stored, into the scene's hash.
enum class Use { agreed, stored, inertia, local };

/// What is said of one key of a table.
struct Key {
  std::string_view name;
  std::string_view unit;     ///< "Pa"; empty for what has none
  std::string_view meaning;  ///< one line, for the reference
  Need need = Need::optional;
  Use use = Use::agreed;
  std::string_view fallback = {};  ///< for the reference, where the default is no value: "the body's"
};

/// Box whose sides are along the axes [m], world frame.
struct Box {
  Eigen::Vector3d min, max;
};

/// A visitor over the fields of a spec. Each spec has one function `describe(Description&, Spec&)` that names its keys
/// in order; reading a scene file, writing it, hashing it, its list of keys and its reference are Descriptions. Values
/// hold their defaults when a reader comes.
class Description {
 public:
  virtual ~Description() = default;

  virtual void number(const Key& key, double& value, const Range& range) = 0;
  /// Non-empty list, each of the numbers within the range.
  virtual void numbers(const Key& key, std::vector<double>& value, const Range& range) = 0;
  virtual void integer(const Key& key, int& value, int low, int high) = 0;
  virtual void flag(const Key& key, bool& value) = 0;
  virtual void text(const Key& key, std::string& value) = 0;
  /// 1 to 31 letters, digits, '_' or '-': serves in file names and messages.
  virtual void name(const Key& key, std::string& value) = 0;
  virtual void texts(const Key& key, std::vector<std::string>& value) = 0;
  virtual void choice(const Key& key, std::string& value, std::span<const std::string_view> allowed) = 0;
  virtual void vector(const Key& key, Eigen::Vector3d& value) = 0;
  /// Red, green and blue between 0 and 1.
  virtual void colour(const Key& key, std::array<double, 3>& value) = 0;
  /// A direction of length one, made so from any length but zero.
  virtual void direction(const Key& key, Eigen::Vector3d& value) = 0;
  virtual void box(const Key& key, std::optional<Box>& value) = 0;
  /// Letters of x, y and z, each once at most.
  virtual void axes(const Key& key, std::array<bool, 3>& value) = 0;
  /// Non-empty list of different numbers, 0 or greater.
  virtual void indices(const Key& key, std::vector<int>& value) = 0;
  /// A physical group: its name, or its number, which becomes text.
  virtual void group(const Key& key, std::string& value) = 0;
  /// Path relative to the scene file, made absolute.
  virtual void path(const Key& key, std::filesystem::path& value) = 0;
  /// The same, of a file that exists. Hashes see what is in it, not where it is.
  virtual void file(const Key& key, std::filesystem::path& value) = 0;

  /// One of the words of an enumeration.
  template <Choice E>
  void choice(const Key& key, E& value) {
    std::string word(word_of(value));
    choice(key, word, words_of(value));
    value = value_of<E>(word);
  }

  /// A table that may be absent.
  template <class Spec>
  void table(const Key& key, std::optional<Spec>& value);
  /// A table that stands for its defaults where it is absent.
  template <class Spec>
  void table(const Key& key, Spec& value);
  template <class Spec>
  void tables(const Key& key, std::vector<Spec>& value, const Spec& fresh = {});
  /// The key's text says which alternative it is, by its `kind`; its keys stand in the same table.
  template <class... Spec>
  void variant(const Key& key, std::variant<Spec...>& value);

  /// Tables with names, as name_of(spec) gives them, which must differ. `noun`: what a person calls one.
  template <class Spec>
  void named_tables(const Key& key, std::string_view noun, std::vector<Spec>& value);

  /// What holds between keys: a reader refuses what is not `good`, at the place of `path`, which leads from the table
  /// that is being read to a key by keys and positions in lists, "body.2.catheter.inside"; as far as it exists.
  virtual void require(bool /*good*/, std::string_view /*path*/, std::string_view /*sentence*/) {}
  /// Whether the table that is being read holds the key; true for all but readers.
  virtual bool given(std::string_view /*key*/) const { return true; }
  /// `key` means nothing without `other`: a reader refuses it, a writer leaves it out.
  virtual void only_with(std::string_view /*key*/, std::string_view /*other*/) {}
  /// Whether values become text that is to be read again.
  virtual bool writes() const { return false; }

 protected:
  /// Steps into a table, false if there is none: then leave() is not called.
  virtual bool enter(const Key& key, bool present, bool optional) = 0;
  virtual void leave() = 0;
  /// The number of tables in a list of `count`, into each of which enter_item() steps.
  virtual std::size_t enter_list(const Key& key, std::size_t count) = 0;
  virtual void enter_item(const Key& key, std::size_t index) = 0;
  /// Which alternative; `current` is the one that the value holds.
  virtual std::size_t alternative(const Key& key, std::span<const std::string_view> kinds, std::size_t current) = 0;
  /// True for those that want to see all of them, one after another.
  virtual bool wants_every_alternative() const { return false; }
  virtual void begin_alternative(const Key& /*key*/, std::string_view /*kind*/) {}
  virtual void end_alternative() {}
  /// Called by variant() once it is known which alternative it is; readers refuse the keys of the others, which
  /// `describe_one(d, i)` tells.
  using DescribeOne = std::function<void(Description&, std::size_t)>;
  virtual void chosen(const Key& /*key*/, std::span<const std::string_view> /*kinds*/, std::size_t /*index*/,
                      const DescribeOne& /*describe_one*/) {}
};

template <class Spec>
void Description::table(const Key& key, std::optional<Spec>& value) {
  const bool present = enter(key, value.has_value(), true);
  if (!present) return;
  if (!value) value.emplace();
  describe(*this, *value);
  leave();
}

template <class Spec>
void Description::table(const Key& key, Spec& value) {
  if (!enter(key, true, false)) return;
  describe(*this, value);
  leave();
}

template <class Spec>
void Description::tables(const Key& key, std::vector<Spec>& value, const Spec& fresh) {
  value.resize(enter_list(key, value.size()), fresh);
  for (std::size_t i = 0; i < value.size(); ++i) {
    enter_item(key, i);
    describe(*this, value[i]);
    leave();
  }
}

namespace detail {

template <class Variant, std::size_t... i>
void emplace_at(Variant& value, std::size_t index, std::index_sequence<i...>) {
  ((index == i && (value.template emplace<i>(), true)) || ...);
}

/// Makes `value` hold a fresh alternative `index`.
template <class... Spec>
void hold(std::variant<Spec...>& value, std::size_t index) {
  emplace_at(value, index, std::index_sequence_for<Spec...>{});
}

}  // namespace detail

template <class Spec>
void Description::named_tables(const Key& key, std::string_view noun, std::vector<Spec>& value) {
  value.resize(enter_list(key, value.size()));
  for (std::size_t i = 0; i < value.size(); ++i) {
    enter_item(key, i);
    describe(*this, value[i]);
    const std::string& name = name_of(value[i]);
    const auto earlier = std::span(value).first(i);
    const bool fresh = std::ranges::none_of(earlier, [&](const Spec& other) { return name_of(other) == name; });
    require(fresh, "name", "a second " + std::string(noun) + " is named '" + name + "'");
    leave();
  }
}

template <class... Spec>
void Description::variant(const Key& key, std::variant<Spec...>& value) {
  static constexpr std::array<std::string_view, sizeof...(Spec)> kinds{Spec::kKind...};
  const auto describe_one = [](Description& description, std::size_t index) {
    std::variant<Spec...> fresh;
    detail::hold(fresh, index);
    std::visit([&](auto& spec) { describe(description, spec); }, fresh);
  };
  const std::size_t index = alternative(key, kinds, value.index());
  if (wants_every_alternative()) {
    for (std::size_t i = 0; i < kinds.size(); ++i) {
      begin_alternative(key, kinds[i]);
      describe_one(*this, i);
      end_alternative();
    }
    return;
  }
  if (index != value.index()) detail::hold(value, index);
  chosen(key, kinds, index, describe_one);
  std::visit([&](auto& spec) { describe(*this, spec); }, value);
  end_alternative();
}

}  // namespace palpate
