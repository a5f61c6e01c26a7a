#include "web_node/server.hpp"

#include <algorithm>
#include <ctime>
#include <filesystem>
#include <list>

#include "tests/web/web_server.hpp"

namespace palpate::web {
namespace {

constexpr std::uint32_t kInFlight = 3;

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
  EXPECT_EQ(answer_to("GET /live HTTP/1.1\r\nHost: " + clients.front().host() + "\r\n\r\n").substr(9), "503")
      << "what its page asks for then";
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

TEST_F(WebServer, ThePageIsOfItsKind) {
  Client client(server_.port());
  EXPECT_EQ(client.get("/", client.host()), 200u);
  EXPECT_EQ(client.type, "text/html; charset=utf-8");
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
