#include "common/bus/dds_bus.hpp"

#include <dds/dds.h>
#include <fmt/format.h>

#include <atomic>
#include <functional>

#include "common/bus/dds_cache.hpp"
#include "common/bus/dds_convert.hpp"
#include "common/bus/dds_domain.hpp"
#include "common/bus/dds_entity.hpp"
#include "common/bus/dds_gate.hpp"
#include "common/bus/dds_wake.hpp"
#include "common/bus/peers.hpp"
#include "common/bus/stamp.hpp"
#include "common/bus/version_watch.hpp"
#include "idl/limits.hpp"

namespace palpate {
namespace {

struct QosDeleter {
  void operator()(dds_qos_t* qos) const { dds_delete_qos(qos); }
};
using QosPtr = std::unique_ptr<dds_qos_t, QosDeleter>;

/// What writer and reader of a topic agree on. Blocking time 0: a full history refuses the sample instead of
/// waiting.
QosPtr common_qos(const Qos& qos) {
  QosPtr q(dds_create_qos());
  dds_qset_reliability(q.get(), qos.reliable ? DDS_RELIABILITY_RELIABLE : DDS_RELIABILITY_BEST_EFFORT, 0);
  dds_qset_durability(q.get(), qos.transient_local ? DDS_DURABILITY_TRANSIENT_LOCAL : DDS_DURABILITY_VOLATILE);
  return q;
}

QosPtr writer_qos(const Qos& qos, int lease_ms) {
  QosPtr q = common_qos(qos);
  const bool all = qos.depth == kKeepAll;
  const dds_history_kind_t kind = all ? DDS_HISTORY_KEEP_ALL : DDS_HISTORY_KEEP_LAST;
  dds_qset_history(q.get(), kind, all ? DDS_LENGTH_UNLIMITED : qos.depth);
  dds_qset_durability_service(q.get(), 0, kind, all ? DDS_LENGTH_UNLIMITED : 1, DDS_LENGTH_UNLIMITED,
                              DDS_LENGTH_UNLIMITED, DDS_LENGTH_UNLIMITED);
  dds_qset_liveliness(q.get(), DDS_LIVELINESS_AUTOMATIC, DDS_MSECS(lease_ms));
  dds_qset_writer_data_lifecycle(q.get(), false);
  return q;
}

/// A reader that keeps all stops accepting after a while; the writer then drops its oldest samples, not its
/// pace.
/// One that wants the latest of a stream does not ask for what was lost on the way: it would wait for old samples to be
/// repeated, behind which newer ones queue.
QosPtr reader_qos(const Qos& qos, Keep keep) {
  constexpr int max_kept = 16384;
  QosPtr q = common_qos(qos);
  if (keep == Keep::latest) {
    dds_qset_history(q.get(), DDS_HISTORY_KEEP_LAST, 1);
    const bool stream = qos.depth > 1 && !qos.transient_local;
    if (stream) dds_qset_reliability(q.get(), DDS_RELIABILITY_BEST_EFFORT, 0);
  } else {
    dds_qset_history(q.get(), DDS_HISTORY_KEEP_ALL, DDS_LENGTH_UNLIMITED);
    dds_qset_resource_limits(q.get(), max_kept, DDS_LENGTH_UNLIMITED, DDS_LENGTH_UNLIMITED);
  }
  return q;
}

/// A writer of the middleware, with its topic.
class DdsOutlet {
 public:
  DdsOutlet(dds_entity_t participant, const dds_topic_descriptor_t& type, const std::string& name, const Qos& qos,
            int lease_ms)
      : topic_(dds_create_topic(participant, &type, name.c_str(), nullptr, nullptr),
               fmt::format("creating topic {}", name)),
        writer_(dds_create_writer(participant, topic_, writer_qos(qos, lease_ms).get(), nullptr),
                fmt::format("creating the writer of {}", name)) {}

  /// Where the domain gathers, it goes out with the next send(); else at once.
  bool gather(const void* sample) { return dds_write(writer_, sample) == DDS_RETCODE_OK; }
  void send() { dds_write_flush(writer_); }
  bool delivered() const { return dds_wait_for_acks(writer_, 0) == DDS_RETCODE_OK; }
  int readers() const {
    dds_publication_matched_status_t status{};
    dds_get_publication_matched_status(writer_, &status);
    return static_cast<int>(status.current_count);
  }

 private:
  Entity topic_, writer_;
};

template <class M>
class DdsWriter final : public Writer<M> {
 public:
  DdsWriter(dds_entity_t participant, const Topic<M>& topic, int lease_ms)
      : outlet_(participant, dds::Generated<M>::descriptor(), topic.name, topic.qos, lease_ms) {
    Qos deep = topic.qos;
    deep.depth = topic.qos.recorder_depth;
    if (deep.depth > 0)
      for_recorders_.emplace(participant, dds::Generated<M>::descriptor(), recorders_name(topic), deep, lease_ms);
  }

  bool write(const M& message) override {
    const bool written = gather(message);
    send();
    return written;
  }
  bool gather(const M& message) override {
    typename dds::Generated<M>::Type sample{};
    if (valid(message)) {
      fields(dds::Lend{}, message, sample);
      stamp(sample);
      const bool recorded = !for_recorders_ || for_recorders_->readers() == 0 || for_recorders_->gather(&sample);
      if (outlet_.gather(&sample) && recorded) return true;
    }
    ++refused_;
    return false;
  }
  void send() override {
    outlet_.send();
    if (for_recorders_) for_recorders_->send();
  }

  int readers() const override { return outlet_.readers() + (for_recorders_ ? for_recorders_->readers() : 0); }
  std::uint64_t refused() const override { return refused_; }
  /// A recorder that falls behind does not hold up viewers, but where it is alone it sets the pace.
  bool delivered() const override {
    return for_recorders_ && outlet_.readers() == 0 ? for_recorders_->delivered() : outlet_.delivered();
  }

 private:
  DdsOutlet outlet_;
  std::optional<DdsOutlet> for_recorders_;
  std::uint64_t refused_ = 0;
};

/// A reader of the middleware, with its topic and what wakes the bus for it. `gate`: sees each sample before it is
/// kept. `refused`: is called for each that does not come so far.
class DdsInlet {
 public:
  DdsInlet(dds_entity_t participant, DdsWake& wake, const dds_topic_descriptor_t& type, const std::string& name,
           const Qos& qos, Keep keep, const dds_topic_filter& gate, std::function<void()> refused)
      : topic_(gated_topic(participant, type, name, gate), fmt::format("creating topic {}", name)),
        reader_(create_reader_of_messages(participant, topic_, reader_qos(qos, keep).get(), wake.listener(),
                                          std::move(refused)),
                fmt::format("creating the reader of {}", name)),
        condition_(dds_create_readcondition(reader_, DDS_ANY_STATE), "creating a read condition") {
    wake.attach(condition_);
  }

  /// As take_message() has it.
  bool take(const std::function<void(const void*, dds_instance_handle_t)>& receive,
            const std::function<void(const void*)>& end) {
    return take_message(reader_, receive, end);
  }

  int writers() const {
    dds_liveliness_changed_status_t status{};
    dds_get_liveliness_changed_status(reader_, &status);
    return static_cast<int>(status.alive_count);
  }

 private:
  // A topic of the reader's own, so that no other reader or writer goes through its gate.
  static dds_entity_t gated_topic(dds_entity_t participant, const dds_topic_descriptor_t& type, const std::string& name,
                                  const dds_topic_filter& gate) {
    const dds_entity_t topic = dds_create_topic(participant, &type, name.c_str(), nullptr, nullptr);
    if (topic >= 0) dds_set_topic_filter_extended(topic, &gate);
    return topic;
  }

  Entity topic_, reader_, condition_;
};

/// Where a reader finds what it wants of a topic.
template <class M>
std::string stream_name(const Topic<M>& topic, Keep keep) {
  return keep == Keep::all && topic.qos.recorder_depth > 0 ? recorders_name(topic) : topic.name;
}

template <class M>
class DdsReader final : public Reader<M> {
 public:
  DdsReader(dds_entity_t participant, DdsWake& wake, const Topic<M>& topic, Keep keep, std::size_t room,
            const Peers& peers, Owners<RunKey>& runs, std::atomic<std::uint64_t>& refused)
      : at_once_(keep == Keep::all ? WaitingRoom::kSamples : kKeysAtOnce),
        peers_(peers),
        gate_(peers, runs, refused, topic.run_of, keep == Keep::all, room),
        inlet_(participant, wake, dds::Generated<M>::descriptor(), stream_name(topic, keep), topic.qos, keep,
               {.mode = DDS_TOPIC_FILTER_SAMPLE_SAMPLEINFO_ARG,
                .f = {.sample_sampleinfo_arg = &dds::Gate<M>::filter},
                .arg = &gate_},
               [this] { gate_.refuse(); }) {}

  std::optional<M> take() override {
    std::optional<M> message;
    if (in_a_row_ == at_once_) {
      in_a_row_ = 0;
      return message;
    }
    inlet_.take(
        [&](const void* sample, dds_instance_handle_t writer) {
          message = copy(sample);
          taken_from_ = writer;
          gate_.taken(*message, writer);
        },
        [&](const void* sample) {
          if constexpr (std::same_as<M, NodeStatus>)
            if (ended_.size() < kKeysAtOnce) ended_.push_back(copy(sample));
        });
    in_a_row_ = message ? in_a_row_ + 1 : 0;
    return message;
  }
  std::optional<M> take_ended() override {
    if (ended_.empty()) return std::nullopt;
    M ended = std::move(ended_.back());
    ended_.pop_back();
    return ended;
  }

  int writers() const override { return inlet_.writers(); }
  std::uint64_t taken_from() const override { return taken_from_; }
  bool lasts(std::uint64_t writer) const override { return peers_.of(writer) != 0; }
  std::uint64_t invalid() const override { return gate_.refused(); }

 private:
  static M copy(const void* sample) {
    M message;
    fields(dds::CopyOut{}, message, *static_cast<const typename dds::Generated<M>::Type*>(sample));
    return message;
  }

  static constexpr std::size_t kKeysAtOnce = 256;

  /// Who takes until there is no more comes to its other work after so many, though they come faster than it takes.
  const std::size_t at_once_;
  std::size_t in_a_row_ = 0;
  std::uint64_t taken_from_ = 0;
  const Peers& peers_;
  dds::Gate<M> gate_;  // before the inlet, whose samples pass it
  DdsInlet inlet_;
  std::vector<M> ended_;  ///< of nodes alone; somebody may ask for them
};

class DdsBus final : public Bus {
 public:
  explicit DdsBus(const BusSettings& settings)
      : lease_ms_(settings.lease_ms),
        place_(dds_place(settings)),
        domain_(join_domain(settings)),
        participant_(make_participant(settings), fmt::format("joining domain {}", settings.domain)),
        wake_(participant_),
        versions_(participant_),
        peers_(participant_),
        runs_(peers_) {}

#define PALPATE_DDS_PORTS(M)                                                                                \
  std::unique_ptr<Writer<M>> writer(const Topic<M>& topic) override {                                       \
    return std::make_unique<DdsWriter<M>>(participant_, topic, lease_ms_);                                  \
  }                                                                                                         \
  std::unique_ptr<Reader<M>> reader(const Topic<M>& topic, Keep keep, std::size_t room) override {          \
    return std::make_unique<DdsReader<M>>(participant_, wake_, topic, keep, room, peers_, runs_, refused_); \
  }
  PALPATE_MESSAGES(PALPATE_DDS_PORTS)
#undef PALPATE_DDS_PORTS

  std::string place() const override {
    return place_;
  }
  std::vector<std::string> misfits() override {
    return versions_.look();
  }

  std::uint64_t refused() const override {
    return refused_.load(std::memory_order_relaxed);
  }

  bool wait(std::chrono::nanoseconds timeout) override {
    return wake_.wait(timeout);
  }
  bool serve(std::function<bool()> news) override {
    wake_.serve(std::move(news));
    return true;
  }

 private:
  int lease_ms_;
  std::string place_;
  std::shared_ptr<const void> domain_;
  std::atomic<std::uint64_t> refused_ = 0;
  Entity participant_;
  DdsWake wake_;
  VersionWatch versions_;
  Peers peers_;
  Owners<RunKey> runs_;
};

}  // namespace

std::unique_ptr<Bus> make_dds_bus(const BusSettings& settings) {
  return std::make_unique<DdsBus>(settings);
}

}  // namespace palpate
