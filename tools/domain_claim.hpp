#pragma once
#include <string>

namespace palpate {

/// A DDS domain of this host (its network namespace) that this process has for a run, until the object is gone or the
/// process ends in whatever way: two runs in one domain would write the same topics.
class DomainClaim {
 public:
  static constexpr int kMaxDomain = 230;

  /// Throws std::runtime_error if another run has it.
  explicit DomainClaim(int domain);
  /// The first that no run has, from `from` on. Throws std::runtime_error if there is none.
  static DomainClaim first_free(int from);
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
