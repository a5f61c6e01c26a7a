#pragma once
#include <fmt/format.h>

#include <boost/asio/connect.hpp>
#include <boost/asio/read.hpp>
#include <boost/asio/write.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket.hpp>
#include <chrono>
#include <cstring>
#include <optional>
#include <stdexcept>
#include <string>

namespace palpate::web {

namespace beast = boost::beast;
namespace http = beast::http;
using boost::asio::ip::tcp;

/// A page without a browser, one call after another.
class Client {
 public:
  explicit Client(int port) : port_(port) {
    socket_.next_layer().connect(
        tcp::endpoint(boost::asio::ip::make_address("127.0.0.1"), static_cast<unsigned short>(port)));
  }

  std::string host() const { return fmt::format("127.0.0.1:{}", port_); }

  /// Status of the answer to GET.
  unsigned get(const std::string& target, const std::string& host) {
    http::request<http::empty_body> request(http::verb::get, target, 11);
    request.set(http::field::host, host);
    http::write(socket_.next_layer(), request);
    beast::flat_buffer buffer;
    http::response<http::string_body> response;
    http::read(socket_.next_layer(), buffer, response);
    body = response.body();
    type = std::string(response[http::field::content_type]);
    return response.result_int();
  }

  /// True if the WebSocket is open.
  bool upgrade(const std::string& origin, const std::string& path = "/live") {
    socket_.set_option(beast::websocket::stream_base::decorator(
        [&](beast::websocket::request_type& request) { request.set(http::field::origin, origin); }));
    beast::error_code error;
    socket_.handshake(host(), path, error);
    socket_.binary(true);
    return !error;
  }
  bool enter() { return upgrade("http://" + host()); }

  /// The next message; empty once the other side has closed. Throws where none comes in 20 s.
  std::optional<std::string> read() {
    beast::flat_buffer buffer;
    beast::error_code error = boost::asio::error::would_block;
    socket_.async_read(buffer, [&](beast::error_code how, std::size_t) { error = how; });
    context_.restart();
    context_.run_for(std::chrono::seconds(20));
    if (error == boost::asio::error::would_block) throw std::runtime_error("nothing comes from the server");
    if (error) return {};
    return beast::buffers_to_string(buffer.data());
  }
  bool write(const std::string& bytes) {
    beast::error_code error;
    socket_.write(boost::asio::buffer(bytes), error);
    return !error;
  }
  bool ping() {
    beast::error_code error;
    socket_.ping({}, error);
    return !error;
  }
  /// What goes over the line itself.
  tcp::socket& line() { return socket_.next_layer(); }
  /// Tells that so many frames have been taken.
  bool taken(std::uint32_t count) {
    std::string bytes(8, '\0');
    bytes[0] = 5;
    std::memcpy(bytes.data() + 4, &count, 4);
    return write(bytes);
  }

  /// A hand's sample at the origin.
  bool sample(std::uint32_t number) {
    std::string bytes(32, '\0');
    bytes[0] = 1;
    std::memcpy(bytes.data() + 4, &number, 4);
    return write(bytes);
  }

  std::string body;
  std::string type;  ///< of that

 private:
  int port_;
  boost::asio::io_context context_;
  beast::websocket::stream<tcp::socket> socket_{context_};
};

}  // namespace palpate::web
