// What the live view's server does with pages that are none, and with floods.
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <ctime>
#include <list>

#include "tests/sanitized.hpp"
#include "tests/web/web_server.hpp"

namespace palpate::web {
namespace {

/// [s] of processor time that the threads beside this one have had.
double others_cpu() {
  const auto seconds = [](clockid_t clock) {
    timespec time{};
    clock_gettime(clock, &time);
    return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
  };
  return seconds(CLOCK_PROCESS_CPUTIME_ID) - seconds(CLOCK_THREAD_CPUTIME_ID);
}

/// This process can open nothing more.
class NoDescriptorLeft {
 public:
  NoDescriptorLeft() {
    const int next = dup(STDIN_FILENO);
    close(next);
    getrlimit(RLIMIT_NOFILE, &before_);
    const rlimit none{static_cast<rlim_t>(next), before_.rlim_max};
    setrlimit(RLIMIT_NOFILE, &none);
  }
  ~NoDescriptorLeft() { setrlimit(RLIMIT_NOFILE, &before_); }

 private:
  rlimit before_{};
};

class WebServerAbuse : public WebServer {};

TEST_F(WebServerAbuse, WhatIsNoMessageThrowsThePageOut) {
  using namespace std::string_literals;
  const std::array bad_ones{"xxxxx"s,
                            std::string(8, '\0'),
                            std::string(33, '\1'),
                            std::string(1 << 20, '\1'),
                            ""s,
                            "\2\xff\0\0\0\0\0\0"s,       // of tool 255, where there is one
                            "\2\0\7\0\0\0\0\0"s,         // with reserved bits
                            "\6\1\0\0\0\0\0\0"s,         // a rest, which is of no tool
                            "\5\0\0\0\0\x28\x6b\xee"s};  // 4e9 frames taken, where none has been sent
  for (const std::string& bad : bad_ones) {
    Client client(server_.port());
    ASSERT_TRUE(client.enter());
    client.read();
    client.write(bad);
    EXPECT_FALSE(client.read()) << bad.size() << " bytes";
  }
  EXPECT_TRUE(within(10s, [&] { return server_.seen().malformed == bad_ones.size() && server_.seen().viewers == 0; }));
  EXPECT_EQ(said_, 0);
}

TEST_F(WebServerAbuse, ASampleWhoseNumberIsNoHigherThanTheLastOnesThrowsThePageOut) {
  std::uint64_t thrown_out = 0;
  for (const std::uint32_t next : {640u, 64u}) {
    Client page(server_.port());
    ASSERT_TRUE(page.enter());
    page.read();
    EXPECT_TRUE(page.sample(640) && page.sample(704) && page.sample(next));
    EXPECT_FALSE(page.read()) << next;
    EXPECT_TRUE(within(10s, [&] { return server_.seen().malformed == thrown_out + 1; }));
    ++thrown_out;
  }
}

TEST_F(WebServerAbuse, AFrameThatIsNoneThrowsThePageOut) {
  using namespace std::string_literals;
  const std::array bad{"\x82\x05hello"s,                               // not masked
                       "\x82\xff\x80\0\0\0\0\0\0\0mask"s,              // of 2^63 bytes
                       "\xf2\x81mask1"s,                               // with reserved bits
                       "\x89\xfe\0\x82mask"s + std::string(130, 'x'),  // a ping that is too long
                       "\x83\x81mask1"s};                              // of a kind that is none
  for (const std::string& frame : bad) {
    Client client(server_.port());
    ASSERT_TRUE(client.enter());
    client.read();
    boost::asio::write(client.line(), boost::asio::buffer(frame));
    EXPECT_FALSE(client.read()) << frame.size() << " bytes";
  }
  EXPECT_TRUE(within(10s, [&] { return server_.seen().malformed == bad.size() && server_.seen().viewers == 0; }))
      << server_.seen().malformed;
}

TEST_F(WebServerAbuse, AFloodThrowsThePageOutAndOthersGoOn) {
  Client good(server_.port()), bad(server_.port());
  ASSERT_TRUE(good.enter() && bad.enter());
  good.read();
  std::string take(8, '\0');
  take[0] = 2;
  const auto begin = Clock::now();
  for (int i = 0; i < 2000 && bad.write(take); ++i) {
  }
  EXPECT_TRUE(within(10s, [&] { return server_.seen().malformed == 1; }));
  EXPECT_TRUE(within(10s, [&] { return gone_ == 1; }));
  EXPECT_LE(said_, 500 * (1 + (Clock::now() - begin) / 1s)) << "in each second";
  show(7);
  EXPECT_EQ(number_of(*good.read()), 7u);
}

TEST_F(WebServerAbuse, AFloodOfPingsThrowsThePageOut) {
  Client page(server_.port());
  ASSERT_TRUE(page.enter());
  page.read();
  for (int i = 0; i < 2000 && page.ping(); ++i) {
  }
  EXPECT_TRUE(within(10s, [&] { return server_.seen().malformed == 1 && server_.seen().viewers == 0; }));
}

TEST_F(WebServerAbuse, AMessageOfManyFramesWithoutAnEndCostsLittle) {
  Client page(server_.port());
  ASSERT_TRUE(page.enter());
  page.read();
  std::string frames;
  for (int i = 0; i < 1000; ++i) frames += std::string("\0\x80\0\0\0\0", 6);
  boost::asio::write(page.line(), boost::asio::buffer(std::string("\x02\x80\0\0\0\0", 6)));
  page.line().non_blocking(true);
  const double before = others_cpu();
  std::size_t at = 0;
  for (const auto end = Clock::now() + 1s; Clock::now() < end;) {
    beast::error_code error;
    at += page.line().write_some(boost::asio::buffer(frames) + at, error);
    at %= frames.size();
    if (error) std::this_thread::sleep_for(1ms);
  }
  EXPECT_LT(others_cpu() - before, 0.2);
}

TEST_F(WebServerAbuse, APingOfThePageItselfIsNoAnswerOfItsBrowser) {
  Client page(server_.port());
  ASSERT_TRUE(page.enter());
  page.read();
  page.sample(64);
  const auto ping_for = [&](std::chrono::milliseconds time) {
    for (const auto end = Clock::now() + time; Clock::now() < end; std::this_thread::sleep_for(20ms)) page.ping();
  };
  ping_for(300ms);
  const int before = said_;
  ping_for(300ms);
  EXPECT_EQ(said_, before);
}

TEST_F(WebServerAbuse, BytesThatAreNoRequestAreDropped) {
  for (int i = 0; i < 20; ++i) {
    boost::asio::io_context context;
    tcp::socket socket(context);
    socket.connect(address());
    boost::system::error_code ignored;
    boost::asio::write(socket, boost::asio::buffer(std::string(20'000, static_cast<char>(17 * i))), ignored);
  }
  EXPECT_EQ(Client(server_.port()).get("/", Client(server_.port()).host()), 200u);
}

TEST_F(WebServerAbuse, WhatItDoesNotTakeIsAnswered) {
  const std::string host = "Host: " + Client(server_.port()).host() + "\r\n";
  EXPECT_EQ(answer_to("POST / HTTP/1.1\r\n" + host + "Content-Length: 2\r\n\r\nab"), "HTTP/1.1 405");
  EXPECT_EQ(answer_to("DELETE / HTTP/1.1\r\n" + host + "\r\n"), "HTTP/1.1 405");
  EXPECT_EQ(answer_to("GET / HTTP/9.9\r\n" + host + "\r\n").substr(9), "400");
  EXPECT_EQ(answer_to("nonsense\r\n\r\n").substr(9), "400");
  EXPECT_EQ(server_.seen().refused, 4u);
}

TEST_F(WebServerAbuse, ConnectionsThatAskForNothingGiveWayToNewOnes) {
  boost::asio::io_context context;
  std::list<tcp::socket> idle;
  for (int i = 0; i < 300; ++i) idle.emplace_back(context).connect(address());
  Client client(server_.port());
  EXPECT_EQ(client.get("/", client.host()), 200u);
  const auto is_open = [](tcp::socket& socket) {
    char byte;
    beast::error_code error;
    socket.non_blocking(true);
    socket.read_some(boost::asio::buffer(&byte, 1), error);
    return error == boost::asio::error::would_block;
  };
  // Before they are ten seconds old, when all of them are closed.
  EXPECT_TRUE(within(5s, [&] { return std::ranges::count_if(idle, is_open) <= 127; }));
  EXPECT_TRUE(is_open(idle.back()));
}

TEST_F(WebServerAbuse, ARequestThatComesByteByByteIsClosedAfterTenSeconds) {
  boost::asio::io_context context;
  tcp::socket slow(context);
  slow.connect(address());
  const auto begin = Clock::now();
  const auto drip = [&] {
    beast::error_code error;
    boost::asio::write(slow, boost::asio::buffer("G", 1), error);
    return static_cast<bool>(error);
  };
  while (!drip() && Clock::now() < begin + 25s) std::this_thread::sleep_for(200ms);
  EXPECT_GT(Clock::now() - begin, 9s);
  EXPECT_LT(Clock::now() - begin, 20s);
  EXPECT_EQ(server_.seen().refused, 1u);
}

TEST_F(WebServerAbuse, WithoutDescriptorsItWaitsForSome) {
  if (testing::kSanitized) GTEST_SKIP() << "a sanitizer that looks at an object's type needs descriptors for it";
  boost::asio::io_context context;
  tcp::socket socket(context, tcp::v4());
  {
    const NoDescriptorLeft none;
    socket.connect(address());
    const double before = others_cpu();
    std::this_thread::sleep_for(500ms);
    EXPECT_LT(others_cpu() - before, 0.1);
  }
  boost::asio::write(socket,
                     boost::asio::buffer(fmt::format("GET / HTTP/1.1\r\nHost: 127.0.0.1:{}\r\n\r\n", server_.port())));
  std::string answer(12, '\0');
  boost::asio::read(socket, boost::asio::buffer(answer));
  EXPECT_EQ(answer, "HTTP/1.1 200");
}

}  // namespace
}  // namespace palpate::web
