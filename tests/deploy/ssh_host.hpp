#pragma once
#include <filesystem>
#include <string>

#include "tests/network/namespaces.hpp"
#include "tools/shared/child_process.hpp"

namespace palpate::testing {

/// An sshd in a network namespace, with keys, a home directory and a port of its own, that ends with this object.
class SshHost {
 public:
  /// Throws std::runtime_error with the reason where there is no sshd, or it cannot start.
  SshHost(const NetworkNamespace& space, const std::string& address);
  ~SshHost();

  /// The ssh command that this host lets in.
  std::string ssh() const;
  /// The home directory of who comes by ssh.
  std::filesystem::path home() const { return folder_ / "home"; }
  /// What lies there, by name.
  std::string listing() const;
  /// A program in place of ssh that sends its standard input through `filter`, the first time.
  std::string ssh_through(const std::string& name, const std::string& filter) const;

 private:
  void write(const std::string& file, const std::string& text) const;

  std::filesystem::path folder_;
  bool made_run_folder_ = false;
  ChildProcess daemon_;
};

/// Runs a command line in a namespace; its exit status, and what it says in `said`.
int run_in(const NetworkNamespace& space, const std::string& command, std::string& said);

/// Whether any process has a text in its command line.
bool somebody_runs(const std::string& text);

}  // namespace palpate::testing
