#include "web_node/session.hpp"

#include "common/realtime/clock.hpp"

namespace palpate::web {

namespace websocket = beast::websocket;

Session::Session(tcp::socket&& socket, SessionHost& host, std::uint32_t number)
    : socket_(std::move(socket)), host_(host), number_(number) {}

void Session::run(const beast::http::request<beast::http::empty_body>& upgrade) {
  beast::get_lowest_layer(socket_).expires_never();
  websocket::stream_base::timeout timeout{};
  timeout.handshake_timeout = std::chrono::seconds(5);
  timeout.idle_timeout = std::chrono::seconds(6);
  timeout.keep_alive_pings = true;
  socket_.set_option(timeout);
  socket_.read_message_max(kMaxBytesSaid);
  socket_.async_accept(upgrade, [self = shared_from_this()](beast::error_code error) {
    if (error) return self->end();
    self->host_.opened(self);
    self->read();
  });
}

void Session::read() {
  socket_.async_read(buffer_, [self = shared_from_this()](beast::error_code error, std::size_t bytes) {
    if (error == websocket::error::message_too_big || error == websocket::error::buffer_overflow)
      ++self->host_.counts().malformed;
    if (error) return self->end();
    self->heard(bytes);
  });
}

void Session::heard(std::size_t bytes) {
  const auto said =
      socket_.got_binary() ? decode({static_cast<const char*>(buffer_.data().data()), bytes}) : std::optional<Said>();
  buffer_.consume(buffer_.size());
  if (!said || flooded()) return throw_out();
  if (said->kind == Said::taken) {
    taken_ = std::min(said->number, sent_);
    write_next();
  } else {
    host_.said(*this, *said);
  }
  read();
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
  socket_.async_close(websocket::close_code::policy_error, [self = shared_from_this()](beast::error_code) {});
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

void Session::close() {
  if (over_) return;
  beast::error_code ignored;
  beast::get_lowest_layer(socket_).socket().close(ignored);
}

void Session::end() {
  if (over_) return;
  over_ = true;
  host_.closed(*this);
}

}  // namespace palpate::web
