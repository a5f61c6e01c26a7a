#include "render_node/film.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <signal.h>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <stdexcept>

namespace palpate {
namespace {

constexpr std::size_t kQueueLength = 6;
constexpr int kFilmDescriptor = 3;  // in ffmpeg
constexpr int kEncoderNice = 5;     // pictures may wait, the haptic loop and the renderer may not

/// It opens the film by its descriptor, more than once: no name is given that could mean something else to it, or to
/// which somebody could have put a link.
std::vector<std::string> ffmpeg_arguments(int width, int height, double rate) {
  // H.264 in 4:2:0 wants even sides.
  const std::string filter = fmt::format("scale=out_color_matrix=bt709:out_range=tv,format=yuv444p,pad={}:{}",
                                         (width + 1) / 2 * 2, (height + 1) / 2 * 2);
  return {"ffmpeg",
          "-y",
          "-nostdin",
          "-loglevel",
          "error",
          "-f",
          "rawvideo",
          "-pix_fmt",
          "rgb0",
          "-video_size",
          fmt::format("{}x{}", width, height),
          "-framerate",
          fmt::format("{:.6g}", rate),
          "-i",
          "pipe:0",
          "-an",
          "-vf",
          filter,
          "-c:v",
          "libx264",
          "-preset",
          "veryfast",
          "-crf",
          "18",
          "-pix_fmt",
          "yuv420p",
          "-colorspace",
          "bt709",
          "-color_primaries",
          "bt709",
          "-color_trc",
          "bt709",
          "-movflags",
          "+faststart",
          "-f",
          "mp4",
          fmt::format("file:/proc/self/fd/{}", kFilmDescriptor)};
}

/// Starts ffmpeg with the given standard input and error and the film, in a process group of its own: a Ctrl-C at the
/// terminal ends the node, which then ends the film properly. Returns 0 or an error number.
int spawn_ffmpeg(const std::vector<std::string>& arguments, int input, int error, int film, int& process) {
  std::vector<char*> argv;
  for (const std::string& a : arguments) argv.push_back(const_cast<char*>(a.c_str()));
  argv.push_back(nullptr);

  posix_spawn_file_actions_t files;
  posix_spawn_file_actions_init(&files);
  posix_spawn_file_actions_adddup2(&files, input, STDIN_FILENO);
  posix_spawn_file_actions_addopen(&files, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
  posix_spawn_file_actions_adddup2(&files, error, STDERR_FILENO);
  posix_spawn_file_actions_adddup2(&files, film, kFilmDescriptor);  // last: the others may have this number here
  posix_spawnattr_t attributes;
  posix_spawnattr_init(&attributes);
  sigset_t none, all;
  sigemptyset(&none);
  sigfillset(&all);
  posix_spawnattr_setsigmask(&attributes, &none);
  posix_spawnattr_setsigdefault(&attributes, &all);
  posix_spawnattr_setpgroup(&attributes, 0);
  posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF | POSIX_SPAWN_SETPGROUP);
  pid_t pid = -1;
  const int result = posix_spawnp(&pid, "ffmpeg", &files, &attributes, argv.data(), environ);
  posix_spawnattr_destroy(&attributes);
  posix_spawn_file_actions_destroy(&files);
  process = pid;
  return result;
}

}  // namespace

Film::Film(std::filesystem::path file, int width, int height, double frames_per_second)
    : file_(std::move(file)), whole_(file_), width_(width), height_(height), rate_(frames_per_second) {
  start();
}

void Film::start() {
  int ends[2];
  complaints_ = ::memfd_create("ffmpeg", MFD_CLOEXEC);
  if (complaints_ < 0 || ::pipe2(ends, O_CLOEXEC) != 0) fail(std::strerror(errno));
  const int error =
      spawn_ffmpeg(ffmpeg_arguments(width_, height_, rate_), ends[0], complaints_, whole_.descriptor(), ffmpeg_);
  ::close(ends[0]);
  pipe_ = ends[1];
  if (error != 0) {
    ::close(pipe_);
    ::close(complaints_);
    ffmpeg_ = -1;
    fail(error == ENOENT ? "films need the program ffmpeg, which is not installed" : std::strerror(error));
  }
  ::fcntl(pipe_, F_SETPIPE_SZ, 1 << 20);
  ::setpriority(PRIO_PROCESS, ffmpeg_, kEncoderNice);
  writer_ = std::thread([this] { write_entries(); });
}

Film::~Film() {
  if (ffmpeg_ < 0) return;
  stop_writer();
  ::kill(ffmpeg_, SIGKILL);
  wait_for_ffmpeg();
}

bool Film::full() const {
  const std::scoped_lock lock(mutex_);
  return queue_.size() >= kQueueLength && !broken_;
}

void Film::add(const Image& image, int times) {
  if (image.width != width_ || image.height != height_)
    fail(fmt::format("a film of {} x {} cannot take a picture of {} x {}", width_, height_, image.width, image.height));
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [this] { return queue_.size() < kQueueLength || broken_; });
  if (broken_) {
    lock.unlock();
    stop_writer();
    wait_for_ffmpeg();
    fail("the film ends early: " + last_words());
  }
  Entry entry{{}, times};
  if (!spare_.empty()) {
    entry.image = std::move(spare_.back());
    spare_.pop_back();
  }
  entry.image = image;
  queue_.push_back(std::move(entry));
  frames_ += times;
  changed_.notify_all();
}

bool Film::write_all(const std::uint8_t* data, std::size_t size) {
  while (size > 0) {
    const ssize_t written = ::write(pipe_, data, size);
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) return false;
    data += written;
    size -= static_cast<std::size_t>(written);
  }
  return true;
}

void Film::write_entries() {
  sigset_t all;
  sigfillset(&all);
  pthread_sigmask(SIG_BLOCK, &all, nullptr);  // a dead ffmpeg shows as EPIPE, not as a signal
  std::unique_lock lock(mutex_);
  while (true) {
    changed_.wait(lock, [this] { return !queue_.empty() || closing_; });
    if (queue_.empty()) return;
    Entry& entry = queue_.front();
    lock.unlock();
    bool good = true;
    for (int i = 0; i < entry.times && good; ++i) good = write_all(entry.image.rgba.data(), entry.image.rgba.size());
    lock.lock();
    spare_.push_back(std::move(entry.image));
    queue_.pop_front();
    broken_ = !good;
    changed_.notify_all();
    if (broken_) return;
  }
}

void Film::stop_writer() {
  {
    const std::scoped_lock lock(mutex_);
    closing_ = true;
    changed_.notify_all();
  }
  if (writer_.joinable()) writer_.join();
  if (pipe_ >= 0) ::close(pipe_);
  pipe_ = -1;
}

int Film::wait_for_ffmpeg() {
  int status = 0;
  while (::waitpid(ffmpeg_, &status, 0) < 0 && errno == EINTR) {
  }
  ffmpeg_ = -1;
  return status;
}

void Film::finish() {
  if (ffmpeg_ < 0) return;
  stop_writer();
  const int status = wait_for_ffmpeg();
  if (broken_ || status != 0) fail("the film is lost: " + last_words());
  whole_.commit();
}

std::string Film::last_words() const {
  std::string words(2000, '\0');
  const ssize_t size = ::pread(complaints_, words.data(), words.size(), 0);
  words.resize(size > 0 ? size : 0);
  words = words.substr(0, words.find('\n'));
  return words.empty() ? "ffmpeg was stopped" : "ffmpeg says: " + words;
}

void Film::fail(const std::string& reason) const {
  throw std::runtime_error(fmt::format("{}: {}", file_.string(), reason));
}

}  // namespace palpate
