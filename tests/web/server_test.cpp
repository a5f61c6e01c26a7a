#include "web_node/server.hpp"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <ctime>
#include <filesystem>
#include <list>
#include <thread>

#include "tests/sanitized.hpp"
#include "tests/web/client.hpp"

namespace palpate::web {
namespace {

using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;

constexpr std::uint32_t kInFlight = 3;

template <class F>
bool within(std::chrono::milliseconds limit, F&& holds) {
  for (const auto end = Clock::now() + limit; Clock::now() < end; std::this_thread::sleep_for(1ms))
    if (holds()) return true;
  return holds();
}

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

std::string numbered(std::uint32_t number, std::size_t bytes = 4096) {
  std::string text(bytes, '\0');
  std::memcpy(text.data(), &number, 4);
  return text;
}
std::uint32_t number_of(const std::string& text) {
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

  std::atomic<int> said_{0}, gone_{0};
  Server server_{{},
                 {.said = [this](std::uint32_t, const Said&) { ++said_; }, .gone = [this](std::uint32_t) { ++gone_; }}};
};

TEST_F(WebServer, ServesItsFilesAndNothingElse) {
  Client client(server_.port());
  EXPECT_EQ(client.get("/", client.host()), 200u);
  EXPECT_NE(client.body.find("main.js"), std::string::npos);
  EXPECT_EQ(client.get("/main.js", client.host()), 200u);
  EXPECT_EQ(client.get("/shaders.json", client.host()), 200u);
  EXPECT_NE(client.body.find("scale_colour"), std::string::npos);
  EXPECT_EQ(client.get("/../etc/passwd", client.host()), 404u);
  EXPECT_EQ(Client(server_.port()).get("/", "evil.example"), 403u);
  EXPECT_EQ(Client(server_.port()).get("/live", client.host()), 400u);
  EXPECT_EQ(server_.seen().refused, 3u);
}

TEST_F(WebServer, NoFileOfThePageNamesAnotherHost) {
  Client client(server_.port());
  ASSERT_EQ(client.get("/shaders.json", client.host()), 200u);
  EXPECT_EQ(client.body.find("://"), std::string::npos);
  std::vector<std::string> paths{"/"};
  for (const auto& file : std::filesystem::directory_iterator(PALPATE_SOURCE "/web_node/page"))
    paths.push_back("/" + file.path().filename().string());
  ASSERT_GT(paths.size(), 25u);
  for (const std::string& path : paths) {
    ASSERT_EQ(client.get(path, client.host()), 200u) << path;
    for (const char* elsewhere : {"://", "\"//", "'//", "`//", "(//"})
      EXPECT_EQ(client.body.find(elsewhere), std::string::npos) << path << " " << elsewhere;
  }
}

TEST_F(WebServer, APageFromElsewhereIsRefusedAndCounted) {
  EXPECT_FALSE(Client(server_.port()).upgrade("http://evil.example"));
  EXPECT_FALSE(Client(server_.port()).upgrade(""));
  EXPECT_EQ(server_.seen().refused, 2u);
  EXPECT_TRUE(Client(server_.port()).enter());
}

TEST(WebServerWithSecret, LetsInWhoKnowsIt) {
  Server server({.secret = "0123456789abcdef"}, {[](auto, const auto&) {}, [](auto) {}});
  Client client(server.port());
  EXPECT_EQ(client.get("/0123456789abcdef/", client.host()), 200u);
  EXPECT_EQ(Client(server.port()).get("/", client.host()), 403u);
  EXPECT_EQ(Client(server.port()).get("/0123456789abcdee/", client.host()), 403u);
  const std::string origin = "http://" + client.host();
  EXPECT_FALSE(Client(server.port()).upgrade(origin));
  EXPECT_EQ(server.seen().refused, 3u);
  EXPECT_TRUE(Client(server.port()).upgrade(origin, "/0123456789abcdef/live"));
  EXPECT_EQ(server.seen().refused, 3u);
}

TEST_F(WebServer, APageThatTakesNothingGetsNoQueueButTheNewestOnceItDoes) {
  server_.publish(scenery, {false, "scenery"});
  show(1);
  Client slow(server_.port());
  ASSERT_TRUE(slow.enter());
  EXPECT_TRUE(slow.read()->starts_with("{\"you\":"));
  EXPECT_EQ(slow.read(), "scenery");
  ASSERT_TRUE(within(10s, [&] { return server_.seen().viewers == 1; }));
  EXPECT_EQ(number_of(*slow.read()), 1u);
  for (std::uint32_t i = 2; i <= kInFlight; ++i) {
    show(i);
    EXPECT_EQ(number_of(*slow.read()), i);
  }
  for (std::uint32_t i = kInFlight + 1; i <= 1000; ++i) show(i);
  ASSERT_TRUE(within(10s, [&] { return server_.seen().skipped == 999 - kInFlight; }));
  slow.taken(1);
  EXPECT_EQ(number_of(*slow.read()), 1000u) << "all between are left out";
}

TEST_F(WebServer, SixteenWatchAndASlowOneSlowsNobody) {
  std::list<Client> clients;
  for (int i = 0; i < 16; ++i) ASSERT_TRUE(clients.emplace_back(server_.port()).enter());
  ASSERT_TRUE(within(10s, [&] { return server_.seen().viewers == 16; }));
  EXPECT_FALSE(Client(server_.port()).enter()) << "one too many";
  for (Client& client : clients) client.read();  // its number
  Client& stalled = clients.front();
  std::uint32_t count = 0;
  std::vector<Clock::duration> rounds;
  for (std::uint32_t number = 1; number <= 60; ++number) {
    const auto begin = Clock::now();
    show(number);
    ++count;
    for (auto client = std::next(clients.begin()); client != clients.end(); ++client) {
      EXPECT_EQ(number_of(*client->read()), number);
      client->taken(count);
    }
    rounds.push_back(Clock::now() - begin);
  }
  std::ranges::sort(rounds);
  EXPECT_LT(rounds[rounds.size() / 2], 500ms);
  EXPECT_LT(rounds.back(), 5s) << "a machine that stands";
  EXPECT_EQ(number_of(*stalled.read()), 1u);
}

TEST_F(WebServer, WhatIsNoMessageThrowsThePageOut) {
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

TEST_F(WebServer, AFrameThatIsNoneThrowsThePageOut) {
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

TEST_F(WebServer, ThePageIsOfItsKind) {
  Client client(server_.port());
  EXPECT_EQ(client.get("/", client.host()), 200u);
  EXPECT_EQ(client.type, "text/html; charset=utf-8");
}

TEST_F(WebServer, AFloodThrowsThePageOutAndOthersGoOn) {
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

TEST_F(WebServer, AFloodOfPingsThrowsThePageOut) {
  Client page(server_.port());
  ASSERT_TRUE(page.enter());
  page.read();
  for (int i = 0; i < 2000 && page.ping(); ++i) {
  }
  EXPECT_TRUE(within(10s, [&] { return server_.seen().malformed == 1 && server_.seen().viewers == 0; }));
}

TEST_F(WebServer, AMessageOfManyFramesWithoutAnEndCostsLittle) {
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

TEST_F(WebServer, APingOfThePageItselfIsNoAnswerOfItsBrowser) {
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

TEST_F(WebServer, SaysTheSampleOfASilentPageAgainWhileItsBrowserAnswers) {
  std::optional<Client> page;
  int again = 0;
  // It is said again for a second, of which a busy machine may leave little: then another page is silent.
  for (std::uint32_t i = 1; i <= 5 && again <= 10; ++i) {
    page.emplace(server_.port());
    ASSERT_TRUE(page->enter());
    page->read();
    if (i > 1) page->read();                      // what ended the last page's wait
    std::jthread browser([&] { page->read(); });  // answers, and waits for a message
    const int before = said_;
    page->sample(64);
    within(2s, [&] { return (again = said_ - before) > 10; });
    show(i);
  }
  EXPECT_GT(again, 10);
  const int before = said_;
  ASSERT_TRUE(page->sample(128));  // and now nobody answers
  int seen = before;
  auto since = Clock::now();
  EXPECT_TRUE(within(10s, [&] {
    if (said_ != seen) seen = said_, since = Clock::now();
    return seen > before && Clock::now() > since + 300ms;
  }));
  // 24 ms apart, for 100 ms after the last answer and after the sample: for a whole second there would be forty.
  EXPECT_LE(seen - before, 12);
}

TEST_F(WebServer, BytesThatAreNoRequestAreDropped) {
  for (int i = 0; i < 20; ++i) {
    boost::asio::io_context context;
    tcp::socket socket(context);
    socket.connect(address());
    boost::system::error_code ignored;
    boost::asio::write(socket, boost::asio::buffer(std::string(20'000, static_cast<char>(17 * i))), ignored);
  }
  EXPECT_EQ(Client(server_.port()).get("/", Client(server_.port()).host()), 200u);
}

TEST_F(WebServer, WhatItDoesNotTakeIsAnswered) {
  const auto answer_to = [&](const std::string& request) {
    boost::asio::io_context context;
    tcp::socket socket(context);
    socket.connect(address());
    boost::asio::write(socket, boost::asio::buffer(request));
    std::string answer;
    boost::system::error_code end;
    boost::asio::read(socket, boost::asio::dynamic_buffer(answer), end);
    return answer.substr(0, 12);
  };
  const std::string host = "Host: " + Client(server_.port()).host() + "\r\n";
  EXPECT_EQ(answer_to("POST / HTTP/1.1\r\n" + host + "Content-Length: 2\r\n\r\nab"), "HTTP/1.1 405");
  EXPECT_EQ(answer_to("DELETE / HTTP/1.1\r\n" + host + "\r\n"), "HTTP/1.1 405");
  EXPECT_EQ(answer_to("GET / HTTP/9.9\r\n" + host + "\r\n").substr(9), "400");
  EXPECT_EQ(answer_to("nonsense\r\n\r\n").substr(9), "400");
  EXPECT_EQ(server_.seen().refused, 4u);
}

TEST_F(WebServer, ConnectionsThatAskForNothingGiveWayToNewOnes) {
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

TEST_F(WebServer, ARequestThatComesByteByByteIsClosedAfterTenSeconds) {
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

TEST_F(WebServer, WithoutDescriptorsItWaitsForSome) {
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

TEST(WebServerPort, ThatIsTakenIsSaid) {
  Server first({}, {});
  try {
    Server second({.port = first.port()}, {});
    FAIL();
  } catch (const std::runtime_error& error) {
    EXPECT_NE(std::string(error.what()).find("cannot listen at 127.0.0.1 port"), std::string::npos) << error.what();
  }
  EXPECT_THROW(is_loopback("nowhere"), std::runtime_error);
  EXPECT_TRUE(is_loopback("::1"));
  EXPECT_FALSE(is_loopback("0.0.0.0"));
  EXPECT_EQ(host_in_link("127.0.0.1"), "127.0.0.1");
  EXPECT_EQ(host_in_link("::1"), "[::1]");
  EXPECT_NE(host_in_link("0.0.0.0"), "0.0.0.0");
}

}  // namespace
}  // namespace palpate::web
