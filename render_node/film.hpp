#pragma once
#include <condition_variable>
#include <deque>
#include <filesystem>
#include <mutex>
#include <string>
#include <thread>

#include "common/files/atomic_file.hpp"
#include "render_node/image.hpp"

namespace palpate {

/// An MP4 (H.264) of constant frame rate, made by an ffmpeg process that is fed through a pipe. The film
/// grows under a temporary name and gets its own by finish(); without finish() nothing stays.
class Film {
 public:
  /// Starts ffmpeg. Throws std::runtime_error if it is not installed or `file` cannot be written.
  Film(std::filesystem::path file, int width, int height, double frames_per_second);
  ~Film();
  Film(const Film&) = delete;

  /// Appends the picture `times` times; it has the film's size. Waits while full(). Throws std::runtime_error
  /// with ffmpeg's words if ffmpeg has died.
  void add(const Image& image, int times = 1);
  /// True if add() would wait; a live loop then lets the next picture stand for this one too.
  bool full() const;
  /// Ends the film and gives it its name. Throws std::runtime_error, leaving nothing.
  void finish();

  long frames() const { return frames_; }
  double rate() const { return rate_; }

 private:
  struct Entry {
    Image image;
    int times;
  };

  void start();
  void write_entries();
  bool write_all(const std::uint8_t* data, std::size_t size);
  void stop_writer();
  int wait_for_ffmpeg();
  std::string last_words() const;
  [[noreturn]] void fail(const std::string& reason) const;

  std::filesystem::path file_;
  AtomicFile whole_;
  int width_, height_;
  double rate_;
  long frames_ = 0;
  int ffmpeg_ = -1;      ///< process id, -1: none
  int pipe_ = -1;        ///< into ffmpeg
  int complaints_ = -1;  ///< memory file that takes ffmpeg's error output

  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<Entry> queue_;
  std::vector<Image> spare_;  ///< pictures to use again
  bool closing_ = false, broken_ = false;
  std::thread writer_;
};

}  // namespace palpate
