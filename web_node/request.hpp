#pragma once
#include <memory>
#include <optional>

#include "web_node/door.hpp"
#include "web_node/session.hpp"

namespace palpate::web {

class RequestHost {
 public:
  virtual ~RequestHost() = default;
  virtual const Door& door() const = 0;
  virtual Counts& counts() = 0;
  virtual bool room() const = 0;  ///< for one more page
  virtual void upgrade(tcp::socket&& socket, const beast::http::request<beast::http::empty_body>& request) = 0;
};

/// One connection that asks for files of the page, until it asks for the WebSocket "/live" or has been silent for ten
/// seconds.
class Request : public std::enable_shared_from_this<Request> {
 public:
  Request(tcp::socket&& socket, RequestHost& host) : stream_(std::move(socket)), host_(host) {}
  void read();
  void close() { stream_.close(); }

 private:
  using Response = beast::http::response<beast::http::string_body>;
  void answer();
  void serve(std::string_view path);
  void refuse(beast::http::status status, const char* why);
  void send();

  beast::tcp_stream stream_;
  RequestHost& host_;
  beast::flat_buffer buffer_{16384};
  std::optional<beast::http::request_parser<beast::http::empty_body>> parser_;
  Response response_;
};

}  // namespace palpate::web
