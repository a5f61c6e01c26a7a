#include <gtest/gtest.h>

#include <csignal>
#include <fstream>
#include <thread>

#include "common/bus/version_watch.hpp"
#include "tests/bus/domain.hpp"
#include "tests/loopback/loopback_scene.hpp"
#include "tests/tools/comes_within.hpp"
#include "tools/shared/child_process.hpp"

namespace palpate {
namespace {

using namespace std::chrono_literals;
using namespace testing;

std::string text_of(const std::filesystem::path& file) {
  std::ifstream in(file);
  return {std::istreambuf_iterator<char>(in), {}};
}

TEST(OlderMessages, AreToldInWordsAndNeverTakenForOurs) {
  const LoopbackScene scene("older", kLinear);
  std::string output;
  ASSERT_EQ(run_command(program("palpate") + " precompute " + scene.scene(), &output), 0) << output;
  const int domain = own_domain();
  const std::string said = scene.folder() / "said";
  ChildProcess deform("deform_node", {"/bin/sh", "-c",
                                      fmt::format("exec {} {} --supervised --domain {} 2>{}", program("deform_node"),
                                                  scene.scene(), domain, said)});
  ASSERT_TRUE(comes_within(20s, [&] { return !deform.take_lines().empty(); })) << "it is ready";
  ChildProcess peer("older_peer", {program("older_peer"), std::to_string(domain), "4"});
  ChildProcess haptic("haptic_node",
                      {program("haptic_node"), scene.scene(), "--domain", std::to_string(domain), "--seconds", "2"});
  const pid_t older = peer.pid();
  ASSERT_TRUE(peer.wait(20s));
  ASSERT_TRUE(haptic.wait(20s));
  deform.interrupt();
  ASSERT_TRUE(deform.wait(5s));
  EXPECT_EQ(deform.status(), 0);
  EXPECT_NE(text_of(said).find(fmt::format(
                "cannot talk with process {}@earlier: its palpate 0.0.9 has other messages (version 0123456789abcdef)",
                older)),
            std::string::npos)
      << text_of(said);
  EXPECT_EQ(text_of(said).find("cannot talk", text_of(said).find("cannot talk") + 1), std::string::npos) << "once";
  EXPECT_EQ(peer.take_lines(), std::vector<std::string>{"readers 0, forces 0"}) << "neither hears the other";
  EXPECT_NE(deform.take_lines().back().find("\"refused\":0"), std::string::npos) << "nothing of it came";
}

TEST(OlderMessages, AreKnownByTheWordsOfTheirParticipant) {
  EXPECT_EQ(version_fault(participant_words()), "");
  EXPECT_EQ(version_fault(""), "");
  EXPECT_EQ(version_fault("another program"), "");
  EXPECT_EQ(version_fault("other;1;2;3"), "");
  const std::string fault = version_fault("palpate;9.9;ffff;1@\n\x1b[2J");
  EXPECT_NE(fault.find("1@??[2J"), std::string::npos)
      << fault << "what comes from outside does not rule the operator's terminal";
}

}  // namespace
}  // namespace palpate
