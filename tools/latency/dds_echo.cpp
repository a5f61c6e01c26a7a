#include "common/bus/bare_dds.hpp"
#include "tools/latency/echo.hpp"

namespace palpate::latency {
namespace {

/// Reliable, the newest sample alone: as surfaces are delivered, and as bare DDS beside them here.
constexpr Topic<ToolState> kQuestion{"palpate/latency_question", "ToolState", topics::surface_state.qos};
constexpr Topic<ForceState> kAnswer{"palpate/latency_answer", "ForceState", topics::surface_state.qos};

template <class Out, class In>
class BusEcho : public Echo {
 public:
  BusEcho(const BusSettings& settings, const Topic<Out>& out, const Topic<In>& in)
      : bus_(make_dds_bus(settings)), writer_(bus_->writer(out)), reader_(bus_->reader(in)) {}
  ~BusEcho() override { bus_->serve({}); }
  void send(std::uint64_t seq) override {
    message_.seq = seq;
    writer_->write(message_);
  }
  std::uint64_t receive(std::chrono::nanoseconds timeout) override {
    auto message = reader_->take();
    if (!message) {
      bus_->wait(timeout);
      message = reader_->take();
    }
    return message ? message->seq : 0;
  }
  bool listen(const std::function<void(std::uint64_t)>& receive) override {
    return bus_->serve([this, receive] {
      while (const auto message = reader_->take()) receive(message->seq);
      return true;
    });
  }

 private:
  std::unique_ptr<Bus> bus_;
  std::unique_ptr<Writer<Out>> writer_;
  std::unique_ptr<Reader<In>> reader_;
  Out message_;
};

class DdsEcho : public Echo {
 public:
  DdsEcho(const BusSettings& settings, const std::string& out, const std::string& in, std::size_t size, Wake wake)
      : bytes_(size), wake_(wake), dds_(settings, out, in) {}
  void send(std::uint64_t seq) override { dds_.send(seq, bytes_); }
  std::uint64_t receive(std::chrono::nanoseconds timeout) override { return dds_.receive(timeout); }
  bool listen(const std::function<void(std::uint64_t)>& receive) override {
    if (wake_ == Wake::listener) dds_.listen(receive);
    return wake_ == Wake::listener;
  }

 private:
  std::vector<std::uint8_t> bytes_;
  Wake wake_;
  BareDds dds_;  // the last: its thread may send
};

}  // namespace

std::unique_ptr<Echo> bus_echo(const BusSettings& settings, Side side) {
  if (side == Side::asks) return std::make_unique<BusEcho<ToolState, ForceState>>(settings, kQuestion, kAnswer);
  return std::make_unique<BusEcho<ForceState, ToolState>>(settings, kAnswer, kQuestion);
}

std::unique_ptr<Echo> dds_echo(const BusSettings& settings, Side side, Wake wake) {
  const std::string way = wake == Wake::listener ? "palpate/latency_listener" : "palpate/latency_bare";
  const std::string there = way + "_question", back = way + "_answer";
  if (side == Side::asks) return std::make_unique<DdsEcho>(settings, there, back, BareDds::kAsToolState, wake);
  return std::make_unique<DdsEcho>(settings, back, there, BareDds::kAsForceState, wake);
}

}  // namespace palpate::latency
