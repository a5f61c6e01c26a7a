#pragma once
#include <array>
#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>

#include "common/bus/dds_bus.hpp"

struct dds_topic_descriptor;  // of a type that idlc has compiled

/// Topics of other systems on the same middleware, by their own names, types and user data: samples are the structs of
/// idlc, in plain CDR (XCDR 1), and nothing of them is checked here.
namespace palpate {

/// The middleware's number of a participant, writer or reader, the same for all who see it.
using Guid = std::array<std::uint8_t, 16>;

class PlainParticipant {
 public:
  /// `words`: user data that others see of it. Without keys. Throws std::runtime_error in one sentence.
  PlainParticipant(const BusSettings& settings, const std::string& words);
  ~PlainParticipant();
  PlainParticipant(const PlainParticipant&) = delete;
  PlainParticipant& operator=(const PlainParticipant&) = delete;

  Guid guid() const;
  /// Sleeps until one of its readers has something to take, or the time is over. True if there may be something.
  bool wait(std::chrono::nanoseconds timeout);

 private:
  friend class PlainWriter;
  friend class PlainReader;
  std::shared_ptr<const void> domain_;
  std::int32_t participant_ = 0, waitset_ = 0;
};

/// Reliable, the newest `depth` samples kept for repair.
struct PlainQos {
  int depth = 10;
  bool latched = false;  ///< late joiners get what is kept
};

/// Ends with its participant, as readers do.
class PlainWriter {
 public:
  /// Throws std::runtime_error in one sentence.
  PlainWriter(PlainParticipant& participant, const std::string& topic, const dds_topic_descriptor& type,
              const PlainQos& qos = {});
  /// `sample`: of the topic's type. Never waits for a reader; false if it was not sent.
  bool write(const void* sample);
  int readers() const;  ///< matched
  Guid guid() const;

 private:
  std::int32_t writer_;
};

class PlainReader {
 public:
  /// Throws std::runtime_error in one sentence.
  PlainReader(PlainParticipant& participant, const std::string& topic, const dds_topic_descriptor& type,
              const PlainQos& qos = {});
  /// Hands the next sample that waits to `receive`; false if there is none.
  bool take(const std::function<void(const void*)>& receive);
  Guid guid() const;

 private:
  std::int32_t reader_;
};

}  // namespace palpate
