#pragma once
#include <ctime>
#include <string>

/// Certificates and signatures on the curve P-256 (home of libcrypto). All in memory, as PEM and S/MIME text.
/// Everything throws std::runtime_error in one sentence.
namespace palpate::keys {

/// A private key with the certificate of its public half.
struct Identity {
  std::string key, certificate;
};

struct Period {
  std::time_t from, to;
};

/// Signs itself. `name` is its common name.
Identity make_authority(const std::string& name, const Period& period);
/// A member that the authority vouches for.
Identity make_member(const Identity& authority, const std::string& name, const Period& period);
/// The text with the authority's signature, readable as it is (S/MIME, multipart/signed).
std::string sign(const Identity& authority, const std::string& text);
/// A certificate's subject as permissions name it (RFC 2253).
std::string subject_of(const std::string& certificate);
/// When a certificate ends.
std::time_t end_of(const std::string& certificate);

}  // namespace palpate::keys
