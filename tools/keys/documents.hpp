#pragma once
#include <string>

#include "common/bus/roles.hpp"
#include "tools/keys/certificates.hpp"

namespace palpate::keys {

/// How the middleware protects every topic of every domain (DDS Security 1.1, 9.4.1.2): nobody takes part without a
/// certificate and permissions; discovery, liveliness, submessages and data are encrypted.
std::string governance_document();

/// What the holder of a certificate with this subject may do (DDS Security 1.1, 9.4.1.3). What is not named is denied.
/// The grant bears the role's name.
std::string permissions_document(const std::string& role, const std::string& subject, const Rights& rights,
                                 const Period& period);

}  // namespace palpate::keys
