#include "common/bus/log_writer.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <lcm/eventlog.h>
#include <stdio_ext.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <condition_variable>
#include <cstring>
#include <deque>
#include <mutex>
#include <optional>
#include <stdexcept>
#include <thread>

#include "common/files/atomic_file.hpp"
#include "common/files/file_lock.hpp"
#include "common/realtime/clock.hpp"

namespace palpate {
namespace {

constexpr std::chrono::milliseconds kFlushPeriod{100};
constexpr std::int64_t kRetryPeriodNs = kNsPerS;
constexpr std::size_t kFlushBytes = 1u << 20;
constexpr long kHandBytes = 8 << 20;
constexpr std::chrono::seconds kPatience{3};  // with a disk that stands

std::string reason_for(int error) {
  if (error == ENOSPC || error == EDQUOT) return "no space left";
  if (error == EFBIG) return "file size limit reached";
  return error != 0 ? std::strerror(error) : "write failed";
}

std::filesystem::path folder_of(const std::filesystem::path& file) {
  return file.has_parent_path() ? file.parent_path() : ".";
}

struct Event {
  std::string channel;
  std::int64_t receive_ns;
  Bytes data;
};

}  // namespace

class LogWriter::Impl {
 public:
  Impl(const std::filesystem::path& file, std::size_t queue_bytes, const LogHeader* header, WhenFull when_full,
       Naming naming)
      : queue_limit_(queue_bytes),
        enough_(std::min(queue_bytes / 2, kFlushBytes)),
        when_full_(when_full),
        wall_offset_(wall_ns() - now_ns()) {
    FileLock beginning;
    if (header && (!std::filesystem::exists(file) || std::filesystem::is_regular_file(file))) {
      beginning = FileLock::wait_for(folder_of(file));  // of two that begin at once, the second finds the first
      if (std::filesystem::exists(file)) former_ = FileLock::at_once(file);
      unnamed_.emplace(file);
    }
    log_ = lcm_eventlog_create(unnamed_ ? unnamed_->handle().c_str() : file.c_str(), "w");
    if (!log_) throw std::runtime_error(fmt::format("{}: cannot be written: {}", file.string(), std::strerror(errno)));
    if (unnamed_) flock(fileno(log_->f), LOCK_EX);
    std::setvbuf(log_->f, nullptr, _IOFBF, kFlushBytes);
    if (header) begin(*header, file, naming);
    thread_ = std::thread([this] { run(); });
  }

  ~Impl() { close(); }

  void push(Event event) {
    std::unique_lock lock(mutex_);
    const std::size_t size = event.data.size() + event.channel.size();
    const auto fits = [&] { return queued_bytes_ == 0 || queued_bytes_ + size <= queue_limit_; };
    if (when_full_ == WhenFull::wait) room_.wait(lock, fits);
    if (!fits() && !stands_) stands_ = !room_.wait_for(lock, kPatience, fits);
    if (!fits()) {
      lose(1, "the disk is too slow");
      return;
    }
    stands_ = false;
    queued_bytes_ += size;
    queue_.push_back(std::move(event));
    if (queued_bytes_ > enough_) work_.notify_one();
  }

  void want_footer() {
    const std::lock_guard lock(mutex_);
    footer_ = true;
  }

  void close() {
    {
      const std::lock_guard lock(mutex_);
      stop_ = true;
    }
    work_.notify_one();
    if (thread_.joinable()) thread_.join();
    if (log_) lcm_eventlog_destroy(log_);
    log_ = nullptr;
  }

  bool has_name() const { return !unnamed_; }

  void give_name() {
    if (!unnamed_) return;
    unnamed_->commit();
    unnamed_.reset();
    former_ = {};
  }

  LogStatus status() const {
    const std::lock_guard lock(mutex_);
    return status_;
  }

 private:
  void begin(const LogHeader& header, const std::filesystem::path& file, Naming naming) try {
    Bytes payload;
    encode(header, payload);
    append({kHeaderChannel, header.start_monotonic_ns,
            envelope::wrap(kHeaderChannel, header.start_monotonic_ns, payload)});
    flush();
    if (unnamed_ && status_.lost > 0)
      throw std::runtime_error(fmt::format("{}: cannot be written: {}", file.string(), status_.error));
    std::error_code error;
    if (naming == Naming::at_once || std::filesystem::file_size(file, error) == 0 || error) give_name();
  } catch (...) {
    lcm_eventlog_destroy(log_);
    throw;
  }

  void run() {
    for (bool more = true; more;) {
      std::deque<Event> batch;
      {
        std::unique_lock lock(mutex_);
        work_.wait_for(lock, kFlushPeriod, [&] { return stop_ || queued_bytes_ > enough_; });
        batch.swap(queue_);
        queued_bytes_ = 0;
        more = !stop_;
      }
      room_.notify_one();
      for (const Event& event : batch) append(event);
      flush();
    }
    if (footer_) append_footer();
  }

  void append_footer() {
    retry_at_ = 0;
    const LogStatus now = status();
    const LogFooter footer{now_ns(), now.written, now.lost, now.error};
    Bytes payload;
    encode(footer, payload);
    append(
        {kFooterChannel, footer.stop_monotonic_ns, envelope::wrap(kFooterChannel, footer.stop_monotonic_ns, payload)});
    flush();
  }

  void append(const Event& event) {
    if (now_ns() < retry_at_) {
      const std::lock_guard lock(mutex_);
      lose(1, status_.error);
      return;
    }
    lcm_eventlog_event_t out{};
    out.timestamp = event.receive_ns / 1000 + wall_offset_ / 1000;  // a damaged log may say any time
    out.channel = const_cast<char*>(event.channel.data());
    out.channellen = static_cast<std::int32_t>(event.channel.size());
    out.data = const_cast<std::uint8_t*>(event.data.data());
    out.datalen = static_cast<std::int32_t>(event.data.size());
    errno = 0;
    if (lcm_eventlog_write_event(log_, &out) != 0) {
      give_up(errno, 1);
      return;
    }
    ++unflushed_;
    const std::lock_guard lock(mutex_);
    ++status_.written;
  }

  void flush() {
    errno = 0;
    if (std::fflush(log_->f) != 0) {
      give_up(errno, 0);
      return;
    }
    unflushed_ = 0;
    safe_end_ = std::ftell(log_->f);
    hand_to_disk();
    const std::lock_guard lock(mutex_);
    status_.bytes = safe_end_ > 0 ? static_cast<std::uint64_t>(safe_end_) : 0;
  }

  /// Has the disk write steadily, and takes what it has out of the page cache: a log of many gigabytes would fill the
  /// memory, and then every program waits for room.
  void hand_to_disk() {
    if (safe_end_ - handed_end_ < kHandBytes) return;
    const int file = fileno(log_->f);
    sync_file_range(file, handed_end_, safe_end_ - handed_end_, SYNC_FILE_RANGE_WRITE);
    sync_file_range(file, handed_begin_, handed_end_ - handed_begin_,
                    SYNC_FILE_RANGE_WAIT_BEFORE | SYNC_FILE_RANGE_WRITE | SYNC_FILE_RANGE_WAIT_AFTER);
    posix_fadvise(file, handed_begin_, handed_end_ - handed_begin_, POSIX_FADV_DONTNEED);
    handed_begin_ = handed_end_;
    handed_end_ = safe_end_;
  }

  /// Cuts the file back to the end of the last event that is known to be complete. `failed`: events besides
  /// the unflushed ones that are lost now.
  void give_up(int error, std::uint64_t failed) {
    __fpurge(log_->f);
    std::clearerr(log_->f);
    if (ftruncate(fileno(log_->f), safe_end_) == 0) std::fseek(log_->f, safe_end_, SEEK_SET);
    const std::lock_guard lock(mutex_);
    status_.written -= unflushed_;
    lose(unflushed_ + failed, reason_for(error));
    unflushed_ = 0;
    retry_at_ = now_ns() + kRetryPeriodNs;
  }

  void lose(std::uint64_t events, const std::string& why) {
    status_.lost += events;
    status_.error = why;
  }

  FileLock former_;                    ///< the file of that name, which stays until this one has it
  std::optional<AtomicFile> unnamed_;  ///< until it has its name
  lcm_eventlog_t* log_ = nullptr;
  std::size_t queue_limit_, enough_;  ///< [bytes] that may wait, and at which the thread is woken
  WhenFull when_full_;
  std::int64_t wall_offset_;

  mutable std::mutex mutex_;  // guards the following, up to status_
  std::condition_variable work_, room_;
  std::deque<Event> queue_;
  std::size_t queued_bytes_ = 0;
  bool stop_ = false, footer_ = false;
  bool stands_ = false;  ///< the disk: no room was made for as long as is waited
  LogStatus status_;

  // Of the writing thread alone:
  std::uint64_t unflushed_ = 0;
  long safe_end_ = 0;
  long handed_begin_ = 0, handed_end_ = 0;  ///< what the disk was given last
  std::int64_t retry_at_ = 0;
  std::thread thread_;
};

LogWriter::LogWriter(const std::filesystem::path& file, std::size_t queue_bytes)
    : impl_(std::make_unique<Impl>(file, queue_bytes, nullptr, WhenFull::lose, Naming::at_once)) {}
LogWriter::LogWriter(const std::filesystem::path& file, const LogHeader& header, WhenFull when_full, Naming naming)
    : impl_(std::make_unique<Impl>(file, kQueueLimit, &header, when_full, naming)) {}
LogWriter::~LogWriter() = default;

void LogWriter::write_payload(const std::string& channel, std::int64_t receive_ns, const Bytes& payload) {
  impl_->push({channel, receive_ns, envelope::wrap(channel, receive_ns, payload)});
}

LogStatus LogWriter::finish() {
  impl_->want_footer();
  impl_->close();
  return status();
}

bool LogWriter::has_name() const {
  return impl_->has_name();
}

void LogWriter::give_name() {
  impl_->give_name();
}

LogStatus LogWriter::status() const {
  return impl_->status();
}

}  // namespace palpate
