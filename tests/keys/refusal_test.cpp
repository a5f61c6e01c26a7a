#include <gtest/gtest.h>

#include <regex>

#include "common/bus/dds_bus.hpp"
#include "common/bus/security.hpp"
#include "tests/bus/domain.hpp"
#include "tests/keys/own_folder.hpp"
#include "tools/keys/documents.hpp"
#include "tools/keys/key_folder.hpp"

/// Keys that are of no use are refused in one sentence that says why.
namespace palpate::testing {
namespace {

namespace fs = std::filesystem;

class KeyRefusal : public ::testing::Test {
 protected:
  KeyRefusal() { keys::make_folder(keys_, now_and_on()); }

  /// The sentence with which a bus refuses these keys; empty if it joins.
  static std::string refusal(const fs::path& keys, const std::string& role) {
    try {
      make_dds_bus({.domain = own_domain(), .keys = keys, .role = role});
    } catch (const std::runtime_error& error) {
      return error.what();
    }
    return {};
  }
  void expect(const std::string& pattern, const std::string& role = "haptic") const {
    const std::string said = refusal(keys_, role);
    EXPECT_TRUE(std::regex_match(said, std::regex("network: " + pattern))) << said << "\nis not " << pattern;
  }
  void replace(const fs::path& file, const std::string& from, const std::string& to) const {
    std::string text = text_of(file);
    ASSERT_NE(text.find(from), text.npos);
    std::ofstream(file, std::ios::binary) << text.replace(text.find(from), from.size(), to);
  }
  keys::Identity authority() const {
    return {text_of(keys_ / "authority/key.pem"), text_of(keys_ / "authority/certificate.pem")};
  }
  /// Keys of the haptic role whose certificate and permissions hold for periods of their own.
  void renew(const keys::Period& certificate, const keys::Period& permissions) const {
    const keys::Identity member = keys::make_member(authority(), "haptic", certificate);
    std::ofstream(haptic_.certificate) << member.certificate;
    std::ofstream(haptic_.key) << member.key;
    std::ofstream(haptic_.permissions) << keys::sign(
        authority(), keys::permissions_document("haptic", "CN=haptic", rights_of("haptic"), permissions));
  }

  OwnFolder folder_;
  const fs::path keys_ = folder_ / "keys";
  const KeyFiles haptic_ = key_files(keys_ / "haptic");
};

TEST_F(KeyRefusal, GoodKeysJoin) {
  EXPECT_EQ(refusal(keys_, "haptic"), "");
  EXPECT_EQ(refusal(keys_ / "deform", "deform"), "") << "the folder of one role alone";
  const std::string place = make_dds_bus({.domain = own_domain(), .keys = keys_, .role = "haptic"})->place();
  EXPECT_TRUE(place.ends_with(fmt::format(", with the keys in {}", keys_.string()))) << place;
}

TEST_F(KeyRefusal, AnAuthorityThatHasExpired) {
  const std::time_t now = std::time(nullptr);
  const keys::Identity old = keys::make_authority("palpate old", {now - 3 * kDay, now - kDay}),
                       member = keys::make_member(old, "haptic", now_and_on());
  std::ofstream(haptic_.authority) << old.certificate;
  std::ofstream(haptic_.certificate) << member.certificate;
  std::ofstream(haptic_.key) << member.key;
  expect(".*/haptic/certificate.pem or the authority's has expired; `palpate keys` makes new ones");
}

TEST_F(KeyRefusal, NoFolder) {
  fs::rename(keys_, folder_ / "elsewhere");
  expect("there is no folder of keys .*/keys: `palpate keys` makes one, see docs/security.md");
}

TEST_F(KeyRefusal, NoKeysOfTheRole) {
  fs::remove_all(keys_ / "haptic");
  expect(".*/keys holds no keys of the role 'haptic': a folder of that name has to be in it");
}

TEST_F(KeyRefusal, AMissingFile) {
  for (const fs::path& file :
       {haptic_.authority, haptic_.certificate, haptic_.key, haptic_.governance, haptic_.permissions}) {
    fs::rename(file, folder_ / "away");
    expect("there is no " + file.string() + "; docs/security.md says what a folder of keys holds");
    fs::rename(folder_ / "away", file);
  }
}

TEST_F(KeyRefusal, KeysOfAnotherRole) {
  EXPECT_TRUE(std::regex_match(
      refusal(keys_ / "render", "haptic"),
      std::regex("network: .*/render holds keys of the role 'render', and this program's is 'haptic'")));
}

TEST_F(KeyRefusal, AnOpenPrivateKey) {
  fs::permissions(haptic_.key, fs::perms::group_read, fs::perm_options::add);
  expect(".*/haptic/key.pem may be read by others: chmod 600 it");
}

TEST_F(KeyRefusal, AKeyThatIsNotTheCertificates) {
  fs::copy_file(keys_ / "render/key.pem", haptic_.key, fs::copy_options::overwrite_existing);
  expect(".*/haptic/key.pem is not the key of .*/haptic/certificate.pem");
}

TEST_F(KeyRefusal, ACertificateThatHasExpired) {
  const std::time_t now = std::time(nullptr);
  renew({now - 3 * kDay, now - kDay}, now_and_on());
  expect(".*/haptic/certificate.pem or the authority's has expired; `palpate keys` makes new ones");
}

TEST_F(KeyRefusal, ACertificateFromTheFuture) {
  const std::time_t now = std::time(nullptr);
  renew({now + kDay, now + 2 * kDay}, now_and_on());
  expect(".*/haptic/certificate.pem is not valid yet: is this host's clock right\\?");
}

TEST_F(KeyRefusal, PermissionsThatHaveExpired) {
  const std::time_t now = std::time(nullptr);
  renew(now_and_on(), {now - 3 * kDay, now - kDay});
  expect(".*/haptic/permissions.p7s has expired; `palpate keys` makes new ones");
}

TEST_F(KeyRefusal, PermissionsFromTheFuture) {
  const std::time_t now = std::time(nullptr);
  renew(now_and_on(), {now + kDay, now + 2 * kDay});
  expect(".*/haptic/permissions.p7s is not valid yet: is this host's clock right\\?");
}

TEST_F(KeyRefusal, ACertificateOfAnotherAuthority) {
  keys::make_folder(folder_ / "foreign", now_and_on());
  for (const char* file : {"certificate.pem", "key.pem"})
    fs::copy_file(folder_ / "foreign/haptic" / file, keys_ / "haptic" / file, fs::copy_options::overwrite_existing);
  expect(".*/haptic/certificate.pem is not of the authority .*/haptic/authority.pem");
}

TEST_F(KeyRefusal, PermissionsThatWereAltered) {
  const KeyFiles observer = key_files(keys_ / "observer");
  replace(observer.permissions, "<subscribe>", "<publish><topics><topic>*</topic></topics></publish><subscribe>");
  expect(".*/observer/governance.p7s or permissions.p7s beside it is not as authority.pem signed it", "observer");
}

TEST_F(KeyRefusal, GovernanceThatWasAltered) {
  replace(haptic_.governance, "<data_protection_kind>ENCRYPT", "<data_protection_kind>NONE");
  expect(".*/haptic/governance.p7s or permissions.p7s beside it is not as authority.pem signed it");
}

TEST_F(KeyRefusal, PermissionsSignedByAnother) {
  keys::make_folder(folder_ / "foreign", now_and_on());
  fs::copy_file(folder_ / "foreign/haptic/permissions.p7s", haptic_.permissions, fs::copy_options::overwrite_existing);
  expect(".*/haptic/governance.p7s or permissions.p7s beside it is not as authority.pem signed it");
}

TEST_F(KeyRefusal, PermissionsOfAnotherCertificate) {
  keys::add_keys(keys_, "haptic", "second", now_and_on());
  fs::copy_file(keys_ / "second/permissions.p7s", haptic_.permissions, fs::copy_options::overwrite_existing);
  expect(".*/haptic/permissions.p7s is not for .*/haptic/certificate.pem");
}

TEST_F(KeyRefusal, FilesThatAreNoKeys) {
  std::ofstream(haptic_.certificate) << "-----BEGIN CERTIFICATE-----\nAAAA\n-----END CERTIFICATE-----\n";
  expect(".*/haptic/key.pem is not the key of .*/haptic/certificate.pem");
  std::ofstream(haptic_.key) << "nothing";
  expect(".*/haptic/key.pem is not a private key as `palpate keys` makes them");
}

TEST_F(KeyRefusal, WhatTheRoleMayNot) {
  const auto bus = make_dds_bus({.domain = own_domain(), .keys = keys_, .role = "observer"});
  EXPECT_NO_THROW(bus->reader(topics::tool_state));
  try {
    bus->writer(topics::tool_state);
    FAIL() << "an observer writes";
  } catch (const std::runtime_error& error) {
    EXPECT_EQ(std::string(error.what()),
              "network: creating the writer of palpate/tool_state is not permitted to the role of these keys");
  }
}

TEST_F(KeyRefusal, TwoRolesInOneProcess) {
  const BusSettings one{.domain = own_domain(), .keys = keys_, .role = "observer"};
  const auto bus = make_dds_bus(one);
  EXPECT_NO_THROW(make_dds_bus(one));
  EXPECT_THROW(make_dds_bus({.domain = one.domain, .keys = keys_, .role = "haptic"}), std::runtime_error);
  EXPECT_THROW(make_dds_bus({.domain = one.domain}), std::runtime_error) << "nor with keys and without";
  keys::make_folder(folder_ / "foreign", now_and_on());
  EXPECT_THROW(make_dds_bus({.domain = one.domain, .keys = folder_ / "foreign", .role = "observer"}),
               std::runtime_error)
      << "nor with those of two authorities";
}

}  // namespace
}  // namespace palpate::testing
