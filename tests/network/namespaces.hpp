#pragma once
#include <string>

namespace palpate::testing {

/// A network namespace of this process's own. It has no name: the kernel removes it, with its devices, once the last
/// program in it has ended and the last descriptor is closed, so that nothing is left behind even by a crash.
class NetworkNamespace {
 public:
  NetworkNamespace();  ///< Throws std::runtime_error with the reason where it is not permitted.
  ~NetworkNamespace();
  NetworkNamespace(const NetworkNamespace&) = delete;
  NetworkNamespace& operator=(const NetworkNamespace&) = delete;

  /// A path that names it to `ip link set DEVICE netns PATH`.
  std::string path() const;
  int descriptor() const { return descriptor_; }
  /// Runs `ip ARGUMENTS` in it. Throws std::runtime_error with what `ip` said if it fails.
  void ip(const std::string& arguments) const;

 private:
  int descriptor_ = -1;
};

/// While it lives, this thread is in the namespace, with the sockets it opens and the programs and threads it starts.
class Inside {
 public:
  explicit Inside(const NetworkNamespace& space);
  ~Inside();
  Inside(const Inside&) = delete;
  Inside& operator=(const Inside&) = delete;

 private:
  int before_;
};

}  // namespace palpate::testing
