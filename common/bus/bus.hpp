#pragma once
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "idl/fields.hpp"
#include "idl/topics.hpp"

namespace palpate {

/// Writes samples of one topic. write() may allocate and lock: never call it from the haptic step.
template <class Message>
class Writer {
 public:
  virtual ~Writer() = default;
  /// Never waits for a reader. False if the sample was not sent: it is invalid or the buffers are full.
  virtual bool write(const Message& message) = 0;
  /// The same, but it may wait for send(): what is said at once may go out at once, in one datagram.
  virtual bool gather(const Message& message) { return write(message); }
  virtual void send() {}
  virtual int readers() const = 0;            ///< matched readers; over DDS one that was killed counts for two minutes
  virtual std::uint64_t refused() const = 0;  ///< samples for which write() was false
  /// No reader that asks for repair still lacks something that was written; recorders with a stream of their own count
  /// where nobody else reads.
  virtual bool delivered() const = 0;
};

/// Receives samples of one topic, oldest first within a key. Samples that fail `valid` are dropped and
/// counted.
template <class Message>
class Reader {
 public:
  virtual ~Reader() = default;
  virtual std::optional<Message> take() = 0;  ///< the next valid sample; empty: none, or so many were taken in a row
  /// The key alone of a stream whose writers have all died, fallen silent or ended, as take() came upon it; empty if
  /// there is none. Of streams in the memory of this process: never.
  virtual std::optional<Message> take_ended() { return std::nullopt; }
  virtual int writers() const = 0;  ///< live writers at this moment; death shows within about 0.2 s
  /// Which writer the sample came from that take() returned last; 0: none.
  virtual std::uint64_t taken_from() const = 0;
  /// That writer has not ended; one that was killed or is cut off counts for two minutes.
  virtual bool lasts(std::uint64_t writer) const = 0;
  /// Samples dropped: invalid, under more names than a writer may use or under another one's, or more than the reader
  /// has room for.
  virtual std::uint64_t invalid() const = 0;
};

/// What a reader keeps between two calls of take().
enum class Keep {
  latest,  ///< the newest sample of each key: a slow node never works through a queue of old ones
  all      ///< every sample: recorders
};

/// [bytes] of the sequences in the samples of a peer that wait in a reader that keeps all: beyond, its samples are
/// dropped.
inline constexpr std::size_t kRecordersRoom = std::size_t{1} << 30;

/// One interface over the network and the memory of this process. A log is played to any bus
/// (tools/log_player.hpp). Each writer and reader is used by one thread at a time, and none outlives its bus.
class Bus {
 public:
  virtual ~Bus() = default;

#define PALPATE_BUS_PORTS(M)                                                                 \
  virtual std::unique_ptr<Writer<M>> writer(const Topic<M>& topic) = 0;                      \
  virtual std::unique_ptr<Reader<M>> reader(const Topic<M>& topic, Keep keep = Keep::latest, \
                                            std::size_t room = kRecordersRoom) = 0;
  PALPATE_MESSAGES(PALPATE_BUS_PORTS)
#undef PALPATE_BUS_PORTS

  /// Where it meets others, for a sentence: "domain 3 on eth0 (192.0.2.1)".
  virtual std::string place() const = 0;

  /// A sentence about each program of another version that has come since the last call: its messages do not get
  /// through.
  virtual std::vector<std::string> misfits() = 0;

  /// Samples that all readers of this bus, past ones too, have dropped. On any thread.
  virtual std::uint64_t refused() const = 0;

  /// Sleeps until a reader of this bus has something to take, or the time is over. True if there may be
  /// something.
  virtual bool wait(std::chrono::nanoseconds timeout) = 0;

  /// From now on `news` is called whenever something has come to a reader of this bus, on the thread that brings it, so
  /// that nobody has to be woken first. Nothing else comes to this bus meanwhile: it has to be short. One call at a
  /// time; for what comes during it another follows. Where it returns false, wait() returns, as it does once for what
  /// had come before, and for nothing else. Empty: wait() as ever, once a call under way is over; not from within it.
  /// False, and nothing is done, where the bus has no thread that brings anything.
  virtual bool serve(std::function<bool()> news) = 0;
};

/// Takes everything that waits and returns the last sample. Meant for topics with one key.
template <class M>
std::optional<M> take_last(Reader<M>& reader) {
  std::optional<M> last;
  while (auto next = reader.take()) last = std::move(next);
  return last;
}

}  // namespace palpate
