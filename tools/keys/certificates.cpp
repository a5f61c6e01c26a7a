#include "tools/keys/certificates.hpp"

#include <fmt/format.h>
#include <openssl/bio.h>
#include <openssl/bn.h>
#include <openssl/ec.h>
#include <openssl/err.h>
#include <openssl/evp.h>
#include <openssl/pem.h>
#include <openssl/pkcs7.h>
#include <openssl/x509v3.h>

#include <memory>
#include <stdexcept>

namespace palpate::keys {
namespace {

template <auto free>
struct Free {
  template <class T>
  void operator()(T* object) const {
    free(object);
  }
};
using Bio = std::unique_ptr<BIO, Free<BIO_free_all>>;
using Key = std::unique_ptr<EVP_PKEY, Free<EVP_PKEY_free>>;
using Certificate = std::unique_ptr<X509, Free<X509_free>>;
using Extension = std::unique_ptr<X509_EXTENSION, Free<X509_EXTENSION_free>>;
using Number = std::unique_ptr<BIGNUM, Free<BN_free>>;
using Signed = std::unique_ptr<PKCS7, Free<PKCS7_free>>;

/// Throws unless `result` is what OpenSSL returns on success.
template <class T>
T need(T result, const char* what) {
  if (result) return result;
  const char* reason = ERR_reason_error_string(ERR_get_error());
  throw std::runtime_error(fmt::format("keys: {} failed: {}", what, reason ? reason : "no reason given"));
}

Bio reads(const std::string& text) {
  return Bio(need(BIO_new_mem_buf(text.data(), static_cast<int>(text.size())), "reading"));
}
Bio writes() {
  return Bio(need(BIO_new(BIO_s_mem()), "writing"));
}

std::string text_of(const Bio& bio) {
  char* data = nullptr;
  const long size = BIO_get_mem_data(bio.get(), &data);
  return {data, static_cast<std::size_t>(size)};
}

Key key_of(const Identity& identity) {
  return Key(
      need(PEM_read_bio_PrivateKey(reads(identity.key).get(), nullptr, nullptr, nullptr), "reading a private key"));
}
Certificate certificate_of(const std::string& pem) {
  return Certificate(need(PEM_read_bio_X509(reads(pem).get(), nullptr, nullptr, nullptr), "reading a certificate"));
}

void add(X509* certificate, X509* issuer, int what, const char* value) {
  X509V3_CTX context;
  X509V3_set_ctx(&context, issuer, certificate, nullptr, nullptr, 0);
  const Extension extension(need(X509V3_EXT_conf_nid(nullptr, &context, what, value), "describing a certificate"));
  need(X509_add_ext(certificate, extension.get(), -1), "describing a certificate");
}

void number(X509* certificate) {
  const Number serial(need(BN_new(), "numbering a certificate"));
  need(BN_rand(serial.get(), 120, BN_RAND_TOP_ANY, BN_RAND_BOTTOM_ANY), "numbering a certificate");
  need(BN_to_ASN1_INTEGER(serial.get(), X509_get_serialNumber(certificate)), "numbering a certificate");
}

/// A new key with an unsigned certificate that holds all but what depends on who signs.
std::pair<Key, Certificate> begin(const std::string& name, const Period& period) {
  Key key(need(EVP_EC_gen("P-256"), "making a key"));
  Certificate certificate(need(X509_new(), "making a certificate"));
  need(X509_set_version(certificate.get(), X509_VERSION_3), "making a certificate");
  number(certificate.get());
  need(ASN1_TIME_set(X509_getm_notBefore(certificate.get()), period.from), "dating a certificate");
  need(ASN1_TIME_set(X509_getm_notAfter(certificate.get()), period.to), "dating a certificate");
  need(X509_NAME_add_entry_by_txt(X509_get_subject_name(certificate.get()), "CN", MBSTRING_UTF8,
                                  reinterpret_cast<const unsigned char*>(name.c_str()), -1, -1, 0),
       "naming a certificate");
  need(X509_set_pubkey(certificate.get(), key.get()), "making a certificate");
  return {std::move(key), std::move(certificate)};
}

Identity finish(const Key& key, X509* certificate, X509* issuer, EVP_PKEY* signer) {
  need(X509_set_issuer_name(certificate, X509_get_subject_name(issuer)), "naming a certificate");
  add(certificate, issuer, NID_subject_key_identifier, "hash");
  add(certificate, issuer, NID_authority_key_identifier, "keyid:always");
  need(X509_sign(certificate, signer, EVP_sha256()), "signing a certificate");
  const Bio own = writes(), shown = writes();
  need(PEM_write_bio_PrivateKey(own.get(), key.get(), nullptr, nullptr, 0, nullptr, nullptr), "writing a private key");
  need(PEM_write_bio_X509(shown.get(), certificate), "writing a certificate");
  return {text_of(own), text_of(shown)};
}

}  // namespace

Identity make_authority(const std::string& name, const Period& period) {
  const auto [key, certificate] = begin(name, period);
  add(certificate.get(), certificate.get(), NID_basic_constraints, "critical,CA:TRUE");
  add(certificate.get(), certificate.get(), NID_key_usage, "critical,digitalSignature,keyCertSign,cRLSign");
  return finish(key, certificate.get(), certificate.get(), key.get());
}

Identity make_member(const Identity& authority, const std::string& name, const Period& period) {
  const auto [key, certificate] = begin(name, period);
  const Certificate issuer = certificate_of(authority.certificate);
  const Key signer = key_of(authority);
  need(X509_check_private_key(issuer.get(), signer.get()), "matching the authority's key with its certificate");
  add(certificate.get(), issuer.get(), NID_basic_constraints, "critical,CA:FALSE");
  add(certificate.get(), issuer.get(), NID_key_usage, "critical,digitalSignature,keyAgreement");
  return finish(key, certificate.get(), issuer.get(), signer.get());
}

std::string sign(const Identity& authority, const std::string& text) {
  constexpr int flags = PKCS7_DETACHED | PKCS7_TEXT;
  const Certificate certificate = certificate_of(authority.certificate);
  const Key key = key_of(authority);
  const Bio in = reads(text), out = writes();
  const Signed signature(need(PKCS7_sign(certificate.get(), key.get(), nullptr, in.get(), flags), "signing"));
  need(BIO_reset(in.get()) == 1, "signing");
  need(SMIME_write_PKCS7(out.get(), signature.get(), in.get(), flags), "signing");
  return text_of(out);
}

std::string subject_of(const std::string& certificate) {
  const Certificate parsed = certificate_of(certificate);
  const Bio out = writes();
  need(X509_NAME_print_ex(out.get(), X509_get_subject_name(parsed.get()), 0, XN_FLAG_RFC2253) >= 0, "reading a name");
  return text_of(out);
}

std::time_t end_of(const std::string& certificate) {
  const Certificate parsed = certificate_of(certificate);
  std::tm end{};
  need(ASN1_TIME_to_tm(X509_get0_notAfter(parsed.get()), &end), "reading a date");
  return timegm(&end);
}

}  // namespace palpate::keys
