#pragma once
#include <cstdint>
#include <string>

/// A row of the table of topics, which is generated into idl/topics.hpp.
namespace palpate {

/// Depth of a topic whose writer keeps every sample. Only for what is bounded by itself.
inline constexpr int kKeepAll = 0;

/// Quality of service of a topic. Every writer also asserts a liveliness lease, so that its death shows.
struct Qos {
  bool reliable = true;          ///< lost datagrams are repeated; the writer never waits for a reader
  int depth = 1;                 ///< samples that a writer keeps per key for repair; or keep_all
  bool transient_local = false;  ///< a reader that joins late gets the newest sample of each key, or all that are kept
  int recorder_depth =
      0;  ///< not 0: recorders have a stream of their own, which keeps so many, so that viewers never wait for old ones
};

template <class M>
struct Topic {
  using Message = M;
  const char* name;     ///< on DDS and in logs
  const char* message;  ///< name of the message type
  Qos qos{};
  std::uint32_t writers = 0;  ///< bits of the roles that write
  std::uint32_t readers = 0;  ///< of those that read, besides recorders and observers
  std::uint32_t run_of = 0;   ///< of the only one that writes, where messages carry the run that it is in; or 0
};

/// The name on DDS of the stream that recorders have of their own.
template <class M>
std::string recorders_name(const Topic<M>& topic) {
  return std::string(topic.name) + "/all";
}

}  // namespace palpate
