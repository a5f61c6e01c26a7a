#include "tools/keys/key_folder.hpp"

#include <gtest/gtest.h>
#include <openssl/bio.h>
#include <openssl/pem.h>
#include <openssl/pkcs7.h>
#include <openssl/x509_vfy.h>

#include <set>

#include "common/bus/roles.hpp"
#include "common/bus/security.hpp"
#include "tests/keys/own_folder.hpp"

namespace palpate::testing {
namespace {

namespace fs = std::filesystem;
using Names = std::set<std::string>;

/// Every file below a folder with its permissions: "haptic/key.pem 600".
Names listing(const fs::path& folder) {
  Names files;
  for (const auto& entry : fs::recursive_directory_iterator(folder))
    if (entry.is_regular_file())
      files.insert(fmt::format("{} {:o}", fs::relative(entry.path(), folder).string(),
                               static_cast<unsigned>(entry.status().permissions())));
  return files;
}

X509* certificate_in(const fs::path& file) {
  const std::string pem = text_of(file);
  BIO* bio = BIO_new_mem_buf(pem.data(), static_cast<int>(pem.size()));
  X509* certificate = PEM_read_bio_X509(bio, nullptr, nullptr, nullptr);
  BIO_free(bio);
  return certificate;
}

/// A store that trusts one authority.
X509_STORE* trusting(const fs::path& authority) {
  X509_STORE* store = X509_STORE_new();
  X509* certificate = certificate_in(authority);
  X509_STORE_add_cert(store, certificate);
  X509_free(certificate);
  return store;
}

/// libcrypto's word on a signed document.
bool signature_holds(const std::string& document, const fs::path& authority) {
  BIO *in = BIO_new_mem_buf(document.data(), static_cast<int>(document.size())), *content = nullptr,
      *out = BIO_new(BIO_s_mem());
  PKCS7* signature = SMIME_read_PKCS7(in, &content);
  X509_STORE* store = trusting(authority);
  const bool holds = signature && PKCS7_verify(signature, nullptr, store, content, out, PKCS7_TEXT) == 1;
  X509_STORE_free(store);
  PKCS7_free(signature);
  BIO_free(content);
  BIO_free(out);
  BIO_free(in);
  return holds;
}

/// Whether an authority vouches for a certificate, perhaps by way of one `between`.
bool is_of(const fs::path& certificate, const fs::path& authority, const fs::path& between = {}) {
  X509_STORE* store = trusting(authority);
  X509_STORE_CTX* context = X509_STORE_CTX_new();
  X509* own = certificate_in(certificate);
  STACK_OF(X509)* others = sk_X509_new_null();
  if (!between.empty()) sk_X509_push(others, certificate_in(between));
  X509_STORE_CTX_init(context, store, own, others);
  const bool valid = X509_verify_cert(context) == 1;
  sk_X509_pop_free(others, X509_free);
  X509_free(own);
  X509_STORE_CTX_free(context);
  X509_STORE_free(store);
  return valid;
}

class KeyFolder : public ::testing::Test {
 protected:
  KeyFolder() { keys::make_folder(keys_, now_and_on()); }
  OwnFolder folder_;
  const fs::path keys_ = folder_ / "keys";
};

TEST_F(KeyFolder, HoldsAnAuthorityAndForEachRoleWhatItsHostNeeds) {
  Names expected{"authority/certificate.pem 644", "authority/key.pem 600"};
  for (const std::string& role : bus_roles())
    for (const char* file :
         {"authority.pem 644", "certificate.pem 644", "governance.p7s 644", "key.pem 600", "permissions.p7s 644"})
      expected.insert(role + "/" + file);
  EXPECT_EQ(listing(keys_), expected);
  for (const auto& entry : fs::directory_iterator(keys_))
    EXPECT_EQ(entry.status().permissions(), fs::perms::owner_all) << entry.path();
  const std::string secret = text_of(keys_ / "authority/key.pem");
  std::set<std::string> own{secret};
  for (const std::string& role : bus_roles())
    EXPECT_TRUE(own.insert(text_of(keys_ / role / "key.pem")).second) << role << " has a key of its own";
}

TEST_F(KeyFolder, EverySignatureIsTheAuthorities) {
  const fs::path authority = keys_ / "authority/certificate.pem";
  for (const std::string& role : bus_roles()) {
    const KeyFiles files = key_files(keys_ / role);
    EXPECT_EQ(text_of(files.authority), text_of(authority));
    EXPECT_TRUE(is_of(files.certificate, authority)) << role;
    for (const fs::path& file : {files.governance, files.permissions}) {
      std::string document = text_of(file);
      EXPECT_TRUE(signature_holds(document, authority)) << file;
      document[document.find("<topic") + 1] = 'T';
      EXPECT_FALSE(signature_holds(document, authority)) << file << ", altered";
    }
  }
  keys::make_folder(folder_ / "foreign", now_and_on());
  EXPECT_FALSE(is_of(keys_ / "haptic/certificate.pem", folder_ / "foreign/authority/certificate.pem"));
  EXPECT_FALSE(
      signature_holds(text_of(keys_ / "haptic/permissions.p7s"), folder_ / "foreign/authority/certificate.pem"));
}

TEST_F(KeyFolder, NoCertificateButTheAuthoritiesCanSignOthers) {
  const keys::Identity haptic{text_of(keys_ / "haptic/key.pem"), text_of(keys_ / "haptic/certificate.pem")};
  const keys::Identity child = keys::make_member(haptic, "child", now_and_on());
  std::ofstream(folder_ / "child.pem") << child.certificate;
  EXPECT_FALSE(is_of(folder_ / "child.pem", keys_ / "authority/certificate.pem", keys_ / "haptic/certificate.pem"));
  EXPECT_TRUE(
      is_of(keys_ / "deform/certificate.pem", keys_ / "authority/certificate.pem", keys_ / "haptic/certificate.pem"));
}

TEST_F(KeyFolder, AnAuthorityIsNeverWrittenOver) {
  const std::string key = text_of(keys_ / "authority/key.pem");
  const Names before = listing(keys_);
  EXPECT_THROW(keys::make_folder(keys_, now_and_on()), std::runtime_error);
  for (const std::string& role : bus_roles()) fs::remove_all(keys_ / role);
  EXPECT_THROW(keys::make_folder(keys_, now_and_on()), std::runtime_error);
  EXPECT_EQ(text_of(keys_ / "authority/key.pem"), key);
  EXPECT_EQ(listing(keys_), (Names{"authority/certificate.pem 644", "authority/key.pem 600"}));
  EXPECT_EQ(before.size(), 2 + 5 * bus_roles().size());
}

TEST_F(KeyFolder, FurtherKeysComeFromTheSameAuthority) {
  const std::time_t end = keys::add_keys(keys_, "haptic", "second-theatre", now_and_on());
  const KeyFiles first = key_files(keys_ / "haptic"), second = key_files(keys_ / "second-theatre");
  EXPECT_EQ(end, keys::end_of(text_of(second.certificate)));
  EXPECT_NE(text_of(first.key), text_of(second.key));
  EXPECT_EQ(keys::subject_of(text_of(second.certificate)), "CN=second-theatre");
  EXPECT_TRUE(is_of(second.certificate, first.authority));
  EXPECT_TRUE(signature_holds(text_of(second.permissions), first.authority));
  char day_of_end[11];
  std::strftime(day_of_end, sizeof day_of_end, "%F", std::gmtime(&end));
  EXPECT_EQ(last_day(find_keys(keys_ / "second-theatre", "haptic")), day_of_end);

  EXPECT_THROW(keys::add_keys(keys_, "haptic", "second-theatre", now_and_on()), std::runtime_error)
      << "is there already";
  EXPECT_THROW(keys::add_keys(keys_, "haptic", "../out", now_and_on()), std::runtime_error);
  EXPECT_THROW(keys::add_keys(keys_, "haptic", "authority", now_and_on()), std::runtime_error);
  EXPECT_THROW(keys::add_keys(keys_, "surgeon", "third", now_and_on()), std::runtime_error);
  EXPECT_THROW(keys::add_keys(folder_ / "nothing", "haptic", "third", now_and_on()), std::runtime_error);
  EXPECT_FALSE(fs::exists(keys_ / "third"));
}

TEST_F(KeyFolder, KeysEndWithTheirAuthorityAtTheLatest) {
  const std::time_t now = std::time(nullptr), authority = keys::end_of(text_of(keys_ / "authority/certificate.pem"));
  EXPECT_GT(authority, now + 7000 * kDay);
  EXPECT_EQ(keys::add_keys(keys_, "render", "late", {now, authority + 100 * kDay}), authority);
}

}  // namespace
}  // namespace palpate::testing
