#pragma once
#include <chrono>
#include <memory>
#include <optional>

#include "common/bus/messages.hpp"

namespace palpate {

/// Writes samples of one topic. write() may allocate and lock: never call it from the haptic step.
template <class Message>
class Writer {
 public:
  virtual ~Writer() = default;
  virtual void write(const Message& message) = 0;
  virtual int readers() const = 0;  ///< matched readers at this moment
};

/// Receives samples of one topic, oldest first.
template <class Message>
class Reader {
 public:
  virtual ~Reader() = default;
  virtual std::optional<Message> take() = 0;  ///< the next valid sample, empty if there is none
  virtual int writers() const = 0;            ///< live writers at this moment (liveliness, not only matched)
};

/// One interface over the network, the memory of this process and a log.
class Bus {
 public:
  virtual ~Bus() = default;
  // For every message M of messages.hpp:
  //   virtual std::unique_ptr<Writer<M>> writer(const Topic<M>& topic) = 0;
  //   virtual std::unique_ptr<Reader<M>> reader(const Topic<M>& topic) = 0;
  /// Sleeps until a reader of this bus has something to take, or the time is over. True if there is something.
  virtual bool wait(std::chrono::nanoseconds timeout) = 0;
};

}  // namespace palpate
