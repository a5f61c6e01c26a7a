#include "tests/network/namespaces.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sched.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <stdexcept>
#include <thread>

#include "tests/loopback/loopback_scene.hpp"

namespace palpate::testing {
namespace {

int own_namespace() {
  return open("/proc/thread-self/ns/net", O_RDONLY | O_CLOEXEC);
}

void enter(int descriptor) {
  if (setns(descriptor, CLONE_NEWNET) != 0)
    throw std::runtime_error(fmt::format("cannot enter a network namespace: {}", std::strerror(errno)));
}

}  // namespace

NetworkNamespace::NetworkNamespace() {
  int error = 0;
  std::thread([&] {
    if (unshare(CLONE_NEWNET) == 0) descriptor_ = own_namespace();
    if (descriptor_ < 0) error = errno;
  }).join();
  if (descriptor_ < 0)
    throw std::runtime_error(fmt::format("this process may not make network namespaces: {}", std::strerror(error)));
  ip("link set lo up");
}

NetworkNamespace::~NetworkNamespace() {
  close(descriptor_);
}

std::string NetworkNamespace::path() const {
  return fmt::format("/proc/{}/fd/{}", getpid(), descriptor_);
}

void NetworkNamespace::ip(const std::string& arguments) const {
  const Inside here(*this);
  std::string said;
  if (run_command("ip " + arguments, &said) != 0)
    throw std::runtime_error(fmt::format("`ip {}` failed: {}", arguments, said));
}

Inside::Inside(const NetworkNamespace& space) : before_(own_namespace()) {
  enter(space.descriptor());
}

Inside::~Inside() {
  enter(before_);
  close(before_);
}

}  // namespace palpate::testing
