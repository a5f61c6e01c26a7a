#include "web_node/server.hpp"

#include <fmt/format.h>

#include <boost/asio/ip/host_name.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <deque>
#include <map>
#include <stdexcept>
#include <thread>
#include <utility>

#include "common/log/log.hpp"
#include "web_node/door.hpp"
#include "web_node/request.hpp"
#include "web_node/session.hpp"

namespace palpate::web {

namespace asio = boost::asio;

namespace {

constexpr std::size_t kMaxRequests = 128;  ///< connections that have not become a page's
constexpr std::chrono::milliseconds kRetry{100};

}  // namespace

struct Server::Impl : SessionHost, RequestHost {
  Impl(const ServerSettings& settings, Listeners heard)
      : listeners(std::move(heard)),
        guard(settings.secret, is_loopback(settings.address)),
        most(settings.max_viewers),
        tool_count(settings.tools),
        acceptor(context,
                 tcp::endpoint(asio::ip::make_address(settings.address), static_cast<unsigned short>(settings.port))) {}

  void accept() {
    acceptor.async_accept([this](beast::error_code error, tcp::socket socket) {
      if (error == asio::error::operation_aborted) return;
      if (error) return accept_later(error);
      admit(std::move(socket));
      accept();
    });
  }

  /// Without a descriptor or memory the next one would fail at once too.
  void accept_later(beast::error_code error) {
    if (!std::exchange(said_why, true))
      log_warning(fmt::format("no new connection until that has passed: {}", error.message()));
    retry.expires_after(kRetry);
    retry.async_wait([this](beast::error_code stopped) {
      if (!stopped) accept();
    });
  }

  /// The oldest request makes room where there are too many: most likely it does not want anything.
  void admit(tcp::socket&& socket) {
    std::erase_if(requests, [](const auto& request) { return request.expired(); });
    if (requests.size() == kMaxRequests) {
      if (const auto oldest = requests.front().lock()) oldest->close();
      requests.pop_front();
    }
    beast::error_code ignored;
    socket.set_option(tcp::no_delay(true), ignored);
    const auto request = std::make_shared<Request>(std::move(socket), *this);
    requests.push_back(request);
    request->read();
  }

  const Door& door() const override { return guard; }
  Counts& counts() override { return counted; }
  int tools() const override { return tool_count; }
  bool room() const override { return seat.use_count() <= most; }
  void upgrade(tcp::socket&& socket, const beast::http::request<beast::http::empty_body>& request) override {
    std::make_shared<Session>(std::move(socket), *this, ++last_number, seat)->run(request);
  }

  void opened(const std::shared_ptr<Session>& session) override {
    sessions[session->number()] = session;
    counted.viewers = static_cast<int>(sessions.size());
    session->offer(hello, std::make_shared<Message>(Message{true, fmt::format(R"({{"you":{}}})", session->number())}));
    for (std::size_t slot = scenery; slot < kSlots; ++slot)
      if (newest[slot]) session->offer(static_cast<Slot>(slot), newest[slot]);
  }
  void closed(Session& session) override {
    if (sessions.erase(session.number()) == 0) return;
    counted.viewers = static_cast<int>(sessions.size());
    listeners.gone(session.number());
  }
  void said(Session& session, const Said& what) override { listeners.said(session.number(), what); }

  Listeners listeners;
  Door guard;
  int most, tool_count;
  Counts counted;
  asio::io_context context{1};
  tcp::acceptor acceptor;
  asio::steady_timer retry{context};
  bool said_why = false;
  std::deque<std::weak_ptr<Request>> requests;  ///< in the order of their connections
  Seat seat = std::make_shared<int>();          ///< one copy here, one with each session
  std::uint32_t last_number = 0;
  std::map<std::uint32_t, std::shared_ptr<Session>> sessions;
  std::array<std::shared_ptr<const Message>, kSlots> newest;
  std::jthread thread;
};

Server::Server(const ServerSettings& settings, Listeners listeners) {
  try {
    impl_ = std::make_unique<Impl>(settings, std::move(listeners));
  } catch (const boost::system::system_error& error) {
    throw std::runtime_error(
        fmt::format("cannot listen at {} port {}: {}", settings.address, settings.port, error.code().message()));
  }
  impl_->accept();
  impl_->thread = std::jthread([this] { impl_->context.run(); });
}

Server::~Server() {
  impl_->context.stop();
}

int Server::port() const {
  return impl_->acceptor.local_endpoint().port();
}

void Server::publish(Slot slot, Message message) {
  auto shared = std::make_shared<const Message>(std::move(message));
  asio::post(impl_->context, [this, slot, shared = std::move(shared)] {
    impl_->newest[slot] = shared;
    for (const auto& [number, session] : std::map(impl_->sessions)) session->offer(slot, shared);
  });
}

Server::Seen Server::seen() const {
  const Counts& c = impl_->counted;
  return {c.viewers, c.refused, c.malformed, c.skipped};
}

std::string host_in_link(const std::string& address) {
  const auto parsed = asio::ip::make_address(address);
  if (parsed.is_unspecified()) return asio::ip::host_name();
  return parsed.is_v6() ? fmt::format("[{}]", address) : address;
}

bool is_loopback(const std::string& address) {
  boost::system::error_code error;
  const auto parsed = asio::ip::make_address(address, error);
  if (error) throw std::runtime_error(fmt::format("'{}' is no address, such as 127.0.0.1", address));
  return parsed.is_loopback();
}

}  // namespace palpate::web
