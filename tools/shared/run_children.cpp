#include "tools/shared/run_children.hpp"

#include <list>
#include <thread>

#include "common/realtime/shutdown.hpp"
#include "tools/shared/child_process.hpp"

namespace palpate {

void run_children(const std::string& name, const std::vector<std::vector<std::string>>& commands, int jobs,
                  const ChildrenSay& say) {
  using namespace std::chrono_literals;
  struct Running {
    std::size_t command;
    ChildProcess process;
    void read(const ChildrenSay& say) {
      for (const std::string& line : process.take_lines()) say.printed(command, line);
    }
  };
  std::list<Running> running;
  std::size_t next = 0;
  while ((next < commands.size() || !running.empty()) && !shutdown_requested()) {
    while (next < commands.size() && static_cast<int>(running.size()) < jobs) {
      running.push_back({next, ChildProcess(name, commands[next])});
      ++next;
    }
    for (auto child = running.begin(); child != running.end();) {
      const bool ended = !child->process.running();
      child->read(say);
      if (ended) say.ended(child->command, child->process.status());
      child = ended ? running.erase(child) : std::next(child);
    }
    std::this_thread::sleep_for(2ms);
  }
}

}  // namespace palpate
