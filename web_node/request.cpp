#include "web_node/request.hpp"

#include <nlohmann/json.hpp>

#include "common/view/shaders.hpp"
#include "web_node/page.hpp"

namespace palpate::web {

namespace http = beast::http;

namespace {

// No request to any other host, and nobody frames the page.
constexpr const char* kPolicy =
    "default-src 'self'; connect-src 'self'; img-src 'self' data: blob:; style-src 'self' 'unsafe-inline'; "
    "frame-ancestors 'none'";

std::string_view view(boost::beast::string_view text) {
  return {text.data(), text.size()};
}

const std::string& shader_file() {
  static const std::string text = [] {
    nlohmann::json all;
    for (const shaders::Source& source : shaders::all()) all[source.name] = source.text;
    return all.dump();
  }();
  return text;
}

}  // namespace

void Request::read() {
  parser_.emplace();
  parser_->header_limit(8192);
  stream_.expires_after(std::chrono::seconds(10));
  http::async_read(stream_, buffer_, *parser_, [self = shared_from_this()](beast::error_code error, std::size_t) {
    if (!error) return self->answer();
    const bool silent = error == beast::error::timeout && !self->parser_->got_some();
    if (error == http::error::end_of_stream || silent) return;
    if (error == http::error::unexpected_body) return self->refuse(http::status::method_not_allowed, "GET alone\n");
    if (error.category() == make_error_code(http::error::bad_version).category())
      return self->refuse(http::status::bad_request, "no request of HTTP/1.1\n");
    ++self->host_.counts().refused;
  });
}

void Request::answer() {
  const auto& request = parser_->get();
  const std::string_view host = view(request[http::field::host]);
  const std::string_view path = host_.door().path(view(request.target()), host);
  if (path.empty()) return refuse(http::status::forbidden, "not for you\n");
  if (path != "/live") return serve(path);
  // Said to all, since a browser tells its page nothing of a WebSocket that was refused.
  if (!host_.room()) return refuse(http::status::service_unavailable, "as many watch as can\n");
  if (!beast::websocket::is_upgrade(request)) return refuse(http::status::bad_request, "a WebSocket is here\n");
  if (!Door::same_origin(view(request[http::field::origin]), host))
    return refuse(http::status::forbidden, "not from that page\n");
  host_.upgrade(stream_.release_socket(), request);
}

void Request::serve(std::string_view path) {
  const auto& request = parser_->get();
  if (request.method() != http::verb::get) return refuse(http::status::method_not_allowed, "GET alone\n");
  const PageFile* file = find_page(path);
  const bool shaders = path == "/shaders.json";
  if (!file && !shaders) return refuse(http::status::not_found, "no such page\n");
  response_ = Response(http::status::ok, request.version());
  const std::string_view type = shaders ? "application/json" : file->type;
  response_.set(http::field::content_type, {type.data(), type.size()});
  response_.body() = shaders ? shader_file() : std::string(file->text);
  send();
}

void Request::refuse(http::status status, const char* why) {
  ++host_.counts().refused;
  response_ = Response(status, parser_->get().version());
  response_.set(http::field::content_type, "text/plain");
  response_.body() = why;
  send();
}

void Request::send() {
  response_.set("Content-Security-Policy", kPolicy);
  response_.set(http::field::cache_control, "no-store");
  response_.set("X-Content-Type-Options", "nosniff");
  response_.set("Referrer-Policy", "no-referrer");
  response_.keep_alive(parser_->get().keep_alive() && response_.result() == http::status::ok);
  response_.prepare_payload();
  http::async_write(stream_, response_, [self = shared_from_this()](beast::error_code error, std::size_t) {
    if (!error && self->response_.keep_alive()) return self->read();
    beast::error_code ignored;
    self->stream_.socket().shutdown(tcp::socket::shutdown_send, ignored);
  });
}

}  // namespace palpate::web
