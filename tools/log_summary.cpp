#include "tools/log_summary.hpp"

#include <algorithm>
#include <set>

#include "common/bus/runs_at_once.hpp"
#include "common/bus/sequence.hpp"
#include "common/bus/thinning.hpp"
#include "idl/topics.hpp"
#include "tools/logs/scene_title.hpp"

namespace palpate {
namespace {

class Summariser {
 public:
  explicit Summariser(LogSummary& summary) : summary_(summary) {}

  void add(const LogEvent& event) {
    runs_.add(event);
    bool known = false;
    topics::for_each([&](const auto& topic) {
      if (event.channel != topic.name) return;
      known = true;
      add(topic, event);
    });
    summary_.unknown += !known;
  }

  void finish() {
    summary_.runs_at_once = runs_.text();
    for (auto& [name, topic] : summary_.topics) {
      const SequenceCheck& check = sequences_[name];
      topic.streams = check.streams();
      if (summary_.thinned_steps > 0 && may_be_thin_.contains(name)) continue;
      topic.gaps = check.gaps();
      topic.missing = check.missing();
      topic.repeated = check.repeated();
    }
  }

 private:
  template <class M>
  void add(const Topic<M>& topic, const LogEvent& event) {
    TopicSummary& t = summary_.topics[topic.name];
    M message;
    if (!event.read(topic, message)) {
      ++t.invalid;
      return;
    }
    if (t.samples++ == 0) t.first_ns = event.receive_ns;
    t.last_ns = event.receive_ns;
    sequences_[topic.name].add(message);
    // What a topic keeps for late joiners is old when it comes; that is no latency.
    if (const std::int64_t sense = sense_of(message); sense > 0 && !topic.qos.transient_local) {
      t.to_receive.record(event.receive_ns - sense);
      t.ahead += sense > event.receive_ns;
      if constexpr (requires { message.publish_ns; }) t.to_publish.record(message.publish_ns - sense);
    }
    learn(message);
    summary_.hops.add(message);
    if (Thinning::concerns<M>()) may_be_thin_.insert(topic.name);
  }

  void keep(const TaskRecord& task) {
    const auto same_stream = [&](const TaskRecord& known) { return known.body == task.body && known.run == task.run; };
    const auto known = std::ranges::find_if(summary_.tasks, same_stream);
    if (known == summary_.tasks.end()) {
      summary_.tasks.push_back(task);
    } else if (task.seq >= known->seq) {
      *known = task;
    }
  }

  template <class M>
  void learn(const M& message) {
    if constexpr (std::same_as<M, TaskRecord>) keep(message);
    if constexpr (std::same_as<M, ToolState>) look_for_untold(message);
    if constexpr (requires { message.code_path; }) {
      if (summary_.code_path.empty()) summary_.code_path = message.code_path;
    }
  }

  // What is lost on the way lacks its sequence number; a step that was never told has none.
  void look_for_untold(const ToolState& state) {
    if (state.tool != 0) return;
    const auto [known, is_new] = last_.try_emplace(state.run, state);
    ToolState& last = known->second;
    if (is_new || state.seq <= last.seq || state.step <= last.step) return;
    const std::uint64_t steps = state.step - last.step, told = state.seq - last.seq;
    if (steps > told) summary_.untold_steps += steps - told;
    last = state;
  }

  LogSummary& summary_;
  RunsAtOnce runs_;
  std::map<std::uint64_t, ToolState> last_;  ///< of each run's first tool
  std::map<std::string, SequenceCheck> sequences_;
  std::set<std::string> may_be_thin_;  ///< topics of which a log may leave out messages
};

}  // namespace

double TopicSummary::rate_hz() const {
  if (samples < 2 || last_ns <= first_ns) return 0;
  return static_cast<double>(samples - 1) * 1e9 / static_cast<double>(last_ns - first_ns);
}

LogSummary summarise_log(const std::filesystem::path& file) {
  LogReader reader(file);
  LogSummary summary;
  summary.bytes = reader.size();

  Summariser summariser(summary);
  LogEvent event;
  std::int64_t first = INT64_MAX, last = INT64_MIN;
  while (reader.next(event)) {
    summariser.add(event);
    first = std::min(first, event.receive_ns);
    last = std::max(last, event.receive_ns);
  }
  summary.thinned_steps = reader.thinned_steps();
  summariser.finish();
  summary.has_header = reader.has_header();
  summary.header = reader.header();  // complete now that the scene's event was read
  summary.title = title_of(summary.header.scene);
  if (!summary.header.code_path.empty()) summary.code_path = summary.header.code_path;
  if (last > first) summary.seconds = 1e-9 * static_cast<double>(last - first);
  summary.files = reader.files();
  summary.damage = reader.damage();
  summary.damage_text = reader.damage_text();
  summary.footer = reader.footer();
  return summary;
}

}  // namespace palpate
