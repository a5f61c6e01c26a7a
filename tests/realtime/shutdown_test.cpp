#include "common/realtime/shutdown.hpp"

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

namespace palpate {
namespace {

TEST(Shutdown, ASignalSetsTheFlag) {
  for (int signal : {SIGINT, SIGTERM, SIGHUP}) {
    clear_shutdown();
    ::signal(signal, SIG_DFL);
    catch_shutdown_signals();
    EXPECT_FALSE(shutdown_requested());
    raise(signal);
    EXPECT_TRUE(shutdown_requested());
  }
  clear_shutdown();
}

TEST(Shutdown, AHangUpThatIsIgnoredStaysSo) {
  clear_shutdown();
  signal(SIGHUP, SIG_IGN);  // as nohup does
  catch_shutdown_signals();
  raise(SIGHUP);
  EXPECT_FALSE(shutdown_requested());
  signal(SIGHUP, SIG_DFL);
}

TEST(Shutdown, ATerminationAfterAnInterruptIsNoSecondInterrupt) {
  clear_shutdown();
  catch_shutdown_signals();
  raise(SIGINT);
  raise(SIGTERM);
  raise(SIGTERM);
  EXPECT_TRUE(shutdown_requested());
  clear_shutdown();
}

TEST(Shutdown, AnInterruptThatTheParentPassesOnIsNoSecondOne) {
  sigset_t ready;
  sigemptyset(&ready);
  sigaddset(&ready, SIGUSR1);
  sigprocmask(SIG_BLOCK, &ready, nullptr);
  const pid_t child = fork();
  if (child == 0) {
    clear_shutdown();
    catch_shutdown_signals();
    raise(SIGINT);
    kill(getppid(), SIGUSR1);
    for (int i = 0; i < 50; ++i) usleep(10'000);
    _exit(shutdown_requested() ? 7 : 1);
  }
  int signal = 0;
  sigwait(&ready, &signal);
  kill(child, SIGINT);
  kill(child, SIGINT);
  int status = 0;
  waitpid(child, &status, 0);
  ASSERT_TRUE(WIFEXITED(status));
  EXPECT_EQ(WEXITSTATUS(status), 7);
}

TEST(Shutdown, ASecondInterruptEndsTheProcess) {
  EXPECT_EXIT(
      {
        clear_shutdown();
        catch_shutdown_signals();
        raise(SIGINT);
        raise(SIGINT);
        _exit(0);
      },
      ::testing::ExitedWithCode(130), "");
}

TEST(Shutdown, AnyThreadMayAskForIt) {
  clear_shutdown();
  request_shutdown();
  EXPECT_TRUE(shutdown_requested());
  clear_shutdown();
  EXPECT_FALSE(shutdown_requested());
}

}  // namespace
}  // namespace palpate
