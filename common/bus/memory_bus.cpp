#include "common/bus/memory_bus.hpp"

#include <algorithm>
#include <condition_variable>
#include <deque>
#include <map>
#include <mutex>

#include "common/bus/key.hpp"
#include "common/bus/stamp.hpp"
#include "common/bus/validate.hpp"

namespace palpate {
namespace {

/// Wakes the one bus whose readers got something.
struct Bell {
  std::condition_variable rung;
  std::size_t waiting = 0;  ///< samples in all queues of the bus, under the network's mutex
};

template <class M>
struct Queue {
  std::shared_ptr<Bell> bell;
  Keep keep;
  std::deque<M> samples;
};

/// One topic: who reads it, how many write it, and what late joiners get.
template <class M>
struct Channel {
  std::vector<Queue<M>*> queues;
  int writers = 0;
  std::map<std::pair<const void*, std::string>, std::deque<M>> kept;  ///< by writer and key
};

template <class M>
void deliver(Queue<M>& queue, const M& message) {
  if (queue.keep == Keep::latest) {
    const auto same_key = [&](const M& other) { return key_of(other) == key_of(message); };
    const auto old = std::find_if(queue.samples.begin(), queue.samples.end(), same_key);
    if (old != queue.samples.end()) {
      queue.samples.erase(old);
      --queue.bell->waiting;
    }
  }
  queue.samples.push_back(message);
  ++queue.bell->waiting;
  queue.bell->rung.notify_all();
}

}  // namespace

class MemoryNetwork {
 public:
  std::mutex mutex;

  template <class M>
  Channel<M>& channel(const Topic<M>& topic) {
    const std::lock_guard lock(mutex);
    return std::get<std::map<std::string, Channel<M>>>(channels_)[topic.name];
  }

 private:
#define PALPATE_CHANNEL(M) std::map<std::string, Channel<M>>,
  std::tuple<PALPATE_MESSAGES(PALPATE_CHANNEL) int> channels_;
#undef PALPATE_CHANNEL
};

namespace {

template <class M>
class MemoryWriter final : public Writer<M> {
 public:
  MemoryWriter(std::shared_ptr<MemoryNetwork> network, const Topic<M>& topic)
      : network_(std::move(network)), channel_(network_->channel(topic)), qos_(topic.qos) {
    const std::lock_guard lock(network_->mutex);
    ++channel_.writers;
  }
  ~MemoryWriter() override {
    const std::lock_guard lock(network_->mutex);
    --channel_.writers;
    std::erase_if(channel_.kept, [&](const auto& entry) { return entry.first.first == this; });
  }

  bool write(const M& message) override {
    const std::lock_guard lock(network_->mutex);
    if (!valid(message)) {
      ++refused_;
      return false;
    }
    M sent = message;
    stamp(sent);
    for (Queue<M>* queue : channel_.queues) deliver(*queue, sent);
    if (qos_.transient_local) keep_for_late_joiners(sent);
    return true;
  }

  int readers() const override {
    const std::lock_guard lock(network_->mutex);
    return static_cast<int>(channel_.queues.size());
  }
  std::uint64_t refused() const override { return refused_; }
  bool delivered() const override { return true; }

 private:
  void keep_for_late_joiners(const M& message) {
    auto& kept = channel_.kept[{this, key_of(message)}];
    kept.push_back(message);
    if (qos_.depth != keep_all && kept.size() > 1) kept.pop_front();
  }

  std::shared_ptr<MemoryNetwork> network_;
  Channel<M>& channel_;
  Qos qos_;
  std::uint64_t refused_ = 0;
};

template <class M>
class MemoryReader final : public Reader<M> {
 public:
  MemoryReader(std::shared_ptr<MemoryNetwork> network, std::shared_ptr<Bell> bell, const Topic<M>& topic, Keep keep)
      : network_(std::move(network)), channel_(network_->channel(topic)), queue_{std::move(bell), keep, {}} {
    const std::lock_guard lock(network_->mutex);
    channel_.queues.push_back(&queue_);
    for (const auto& [owner, samples] : channel_.kept)
      for (const M& sample : samples) deliver(queue_, sample);
  }
  ~MemoryReader() override {
    const std::lock_guard lock(network_->mutex);
    std::erase(channel_.queues, &queue_);
    queue_.bell->waiting -= queue_.samples.size();
  }

  std::optional<M> take() override {
    const std::lock_guard lock(network_->mutex);
    if (queue_.samples.empty()) return std::nullopt;
    std::optional<M> message = std::move(queue_.samples.front());
    queue_.samples.pop_front();
    --queue_.bell->waiting;
    return message;
  }

  int writers() const override {
    const std::lock_guard lock(network_->mutex);
    return channel_.writers;
  }
  int known_writers() const override { return writers(); }
  std::uint64_t invalid() const override { return 0; }  // writers refuse invalid samples

 private:
  std::shared_ptr<MemoryNetwork> network_;
  Channel<M>& channel_;
  Queue<M> queue_;
};

class MemoryBus final : public Bus {
 public:
  explicit MemoryBus(std::shared_ptr<MemoryNetwork> network)
      : network_(std::move(network)), bell_(std::make_shared<Bell>()) {}

#define PALPATE_MEMORY_PORTS(M)                                                  \
  std::unique_ptr<Writer<M>> writer(const Topic<M>& topic) override {            \
    return std::make_unique<MemoryWriter<M>>(network_, topic);                   \
  }                                                                              \
  std::unique_ptr<Reader<M>> reader(const Topic<M>& topic, Keep keep) override { \
    return std::make_unique<MemoryReader<M>>(network_, bell_, topic, keep);      \
  }
  PALPATE_MESSAGES(PALPATE_MEMORY_PORTS)
#undef PALPATE_MEMORY_PORTS

  std::string place() const override {
    return "this process";
  }
  std::vector<std::string> misfits() override {
    return {};
  }

  bool wait(std::chrono::nanoseconds timeout) override {
    std::unique_lock lock(network_->mutex);
    return bell_->rung.wait_for(lock, timeout, [&] { return bell_->waiting > 0; });
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
