#include "common/bus/log_bus.hpp"

#include "idl/limits.hpp"

namespace palpate {
namespace {

template <class M>
class LogTopicWriter final : public Writer<M> {
 public:
  LogTopicWriter(LogWriter& log, const LogClock& clock, const Topic<M>& topic)
      : log_(log), clock_(clock), topic_(topic) {}

  bool write(const M& message) override {
    M sent = message;  // NOLINT(performance-unnecessary-copy-initialization): changed where it has these times
    const std::int64_t receive_ns = clock_.start_ns + clock_.now_ns;
    if constexpr (requires { sent.sense_ns; }) sent.sense_ns += clock_.start_ns;
    if constexpr (requires { sent.publish_ns; }) sent.publish_ns = receive_ns;
    if (!valid(sent)) {
      ++refused_;
      return false;
    }
    log_.write(topic_.name, receive_ns, sent);
    return true;
  }

  int readers() const override { return 0; }
  std::uint64_t refused() const override { return refused_; }
  bool delivered() const override { return true; }

 private:
  LogWriter& log_;
  const LogClock& clock_;
  Topic<M> topic_;
  std::uint64_t refused_ = 0;
};

template <class M>
class NoReader final : public Reader<M> {
 public:
  std::optional<M> take() override { return std::nullopt; }
  int writers() const override { return 0; }
  std::uint64_t taken_from() const override { return 0; }
  bool lasts(std::uint64_t) const override { return false; }
  std::uint64_t invalid() const override { return 0; }
};

class LogBus final : public Bus {
 public:
  LogBus(LogWriter& log, const LogClock& clock) : log_(log), clock_(clock) {}

#define PALPATE_LOG_PORTS(M)                                                       \
  std::unique_ptr<Writer<M>> writer(const Topic<M>& topic) override {              \
    return std::make_unique<LogTopicWriter<M>>(log_, clock_, topic);               \
  }                                                                                \
  std::unique_ptr<Reader<M>> reader(const Topic<M>&, Keep, std::size_t) override { \
    return std::make_unique<NoReader<M>>();                                        \
  }
  PALPATE_MESSAGES(PALPATE_LOG_PORTS)
#undef PALPATE_LOG_PORTS

  std::string place() const override {
    return "a log";
  }
  std::vector<std::string> misfits() override {
    return {};
  }
  std::uint64_t refused() const override {
    return 0;
  }
  bool wait(std::chrono::nanoseconds) override {
    return false;
  }
  bool serve(std::function<bool()>) override {
    return false;
  }

 private:
  LogWriter& log_;
  const LogClock& clock_;
};

}  // namespace

std::unique_ptr<Bus> make_log_bus(LogWriter& log, const LogClock& clock) {
  return std::make_unique<LogBus>(log, clock);
}

}  // namespace palpate
