#pragma once
#include <functional>
#include <memory>
#include <string>

#include "web_node/protocol.hpp"

namespace palpate::web {

struct ServerSettings {
  std::string address = "127.0.0.1";
  int port = 0;        ///< 0: any that is free
  std::string secret;  ///< empty: none
  int max_viewers = 16;
  int tools = 1;  ///< of the scene
};

/// What pages say, told on the server's thread.
struct Listeners {
  std::function<void(std::uint32_t page, const Said&)> said;
  std::function<void(std::uint32_t page)> gone;
};

/// Serves the page and talks to it, on a thread of its own. Nothing that a page does or leaves undone holds up who
/// calls publish().
class Server {
 public:
  /// Listens at once. Throws std::runtime_error where it cannot.
  Server(const ServerSettings& settings, Listeners listeners);
  ~Server();

  int port() const;
  /// Every page gets the newest message of each slot, one that comes later too.
  void publish(Slot slot, Message message);

  struct Seen {
    int viewers = 0;
    std::uint64_t refused = 0, malformed = 0, skipped = 0;  ///< requests; pages thrown out; frames left out
  };
  Seen seen() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// How an address stands in a link: this host's name in place of one that means all of its addresses.
std::string host_in_link(const std::string& address);

/// Whether only this host can reach an address. Throws std::runtime_error for what is none.
bool is_loopback(const std::string& address);

}  // namespace palpate::web
