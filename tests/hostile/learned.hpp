#pragma once
#include <optional>
#include <tuple>

#include "common/bus/bus.hpp"
#include "tests/bus/messages_for_tests.hpp"

namespace palpate::testing {

/// Listens to all topics and keeps what the real nodes said last: what an attacker begins with.
template <class... M>
class Learned {
 public:
  Learned(Bus& bus, const std::tuple<Topic<M>...>& all)
      : readers_(std::apply([&](const auto&... topic) { return std::tuple{bus.reader(topic)...}; }, all)) {}

  void take() {
    [&]<std::size_t... i>(std::index_sequence<i...>) {
      ((take_one(*std::get<i>(readers_), std::get<i>(newest_))), ...);
    }
    (std::index_sequence_for<M...>{});
  }
  /// Of the topic at this place in the table; a sample for tests, in the name of `run`, where nobody wrote any.
  template <std::size_t i>
  auto of(std::uint64_t run) const {
    using Message = std::tuple_element_t<i, std::tuple<M...>>;
    if (const auto& newest = std::get<i>(newest_)) return *newest;
    Message made;
    for_each_message([&]<class Sample>(const Sample& sample) {
      if constexpr (std::same_as<Sample, Message>)
        if (made == Message{}) made = sample;
    });
    if constexpr (requires { made.run; }) made.run = run;
    if constexpr (requires { made.tool; }) made.tool = 0;
    if constexpr (requires { made.body; }) made.body = 0;
    return made;
  }

 private:
  template <class Message>
  static void take_one(Reader<Message>& reader, std::optional<Message>& newest) {
    while (auto message = reader.take()) newest = std::move(*message);
  }

  std::tuple<std::unique_ptr<Reader<M>>...> readers_;
  std::tuple<std::optional<M>...> newest_;
};
template <class... M>
Learned(Bus&, const std::tuple<Topic<M>...>&) -> Learned<M...>;

}  // namespace palpate::testing
