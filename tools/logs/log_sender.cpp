#include "tools/logs/log_sender.hpp"

#include <fmt/format.h>

#include <stdexcept>
#include <tuple>

#include "common/bus/topic_named.hpp"
#include "common/realtime/clock.hpp"

namespace palpate {
namespace {

template <class M>
struct Outlet {
  Topic<M> topic;
  std::unique_ptr<Writer<M>> writer;  ///< empty if the topic is not played
};

template <class... M>
auto make_outlets(Bus& bus, const std::tuple<Topic<M>...>& all, const std::set<std::string>& wanted) {
  return std::apply(
      [&](const auto&... topic) {
        return std::tuple{Outlet<M>{topic, wanted.contains(topic.name) ? bus.writer(topic) : nullptr}...};
      },
      all);
}

/// Moves the times inside a message that say when something happened.
template <class M>
void shift_times(M& message, std::int64_t by) {
  const auto shift = [by](std::int64_t& time) { time = time > 0 ? time + by : time; };
  if constexpr (requires { message.sense_ns; }) shift(message.sense_ns);
  if constexpr (requires { message.publish_ns; }) shift(message.publish_ns);
  if constexpr (requires { message.stamp_ns; }) shift(message.stamp_ns);
}

template <class M>
bool send_to(Outlet<M>& outlet, const LogEvent& event, std::int64_t now) {
  M message;
  if (!outlet.writer || !event.read(outlet.topic, message)) return false;
  shift_times(message, now - event.receive_ns);
  return outlet.writer->write(message);
}

}  // namespace

std::set<std::string> topics_in(const std::filesystem::path& log, const std::vector<std::string>& wanted) {
  std::set<std::string> chosen, found;
  for (const std::string& name : wanted) chosen.insert(topic_named(name));
  if (wanted.empty()) topics::for_each([&](const auto& topic) { chosen.insert(topic.name); });
  LogReader reader(log);
  LogEvent event;
  while (reader.next(event))
    if (chosen.contains(event.channel)) found.insert(event.channel);
  return found;
}

struct LogSender::Outlets {
  decltype(make_outlets(std::declval<Bus&>(), topics::all, {})) all;
};

LogSender::LogSender(Bus& bus, const std::set<std::string>& topics)
    : outlets_(new Outlets{make_outlets(bus, topics::all, topics)}) {}
LogSender::~LogSender() = default;

bool LogSender::wait_for_readers(std::chrono::nanoseconds patience) const {
  const auto heard = [](const auto&... o) { return ((!o.writer || o.writer->readers() > 0) && ...); };
  const std::int64_t end = now_ns() + patience.count();
  while (now_ns() < end && !std::apply(heard, outlets_->all)) sleep_until_ns(now_ns() + 10'000'000);
  return std::apply(heard, outlets_->all);
}

bool LogSender::send(const LogEvent& event, std::int64_t now) {
  bool sent = false;
  std::apply([&](auto&... outlet) { ((sent = sent || send_to(outlet, event, now)), ...); }, outlets_->all);
  return sent;
}

}  // namespace palpate
