#pragma once
#include <string>
#include <string_view>

namespace palpate::web {

/// Who may come in. On loopback whoever uses this host; elsewhere who knows the secret, which is the first part of
/// every path.
class Door {
 public:
  /// `secret`: empty for none. `local`: only names of this host are answered, so that a page from elsewhere cannot
  /// reach in by a name that it has pointed here.
  Door(std::string secret, bool local) : secret_(std::move(secret)), local_(local) {}

  /// The path within the page, "/" or "/main.js"; empty for who may not come in. `host`: the request's.
  std::string_view path(std::string_view target, std::string_view host) const;
  /// Whether a page of this origin may talk to us: it came from here.
  static bool same_origin(std::string_view origin, std::string_view host);

 private:
  std::string secret_;
  bool local_;
};

/// 128 random bits as 32 hexadecimal digits.
std::string random_secret();

}  // namespace palpate::web
