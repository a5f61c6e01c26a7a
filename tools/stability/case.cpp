#include "tools/stability/case.hpp"

#include <fmt/format.h>
#include <poll.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <stdexcept>
#include <system_error>

namespace palpate::stability {
namespace {

// A line of the pipe: outcome, force, energy, note.
std::string packed(const Result& r) {
  std::string note = r.note;
  std::ranges::replace(note, '\n', ' ');
  return fmt::format("{}\t{:.17g}\t{:.17g}\t{}\n", word_of(r.outcome), r.max_force, r.energy_growth, note);
}

Result checked(const Point& point) {
  try {
    Result r = point.run();
    if (std::isfinite(r.max_force) && std::isfinite(r.energy_growth)) return r;
    return {.outcome = Outcome::failed, .note = "not a number; " + r.note};
  } catch (const std::system_error& error) {  // no file, no thread: that is no refusal
    return {.outcome = Outcome::failed, .note = error.what()};
  } catch (const std::runtime_error& refusal) {
    return {.outcome = Outcome::refused, .note = refusal.what()};
  } catch (const std::exception& error) {
    return {.outcome = Outcome::failed, .note = error.what()};
  }
}

std::string read_until(int pipe, double seconds, bool& late) {
  const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(seconds);
  std::string text;
  char buffer[4096];
  while (true) {
    const auto left =
        std::chrono::duration_cast<std::chrono::milliseconds>(end - std::chrono::steady_clock::now()).count();
    pollfd wait{.fd = pipe, .events = POLLIN, .revents = 0};
    late = left <= 0 || poll(&wait, 1, static_cast<int>(left)) == 0;
    if (late) return text;
    const ssize_t count = read(pipe, buffer, sizeof buffer);
    if (count <= 0) return text;
    text.append(buffer, static_cast<std::size_t>(count));
  }
}

bool unpack(const std::string& text, Row& row) {
  const auto a = text.find('\t'), b = text.find('\t', a + 1), c = text.find('\t', b + 1);
  if (a == text.npos || b == text.npos || c == text.npos || text.back() != '\n') return false;
  row.outcome = text.substr(0, a);
  row.max_force = std::stod(text.substr(a + 1, b - a - 1));
  row.energy_growth = std::stod(text.substr(b + 1, c - b - 1));
  row.note = text.substr(c + 1, text.size() - c - 2);
  return true;
}

}  // namespace

const char* word_of(Outcome outcome) {
  static constexpr const char* kWords[] = {"stable", "regularised", "refused", "failed"};
  return kWords[static_cast<int>(outcome)];
}

Row run_guarded(const Point& point) {
  Row row{.name = point.name, .parameter = point.parameter, .value = point.value, .outcome = "failed", .note = {}};
  int ends[2];
  if (pipe(ends) != 0) throw std::runtime_error("no pipe to a child process");
  const pid_t child = fork();
  if (child < 0) throw std::runtime_error("no child process can be started");
  if (child == 0) {
    close(ends[0]);
    const std::string text = packed(checked(point));
    const ssize_t written = write(ends[1], text.data(), text.size());
    _exit(written == static_cast<ssize_t>(text.size()) ? 0 : 1);
  }
  close(ends[1]);
  bool late = false;
  const std::string text = read_until(ends[0], point.limit, late);
  close(ends[0]);
  if (late) kill(child, SIGKILL);
  int status = 0;
  waitpid(child, &status, 0);
  if (late)
    row.note = fmt::format("still at work after {:.0f} s", point.limit);
  else if (WIFSIGNALED(status))
    row.note = fmt::format("ended by signal {}", WTERMSIG(status));
  else if (!unpack(text, row))
    row.note = "no answer came back";
  return row;
}

std::vector<Point> all_points(const Extent& extent) {
  std::vector<Point> all;
  for (const auto subject : {loop_points, material_points, geometry_points, hold_points, press_points, curve_points,
                             dynamic_points, moving_points, cut_points, hybrid_points, shell_points, catheter_points}) {
    const std::vector<Point> points = subject(extent);
    all.insert(all.end(), points.begin(), points.end());
  }
  return all;
}

}  // namespace palpate::stability
