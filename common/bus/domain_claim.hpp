#pragma once
#include <string>

namespace palpate {

/// A DDS domain of this host (its network namespace) that this process has, until the object is gone or the process
/// ends in whatever way: two runs in one domain would write the same topics.
class DomainClaim {
 public:
  static constexpr int kMaxDomain = 230;

  /// For a run. Throws std::runtime_error if another run has it.
  explicit DomainClaim(int domain);
  /// For a run: the first from `from` on that neither a run nor a haptic node has. Throws std::runtime_error if there
  /// is none.
  static DomainClaim first_free(int from);
  /// For a haptic node, beside what its run has: a node that was started by hand, or whose run was killed, is in no
  /// run's. Where another node has it nothing is held: it is for Presence to refuse this one.
  static DomainClaim of_haptic_node(int domain);
  ~DomainClaim();
  DomainClaim(DomainClaim&& other) noexcept;
  DomainClaim(const DomainClaim&) = delete;

  int domain() const { return domain_; }

 private:
  DomainClaim(int domain, int socket) : domain_(domain), socket_(socket) {}

  int domain_, socket_;
};

/// The domain that a command line asks for. Throws std::runtime_error if it is no number from 0 to kMaxDomain.
int parse_domain(const std::string& text);

}  // namespace palpate
