#include "common/bus/memory_bus.hpp"

#include <algorithm>
#include <condition_variable>
#include <deque>
#include <map>
#include <mutex>
#include <set>
#include <utility>

#include "common/bus/key.hpp"
#include "common/bus/stamp.hpp"
#include "idl/limits.hpp"

namespace palpate {
namespace {

/// Wakes the one bus whose readers got something.
struct Bell {
  std::condition_variable rung;
  std::size_t waiting = 0;  ///< samples in all queues of the bus, under the network's mutex
};

/// A message of whatever type: writers and readers of one topic agree on it.
struct Sample {
  std::shared_ptr<const void> message;
  std::string key;
  std::uint64_t writer;
};

struct Queue {
  std::shared_ptr<Bell> bell;
  Keep keep;
  std::deque<Sample> samples;
};

/// One topic: who reads it, how many write it, and what late joiners get.
struct Channel {
  std::vector<Queue*> queues;
  std::set<std::uint64_t> writers;
  std::map<std::pair<std::uint64_t, std::string>, std::deque<Sample>> kept;  ///< by writer and key
};

void deliver(Queue& queue, const Sample& sample) {
  if (queue.keep == Keep::latest) {
    const auto old = std::ranges::find(queue.samples, sample.key, &Sample::key);
    if (old != queue.samples.end()) {
      queue.samples.erase(old);
      --queue.bell->waiting;
    }
  }
  queue.samples.push_back(sample);
  ++queue.bell->waiting;
  queue.bell->rung.notify_all();
}

}  // namespace

class MemoryNetwork {
 public:
  std::mutex mutex;
  std::uint64_t newest_writer = 0;  ///< its number

  template <class M>
  Channel& channel(const Topic<M>& topic) {
    const std::lock_guard lock(mutex);
    return channels_[{topic.name, topic.message}];
  }

 private:
  std::map<std::pair<std::string, std::string>, Channel> channels_;  ///< by topic and message
};

namespace {

/// What writes, apart from the type of the message.
class MemoryOutlet {
 public:
  MemoryOutlet(MemoryNetwork& network, Channel& channel, const Qos& qos)
      : network_(network), channel_(channel), qos_(qos) {
    const std::lock_guard lock(network_.mutex);
    channel_.writers.insert(number_ = ++network_.newest_writer);
  }
  MemoryOutlet(const MemoryOutlet&) = delete;
  ~MemoryOutlet() {
    const std::lock_guard lock(network_.mutex);
    channel_.writers.erase(number_);
    std::erase_if(channel_.kept, [&](const auto& entry) { return entry.first.first == number_; });
  }

  void write(std::shared_ptr<const void> message, std::string key) {
    const std::lock_guard lock(network_.mutex);
    const Sample sample{std::move(message), std::move(key), number_};
    for (Queue* queue : channel_.queues) deliver(*queue, sample);
    if (!qos_.transient_local) return;
    auto& kept = channel_.kept[{number_, sample.key}];
    kept.push_back(sample);
    if (qos_.depth != kKeepAll && kept.size() > 1) kept.pop_front();
  }

  int readers() const {
    const std::lock_guard lock(network_.mutex);
    return static_cast<int>(channel_.queues.size());
  }

 private:
  MemoryNetwork& network_;
  Channel& channel_;
  Qos qos_;
  std::uint64_t number_ = 0;
};

/// What reads, apart from the type of the message.
class MemoryInlet {
 public:
  MemoryInlet(MemoryNetwork& network, Channel& channel, std::shared_ptr<Bell> bell, Keep keep)
      : network_(network), channel_(channel), queue_{std::move(bell), keep, {}} {
    const std::lock_guard lock(network_.mutex);
    channel_.queues.push_back(&queue_);
    for (const auto& [owner, samples] : channel_.kept)
      for (const Sample& sample : samples) deliver(queue_, sample);
  }
  MemoryInlet(const MemoryInlet&) = delete;
  ~MemoryInlet() {
    const std::lock_guard lock(network_.mutex);
    std::erase(channel_.queues, &queue_);
    queue_.bell->waiting -= queue_.samples.size();
  }

  /// Null if nothing waits.
  std::shared_ptr<const void> take() {
    const std::lock_guard lock(network_.mutex);
    if (queue_.samples.empty()) return nullptr;
    std::shared_ptr<const void> message = std::move(queue_.samples.front().message);
    taken_from_ = queue_.samples.front().writer;
    queue_.samples.pop_front();
    --queue_.bell->waiting;
    return message;
  }

  int writers() const {
    const std::lock_guard lock(network_.mutex);
    return static_cast<int>(channel_.writers.size());
  }
  std::uint64_t taken_from() const { return taken_from_; }
  bool lasts(std::uint64_t writer) const {
    const std::lock_guard lock(network_.mutex);
    return channel_.writers.contains(writer);
  }

 private:
  MemoryNetwork& network_;
  Channel& channel_;
  Queue queue_;
  std::uint64_t taken_from_ = 0;
};

template <class M>
class MemoryWriter final : public Writer<M> {
 public:
  MemoryWriter(std::shared_ptr<MemoryNetwork> network, const Topic<M>& topic)
      : network_(std::move(network)), outlet_(*network_, network_->channel(topic), topic.qos) {}

  bool write(const M& message) override {
    if (!valid(message)) {
      ++refused_;
      return false;
    }
    const auto sent = std::make_shared<M>(message);
    stamp(*sent);
    outlet_.write(sent, key_of(message));
    return true;
  }

  int readers() const override { return outlet_.readers(); }
  std::uint64_t refused() const override { return refused_; }
  bool delivered() const override { return true; }

 private:
  std::shared_ptr<MemoryNetwork> network_;
  MemoryOutlet outlet_;
  std::uint64_t refused_ = 0;
};

template <class M>
class MemoryReader final : public Reader<M> {
 public:
  MemoryReader(std::shared_ptr<MemoryNetwork> network, std::shared_ptr<Bell> bell, const Topic<M>& topic, Keep keep)
      : network_(std::move(network)), inlet_(*network_, network_->channel(topic), std::move(bell), keep) {}

  std::optional<M> take() override {
    const std::shared_ptr<const void> message = inlet_.take();
    if (!message) return std::nullopt;
    return *static_cast<const M*>(message.get());
  }

  int writers() const override { return inlet_.writers(); }
  std::uint64_t taken_from() const override { return inlet_.taken_from(); }
  bool lasts(std::uint64_t writer) const override { return inlet_.lasts(writer); }
  std::uint64_t invalid() const override { return 0; }  // writers refuse invalid samples

 private:
  std::shared_ptr<MemoryNetwork> network_;
  MemoryInlet inlet_;
};

class MemoryBus final : public Bus {
 public:
  explicit MemoryBus(std::shared_ptr<MemoryNetwork> network)
      : network_(std::move(network)), bell_(std::make_shared<Bell>()) {}

#define PALPATE_MEMORY_PORTS(M)                                                               \
  std::unique_ptr<Writer<M>> writer(const Topic<M>& topic) override {                         \
    return std::make_unique<MemoryWriter<M>>(network_, topic);                                \
  }                                                                                           \
  std::unique_ptr<Reader<M>> reader(const Topic<M>& topic, Keep keep, std::size_t) override { \
    return std::make_unique<MemoryReader<M>>(network_, bell_, topic, keep);                   \
  }
  PALPATE_MESSAGES(PALPATE_MEMORY_PORTS)
#undef PALPATE_MEMORY_PORTS

  std::string place() const override {
    return "this process";
  }
  std::vector<std::string> misfits() override {
    return {};
  }

  std::uint64_t refused() const override {
    return 0;
  }

  bool wait(std::chrono::nanoseconds timeout) override {
    std::unique_lock lock(network_->mutex);
    return bell_->rung.wait_for(lock, timeout, [&] { return bell_->waiting > 0; });
  }
  bool serve(std::function<bool()>) override {
    return false;
  }

 private:
  std::shared_ptr<MemoryNetwork> network_;
  std::shared_ptr<Bell> bell_;
};

}  // namespace

std::shared_ptr<MemoryNetwork> make_memory_network() {
  return std::make_shared<MemoryNetwork>();
}

std::unique_ptr<Bus> make_memory_bus(std::shared_ptr<MemoryNetwork> network) {
  return std::make_unique<MemoryBus>(std::move(network));
}

}  // namespace palpate
