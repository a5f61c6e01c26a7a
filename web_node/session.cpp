#include "web_node/session.hpp"

#include <utility>

#include "common/realtime/clock.hpp"

namespace palpate::web {

namespace websocket = beast::websocket;

Session::Session(tcp::socket&& socket, SessionHost& host, std::uint32_t number, Seat seat)
    : socket_(std::move(socket)), host_(host), number_(number), seat_(std::move(seat)), again_(socket_.get_executor()) {
  beast::get_lowest_layer(socket_).rate_policy().read_limit(kMaxBytesPerSecond);
}

void Session::run(const beast::http::request<beast::http::empty_body>& upgrade) {
  beast::get_lowest_layer(socket_).expires_never();
  websocket::stream_base::timeout timeout{};
  timeout.handshake_timeout = std::chrono::seconds(5);
  timeout.idle_timeout = std::chrono::seconds(6);
  timeout.keep_alive_pings = true;
  socket_.set_option(timeout);
  socket_.read_message_max(kMaxBytesSaid);
  socket_.control_callback([this](websocket::frame_type kind, beast::string_view) { heard_control(kind); });
  socket_.async_accept(upgrade, [self = shared_from_this()](beast::error_code error) {
    if (error) return self->end();
    self->host_.opened(self);
    self->read();
  });
}

void Session::read() {
  socket_.async_read(buffer_, [self = shared_from_this()](beast::error_code error, std::size_t bytes) {
    if (error == websocket::condition::protocol_violation || error == websocket::error::message_too_big ||
        error == websocket::error::buffer_overflow)
      ++self->host_.counts().malformed;
    if (error || self->over_) return self->end();
    self->heard(bytes);
  });
}

void Session::heard(std::size_t bytes) {
  const auto said =
      socket_.got_binary() ? decode({static_cast<const char*>(buffer_.data().data()), bytes}) : std::optional<Said>();
  buffer_.consume(buffer_.size());
  if (!said || !fits(*said) || flooded()) return throw_out();
  hand_.heard(*said, now_ns());
  if (said->kind == Said::taken) {
    taken_ = said->number;
    write_next();
  } else {
    host_.said(*this, *said);
    if (said->kind == Said::sample) stand();
  }
  read();
}

// A ping of the page's own is no answer.
void Session::heard_control(websocket::frame_type kind) {
  if (over_) return;
  if (kind == websocket::frame_type::pong) hand_.answered(now_ns());
  if (flooded()) throw_out();
}

// Says the last sample again and again, and asks the browser whether it is there. What the page says itself begins the
// wait anew.
void Session::stand() {
  again_.expires_after(std::chrono::nanoseconds(StandingHand::kApart));
  again_.async_wait([self = shared_from_this()](beast::error_code error) {
    if (error || self->over_) return;
    const std::int64_t now = now_ns();
    if (!self->hand_.stands(now)) return;
    if (const std::optional<Said> again = self->hand_.again(now)) self->host_.said(*self, *again);
    self->ping();
    self->stand();
  });
}

void Session::ping() {
  if (pinging_) return;
  pinging_ = true;
  socket_.async_ping({}, [self = shared_from_this()](beast::error_code) { self->pinging_ = false; });
}

// Of a tool that there is, of frames that have been sent, and later than the last sample.
bool Session::fits(const Said& said) {
  if (said.kind == Said::taken) return said.number <= sent_;
  if (said.kind == Said::sample && said.number <= std::exchange(number_said_, said.number)) return false;
  return said.kind == Said::rest || said.tool < host_.tools();
}

bool Session::flooded() {
  const std::int64_t now = now_ns();
  if (now - second_ns_ > kNsPerS) {
    second_ns_ = now;
    said_ = 0;
  }
  return ++said_ > kMaxSaidPerSecond;
}

void Session::throw_out() {
  ++host_.counts().malformed;
  end();
}

void Session::offer(Slot slot, const std::shared_ptr<const Message>& message) {
  if (over_) return;
  if (slot == frame && waiting_[slot]) ++host_.counts().skipped;
  waiting_[slot] = message;
  write_next();
}

bool Session::may_send(std::size_t slot) const {
  return waiting_[slot] && (slot != frame || sent_ - taken_ < kInFlight);
}

void Session::write_next() {
  if (going_ || over_) return;
  std::size_t slot = 0;
  while (slot < kSlots && !may_send(slot)) ++slot;
  if (slot == kSlots) return;
  sent_ += slot == frame;
  going_ = std::move(waiting_[slot]);
  waiting_[slot] = nullptr;
  socket_.text(going_->text);
  socket_.async_write(boost::asio::buffer(going_->bytes),
                      [self = shared_from_this()](beast::error_code error, std::size_t) {
                        self->going_ = nullptr;
                        if (error) return self->end();
                        self->write_next();
                      });
}

void Session::end() {
  if (over_) return;
  over_ = true;
  again_.cancel();
  beast::get_lowest_layer(socket_).close();
  host_.closed(*this);
}

}  // namespace palpate::web
