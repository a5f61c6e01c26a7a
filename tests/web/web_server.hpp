#pragma once
#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <cstring>
#include <string>
#include <thread>

#include "tests/web/client.hpp"
#include "web_node/server.hpp"

/// A server of the live view, and pages of it.
namespace palpate::web {

using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;

template <class F>
bool within(std::chrono::milliseconds limit, F&& holds) {
  for (const auto end = Clock::now() + limit; Clock::now() < end; std::this_thread::sleep_for(1ms))
    if (holds()) return true;
  return holds();
}

inline std::string numbered(std::uint32_t number, std::size_t bytes = 4096) {
  std::string text(bytes, '\0');
  std::memcpy(text.data(), &number, 4);
  return text;
}
inline std::uint32_t number_of(const std::string& text) {
  std::uint32_t number;
  std::memcpy(&number, text.data(), 4);
  return number;
}

class WebServer : public ::testing::Test {
 protected:
  void show(std::uint32_t number) { server_.publish(frame, {false, numbered(number)}); }
  tcp::endpoint address() const {
    return {boost::asio::ip::make_address("127.0.0.1"), static_cast<unsigned short>(server_.port())};
  }
  /// The first bytes that come back.
  std::string answer_to(const std::string& request) const {
    boost::asio::io_context context;
    tcp::socket socket(context);
    socket.connect(address());
    boost::asio::write(socket, boost::asio::buffer(request));
    std::string answer;
    boost::system::error_code end;
    boost::asio::read(socket, boost::asio::dynamic_buffer(answer), end);
    return answer.substr(0, 12);
  }

  std::atomic<int> said_{0}, gone_{0};
  Server server_{{},
                 {.said = [this](std::uint32_t, const Said&) { ++said_; }, .gone = [this](std::uint32_t) { ++gone_; }}};
};

}  // namespace palpate::web
