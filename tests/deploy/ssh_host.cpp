#include "tests/deploy/ssh_host.hpp"

#include <arpa/inet.h>
#include <fmt/format.h>
#include <sys/socket.h>
#include <unistd.h>

#include <fstream>
#include <set>
#include <stdexcept>
#include <thread>

#include "tests/loopback/loopback_scene.hpp"

namespace palpate::testing {
namespace {

namespace fs = std::filesystem;
using namespace std::chrono_literals;

constexpr int kPort = 2222;
constexpr const char* kSshd = "/usr/sbin/sshd";

fs::path new_folder() {
  if (access(kSshd, X_OK) != 0)
    throw std::runtime_error(fmt::format("{} is not there: openssh-server is not installed", kSshd));
  std::string name = fs::temp_directory_path() / "palpate-ssh-XXXXXX";
  if (!mkdtemp(name.data())) throw std::runtime_error("cannot make a temporary folder");
  return name;
}

void make_key(const fs::path& file) {
  std::string said;
  if (run_command(fmt::format("ssh-keygen -q -t ed25519 -N '' -f {}", file.string()), &said) != 0)
    throw std::runtime_error(said);
}

std::string text_of(const fs::path& file) {
  std::ifstream in(file);
  return {std::istreambuf_iterator<char>(in), {}};
}

bool answers(const std::string& address) {
  const int descriptor = socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
  sockaddr_in to{.sin_family = AF_INET, .sin_port = htons(kPort), .sin_addr = {}, .sin_zero = {}};
  inet_pton(AF_INET, address.c_str(), &to.sin_addr);
  const bool connected = connect(descriptor, reinterpret_cast<const sockaddr*>(&to), sizeof to) == 0;
  close(descriptor);
  return connected;
}

/// Started as root, sshd asks for this folder, which its service makes.
bool make_run_folder() {
  std::error_code refused;
  return getuid() == 0 && fs::create_directory("/run/sshd", refused);
}

ChildProcess start(const NetworkNamespace& space, const fs::path& folder) {
  const Inside here(space);
  return ChildProcess("sshd", {kSshd, "-D", "-f", folder / "config", "-E", folder / "log"});
}

}  // namespace

SshHost::SshHost(const NetworkNamespace& space, const std::string& address)
    : folder_(new_folder()), made_run_folder_(make_run_folder()), daemon_([&] {
        fs::create_directory(home());
        make_key(folder_ / "host_key");
        make_key(folder_ / "user_key");
        write("known_hosts", fmt::format("[{}]:{} {}", address, kPort, text_of(folder_ / "host_key.pub")));
        write("config",
              fmt::format("Port {}\nListenAddress {}\nHostKey {}\nAuthorizedKeysFile {}\nPidFile none\nStrictModes no\n"
                          "UsePAM no\nPasswordAuthentication no\nPermitRootLogin prohibit-password\nSetEnv HOME={}\n",
                          kPort, address, (folder_ / "host_key").string(), (folder_ / "user_key.pub").string(),
                          home().string()));
        return start(space, folder_);
      }()) {
  const Inside here(space);
  const auto limit = std::chrono::steady_clock::now() + 5s;
  while (!answers(address)) {
    if (!daemon_.running() || std::chrono::steady_clock::now() > limit)
      throw std::runtime_error("sshd does not start: " + text_of(folder_ / "log"));
    std::this_thread::sleep_for(10ms);
  }
}

SshHost::~SshHost() {
  daemon_.interrupt();
  std::error_code ignored;
  fs::remove_all(folder_, ignored);
  if (made_run_folder_) fs::remove("/run/sshd", ignored);
}

std::string SshHost::ssh() const {
  return fmt::format("ssh -q -F none -p {} -i {} -o IdentitiesOnly=yes -o BatchMode=yes -o UserKnownHostsFile={}",
                     kPort, (folder_ / "user_key").string(), (folder_ / "known_hosts").string());
}

std::string SshHost::listing() const {
  std::set<std::string> names;
  for (const auto& entry : fs::directory_iterator(home())) names.insert(entry.path().filename());
  std::string all;
  for (const std::string& name : names) all += (all.empty() ? "" : " ") + name;
  return all;
}

std::string SshHost::ssh_through(const std::string& name, const std::string& filter) const {
  write(name,
        fmt::format(
            "#!/bin/bash\nif mkdir $0.used 2>/dev/null; then exec {0} \"$@\" < <({1}); else exec {0} \"$@\"; fi\n",
            ssh(), filter));
  fs::permissions(folder_ / name, fs::perms::owner_all);
  return folder_ / name;
}

void SshHost::write(const std::string& file, const std::string& text) const {
  std::ofstream(folder_ / file) << text;
}

int run_in(const NetworkNamespace& space, const std::string& command, std::string& said) {
  const Inside here(space);
  return run_command(command, &said);
}

bool somebody_runs(const std::string& text) {
  for (const auto& entry : fs::directory_iterator("/proc"))
    if (text_of(entry.path() / "cmdline").find(text) != std::string::npos) return true;
  return false;
}

}  // namespace palpate::testing
