#include "tools/stability/guarded_run.hpp"

#include <fmt/format.h>
#include <poll.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <stdexcept>
#include <string>
#include <system_error>
#include <vector>

namespace palpate::stability {
namespace {

using Clock = std::chrono::steady_clock;

// A line of the pipe: outcome, force, energy, note.
std::string packed(const Result& r) {
  std::string note = r.note;
  std::ranges::replace(note, '\n', ' ');
  return fmt::format("{}\t{:.17g}\t{:.17g}\t{}\n", word_of(r.outcome), r.max_force, r.energy_growth, note);
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

/// A point at work in its process.
class Child {
 public:
  Child(const Point& point, std::size_t number) : point_(&point), number_(number), begin_(Clock::now()) {
    int ends[2];
    if (pipe(ends) != 0) throw std::runtime_error("no pipe to a child process");
    process_ = fork();
    if (process_ < 0) throw std::runtime_error("no child process can be started");
    if (process_ == 0) {
      close(ends[0]);
      const std::string text = packed(checked(point));
      const ssize_t written = write(ends[1], text.data(), text.size());
      _exit(written == static_cast<ssize_t>(text.size()) ? 0 : 1);
    }
    close(ends[1]);
    pipe_ = ends[0];
  }

  int answers() const { return pipe_; }
  double seconds() const { return std::chrono::duration<double>(Clock::now() - begin_).count(); }
  double left() const { return point_->limit - seconds(); }  ///< [s]

  /// Takes what the pipe has; true once that has ended.
  bool read_some() {
    char buffer[4096];
    const ssize_t count = read(pipe_, buffer, sizeof buffer);
    if (count > 0) text_.append(buffer, static_cast<std::size_t>(count));
    return count <= 0;
  }

  /// Stops it if it has not ended.
  GuardedRow end(bool late) {
    close(pipe_);
    if (late) kill(process_, SIGKILL);
    int status = 0;
    waitpid(process_, &status, 0);
    Row row{
        .name = point_->name, .parameter = point_->parameter, .value = point_->value, .outcome = "failed", .note = {}};
    if (late)
      row.note = fmt::format("still at work after {:.0f} s", point_->limit);
    else if (WIFSIGNALED(status))
      row.note = fmt::format("ended by signal {}", WTERMSIG(status));
    else if (!unpack(text_, row))
      row.note = "no answer came back";
    return {number_, seconds(), row};
  }

 private:
  const Point* point_;
  std::size_t number_;
  Clock::time_point begin_;
  pid_t process_ = -1;
  int pipe_ = -1;
  std::string text_;
};

/// Waits until one has said something or is late, and takes out those that have ended.
void await(std::vector<Child>& at_work, const std::function<void(const GuardedRow&)>& said) {
  std::vector<pollfd> waits;
  double left = 3600;
  for (const Child& child : at_work) {
    waits.push_back({.fd = child.answers(), .events = POLLIN, .revents = 0});
    left = std::min(left, child.left());
  }
  poll(waits.data(), waits.size(), std::max(0, static_cast<int>(std::ceil(1e3 * left))));
  for (std::size_t i = at_work.size(); i-- > 0;) {
    const bool late = at_work[i].left() <= 0;
    if (!late && (waits[i].revents == 0 || !at_work[i].read_some())) continue;
    const GuardedRow ended = at_work[i].end(late);
    at_work.erase(at_work.begin() + static_cast<std::ptrdiff_t>(i));
    said(ended);
  }
}

}  // namespace

void run_guarded(std::span<const Point> points, int jobs, const std::function<void(const GuardedRow&)>& said) {
  std::vector<Child> at_work;
  for (std::size_t next = 0; next < points.size() || !at_work.empty();) {
    if (next < points.size() && static_cast<int>(at_work.size()) < jobs) {
      at_work.emplace_back(points[next], next);
      ++next;
    } else {
      await(at_work, said);
    }
  }
}

Row run_guarded(const Point& point) {
  Row row;
  run_guarded({&point, 1}, 1, [&](const GuardedRow& ended) { row = ended.row; });
  return row;
}

}  // namespace palpate::stability
