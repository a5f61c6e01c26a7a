#include "tools/mcap/export_mcap.hpp"

#include <fmt/format.h>

#include <map>
#include <stdexcept>

#include "common/bus/log_reader.hpp"
#include "common/bus/runs_at_once.hpp"
#include "common/realtime/shutdown.hpp"
#include "idl/topics.hpp"
#include "tools/mcap/cdr.hpp"
#include "tools/mcap/writer.hpp"

namespace palpate {
namespace {

class Export {
 public:
  Export(const LogReader& log, const std::filesystem::path& file)
      : to_1970_(log.header().start_wall_ns - log.header().start_monotonic_ns), writer_(file) {}

  void add(const LogEvent& event, const std::string& only) {
    topics::for_each([&]<class M>(const Topic<M>& topic) {
      if (event.channel == topic.name && (only.empty() || only == topic.name)) add(topic, event);
    });
  }
  void finish() { writer_.finish(); }
  std::uint64_t messages() const { return writer_.messages(); }

 private:
  template <class M>
  void add(const Topic<M>& topic, const LogEvent& event) {
    M message;
    if (!event.read(topic, message)) return;
    const auto [channel, is_new] = channels_.try_emplace(topic.name, std::uint16_t{0});
    if (is_new)
      channel->second =
          writer_.add_channel(topic.name, std::string("palpate::") + topic.message, "omgidl", cdr::idl<M>(), "cdr");
    std::int64_t publish_ns = event.receive_ns;
    if constexpr (requires { message.publish_ns; }) publish_ns = message.publish_ns;
    std::uint32_t sequence = 0;
    if constexpr (requires { message.seq; }) sequence = static_cast<std::uint32_t>(message.seq);
    cdr::encode(message, bytes_);
    writer_.write(channel->second, sequence, since_1970(event.receive_ns), since_1970(publish_ns), bytes_);
  }
  std::uint64_t since_1970(std::int64_t monotonic_ns) const {
    return static_cast<std::uint64_t>(std::max<std::int64_t>(0, monotonic_ns + to_1970_));
  }

  std::int64_t to_1970_;
  McapWriter writer_;
  std::map<std::string, std::uint16_t> channels_;
  Bytes bytes_;
};

}  // namespace

std::uint64_t export_mcap(const std::filesystem::path& log, const std::string& topic,
                          const std::filesystem::path& file) {
  LogReader reader(log);
  Export to(reader, file);
  RunsAtOnce runs;
  for (LogEvent event; reader.next(event);) {
    stop_if_interrupted();
    runs.add(event);
    to.add(event, topic);
  }
  if (!reader.damage_text().empty()) fmt::print(stderr, "palpate: {}\n", reader.damage_text());
  if (!runs.text().empty()) fmt::print(stderr, "palpate: {}: {}\n", log.string(), runs.text());
  if (to.messages() == 0) throw std::runtime_error(fmt::format("{}: holds no such sample", log.string()));
  to.finish();
  return to.messages();
}

}  // namespace palpate
