#pragma once
#include <array>
#include <atomic>
#include <boost/asio/steady_timer.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket.hpp>
#include <cstdint>
#include <memory>
#include <string>

#include "web_node/protocol.hpp"
#include "web_node/standing_hand.hpp"

namespace palpate::web {

namespace beast = boost::beast;
using boost::asio::ip::tcp;

/// What has been turned away, and who is there.
struct Counts {
  std::atomic<int> viewers{0};
  std::atomic<std::uint64_t> refused{0};    ///< requests: wrong path, secret, host or origin, or one page too many
  std::atomic<std::uint64_t> malformed{0};  ///< pages thrown out: messages that are none, too long, or too many
  std::atomic<std::uint64_t> skipped{0};    ///< frames that a page was too slow for
};

class Session;

/// Held by a page as long as it has a socket, whether it is shown anything or not.
using Seat = std::shared_ptr<const void>;

/// What a session tells its server; all on the server's thread.
class SessionHost {
 public:
  virtual ~SessionHost() = default;
  virtual void opened(const std::shared_ptr<Session>& session) = 0;
  virtual void closed(Session& session) = 0;
  virtual void said(Session& session, const Said& said) = 0;
  virtual int tools() const = 0;  ///< that a page may speak of
  virtual Counts& counts() = 0;
};

/// One page's WebSocket. It is sent the newest message of each slot and never has more than kInFlight frames that it
/// has not taken: what it is too slow for is not queued but left out. What it sends is bounded, in messages and control
/// frames together, and in bytes: frames without an end are neither.
class Session : public std::enable_shared_from_this<Session> {
 public:
  static constexpr std::uint32_t kInFlight = 3;
  static constexpr int kMaxSaidPerSecond = 500;
  static constexpr std::size_t kMaxBytesPerSecond = 32'000;  ///< what comes sooner waits in the network

  Session(tcp::socket&& socket, SessionHost& host, std::uint32_t number, Seat seat);

  std::uint32_t number() const { return number_; }
  void run(const beast::http::request<beast::http::empty_body>& upgrade);
  void offer(Slot slot, const std::shared_ptr<const Message>& message);

 private:
  using Stream = beast::basic_stream<tcp, boost::asio::any_io_executor, beast::simple_rate_policy>;

  void read();
  void heard(std::size_t bytes);
  void heard_control(beast::websocket::frame_type kind);
  bool fits(const Said& said);
  bool flooded();
  void stand();
  void ping();
  void write_next();
  bool may_send(std::size_t slot) const;
  void throw_out();
  void end();

  beast::websocket::stream<Stream> socket_;
  SessionHost& host_;
  std::uint32_t number_;
  Seat seat_;
  beast::flat_buffer buffer_;
  std::array<std::shared_ptr<const Message>, kSlots> waiting_;
  std::shared_ptr<const Message> going_;
  std::uint32_t sent_ = 0, taken_ = 0;  ///< frames
  std::uint32_t number_said_ = 0;       ///< of its last sample
  int said_ = 0;                        ///< in the second that began at second_ns_
  std::int64_t second_ns_ = 0;
  StandingHand hand_;
  boost::asio::steady_timer again_;
  bool pinging_ = false;
  bool over_ = false;
};

}  // namespace palpate::web
