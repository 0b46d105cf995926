// SPDX-License-Identifier: GPL-3.0-or-later
// Signatures: what the prover signs the checker verifies, and nothing else. Through the command line:
// tests/cli/signature_test.py.
#include "checker/format/signature.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <openssl/evp.h>
#include <openssl/pem.h>

#include <memory>

#include "base/input_error.h"
#include "certificate/signature.h"
#include "checker/check.h"
#include "tests/checker/fixtures.h"

namespace taut::checker {
namespace {

using ::testing::HasSubstr;

// RFC 8032, section 7.1, test 1.
constexpr unsigned char kSeed[32] = {0x9d, 0x61, 0xb1, 0x9d, 0xef, 0xfd, 0x5a, 0x60, 0xba, 0x84, 0x4a,
                                     0xf4, 0x92, 0xec, 0x2c, 0xc4, 0x44, 0x49, 0xc5, 0x69, 0x7b, 0x32,
                                     0x69, 0x19, 0x70, 0x3b, 0xac, 0x03, 0x1c, 0xae, 0x7f, 0x60};
constexpr const char* kPublicKey = "d75a980182b10ab7d54bfed3c964073a0ee172f3daa62325af021a68f707511a";

using Key = std::unique_ptr<EVP_PKEY, decltype(&EVP_PKEY_free)>;

Key key(int type, unsigned char first_byte = kSeed[0]) {
  std::string seed(std::begin(kSeed), std::end(kSeed));
  seed[0] = static_cast<char>(first_byte);
  return {EVP_PKEY_new_raw_private_key(type, nullptr, reinterpret_cast<const unsigned char*>(seed.data()), seed.size()),
          EVP_PKEY_free};
}

template <class Write>
std::string pem(Write write) {
  const std::unique_ptr<BIO, decltype(&BIO_free)> bio(BIO_new(BIO_s_mem()), BIO_free);
  EXPECT_EQ(write(bio.get()), 1);
  char* text = nullptr;
  const auto size = BIO_get_mem_data(bio.get(), &text);
  return {text, static_cast<std::size_t>(size)};
}
std::string private_pem(const Key& key) {
  return pem(
      [&](BIO* bio) { return PEM_write_bio_PKCS8PrivateKey(bio, key.get(), nullptr, nullptr, 0, nullptr, nullptr); });
}
std::string public_pem(const Key& key) {
  return pem([&](BIO* bio) { return PEM_write_bio_PUBKEY(bio, key.get()); });
}

SigningKey signer() { return {private_pem(key(EVP_PKEY_ED25519)), "key.pem"}; }

/// Gives a certificate its signature, in place of any that it has.
void sign(nlohmann::json& certificate, const SigningKey& key) {
  certificate["signature"] = key.signature(certificate.at("footer").at("sha256").get<std::string>());
}

/// A small certificate, signed.
nlohmann::json signed_certificate() {
  nlohmann::json certificate = accepted("refuted_length_max");
  sign(certificate, signer());
  return certificate;
}

CheckResult check(const nlohmann::json& certificate, const std::vector<std::string>& trusted = {}) {
  return checker::check(certificate.dump(), {.trusted = trusted});
}

TEST(Signature, IsVerifiedAndNamesItsKey) {
  EXPECT_EQ(signer().public_key(), kPublicKey);
  const CheckResult result = check(signed_certificate());
  EXPECT_EQ(result.outcome, Outcome::kAccepted) << result.message;
  EXPECT_EQ(result.signer, kPublicKey);
  EXPECT_FALSE(result.is_trusted);
  const CheckResult unsigned_result = check(accepted("refuted_length_max"));
  EXPECT_EQ(unsigned_result.outcome, Outcome::kAccepted);
  EXPECT_EQ(unsigned_result.signer, "");
}

TEST(Signature, OfAnotherOrNobodyIsRejectedWhereATrustedOneIsAskedFor) {
  const std::string trusted = read_public_key(public_pem(key(EVP_PKEY_ED25519)), "k.pub");
  const std::string other = read_public_key(public_pem(key(EVP_PKEY_ED25519, 1)), "o.pub");
  EXPECT_EQ(trusted, kPublicKey);
  const nlohmann::json certificate = signed_certificate();
  EXPECT_EQ(check(certificate, {trusted}).outcome, Outcome::kAccepted);
  EXPECT_EQ(check(certificate, {other, trusted}).outcome, Outcome::kAccepted);
  EXPECT_TRUE(check(certificate, {other, trusted}).is_trusted);
  EXPECT_EQ(check(certificate, {other}).outcome, Outcome::kRejected);
  EXPECT_FALSE(check(certificate, {other}).is_trusted);
  EXPECT_EQ(check(accepted("refuted_length_max"), {trusted}).outcome, Outcome::kRejected);
}

TEST(Signature, OfASealedUndecidedCertificateMustVerifyToo) {
  nlohmann::json certificate = accepted("refuted_length_max");
  certificate["verdict"] = "undecided";
  certificate["claim"] = "x";
  seal(certificate);
  sign(certificate, signer());
  certificate["claim"] = "y";
  seal(certificate);
  EXPECT_EQ(check(certificate).outcome, Outcome::kMalformed);
}

// Signed once more it is signed by the last only.
TEST(Signature, IsReplacedByANewOne) {
  nlohmann::json certificate = signed_certificate();
  const nlohmann::json first = certificate;
  const SigningKey other(private_pem(key(EVP_PKEY_ED25519, 1)), "o.pem");
  sign(certificate, other);
  EXPECT_EQ(check(certificate).signer, other.public_key());
  EXPECT_NE(certificate, first);
  sign(certificate, signer());
  EXPECT_EQ(certificate, first) << "Ed25519 is deterministic";
}

TEST(Signature, WithAnyDigitAlteredIsMalformed) {
  const nlohmann::json certificate = signed_certificate();
  for (const char* field : {"public_key", "value"}) {
    const std::string digits = certificate["signature"][field];
    for (std::size_t i = 0; i < digits.size(); ++i) {
      for (const char c : {'0', '7', 'f', 'A', 'g', ' '}) {
        if (digits[i] == c) continue;
        nlohmann::json altered = certificate;
        std::string text = digits;
        text[i] = c;
        altered["signature"][field] = text;
        ASSERT_EQ(check(altered).outcome, Outcome::kMalformed) << field << i << c;
      }
    }
    for (const std::string& text : {digits.substr(2), digits + "00", std::string()}) {
      nlohmann::json altered = certificate;
      altered["signature"][field] = text;
      EXPECT_EQ(check(altered).outcome, Outcome::kMalformed) << field << text;
    }
  }
}

TEST(Signature, OfAnyOtherFormIsMalformed) {
  const nlohmann::json certificate = signed_certificate();
  const nlohmann::json& signature = certificate["signature"];
  std::vector<nlohmann::json> bad = {nullptr, 1, "x", nlohmann::json::array(), nlohmann::json::object()};
  for (const auto& item : signature.items()) {
    bad.push_back(signature);
    bad.back().erase(item.key());
    for (const nlohmann::json& value : {nlohmann::json(), nlohmann::json(7), nlohmann::json("ed25519")}) {
      bad.push_back(signature);
      bad.back()[item.key()] = value;
    }
  }
  bad.push_back(signature);
  bad.back()["more"] = "";
  for (const nlohmann::json& value : bad) {
    nlohmann::json altered = certificate;
    altered["signature"] = value;
    EXPECT_EQ(check(altered).outcome, Outcome::kMalformed) << value;
  }
}

TEST(Signature, HoldsEveryByteOfTheCertificate) {
  const std::string text = signed_certificate().dump();
  for (std::size_t i = 0; i < text.size(); ++i) {
    std::string altered = text;
    altered[i] = static_cast<char>(altered[i] ^ 1);
    ASSERT_EQ(check(altered).outcome, Outcome::kMalformed) << i << altered.substr(i, 20);
  }
}

// With footer and digests made right again only the signature tells.
TEST(Signature, HoldsEveryFieldOfAResealedCertificate) {
  const nlohmann::json certificate = signed_certificate();
  const nlohmann::json fields = certificate.flatten();
  int altered = 0;
  int by_signature = 0;
  for (const auto& item : fields.items()) {
    if (!item.value().is_string() || item.key().starts_with("/signature")) continue;
    nlohmann::json forged = certificate;
    forged[nlohmann::json::json_pointer(item.key())] = item.value().get<std::string>() + "0";
    const nlohmann::json signature = forged["signature"];
    forged.erase("signature");
    seal(forged);
    forged["signature"] = signature;
    if (forged == certificate) continue;  // a digest that seal() made right
    ++altered;
    // Either the altered field is malformed by itself, or the signature is not of the new digest.
    EXPECT_EQ(check(forged).outcome, Outcome::kMalformed) << item.key();
    by_signature += check(forged).message.find("signature") != std::string::npos ? 1 : 0;
  }
  EXPECT_GT(by_signature, altered / 4);
  EXPECT_GT(altered, 100);
}

TEST(Signature, KeysOfOtherKindsAreBadInput) {
  const std::string good = private_pem(key(EVP_PKEY_ED25519));
  const std::string encrypted = pem([](BIO* bio) {
    char passphrase[] = "secret";
    return PEM_write_bio_PKCS8PrivateKey(bio, key(EVP_PKEY_ED25519).get(), EVP_aes_256_cbc(), passphrase, 6, nullptr,
                                         nullptr);
  });
  const auto complaint = [](const std::string& text) -> std::string {
    try {
      const SigningKey signing_key(text, "key.pem");
      return "none";
    } catch (const InputError& error) {
      return error.what();
    }
  };
  EXPECT_EQ(complaint(good), "none");
  EXPECT_THAT(complaint(private_pem(key(EVP_PKEY_X25519))), HasSubstr("key.pem: got a private key of type X25519"));
  EXPECT_THAT(complaint(public_pem(key(EVP_PKEY_ED25519))), HasSubstr("got a public key"));
  EXPECT_THAT(complaint(encrypted), HasSubstr("got an encrypted private key"));
  EXPECT_THAT(complaint(""), HasSubstr("got no PEM"));
  EXPECT_THAT(complaint(good.substr(0, 60)), HasSubstr("got a private key that OpenSSL cannot read"));
}

TEST(Signature, TrustedKeysOfOtherKindsAreMalformed) {
  const std::string good = public_pem(key(EVP_PKEY_ED25519));
  EXPECT_EQ(read_public_key("comment\n" + good, "k"), kPublicKey);
  for (const std::string& text : {private_pem(key(EVP_PKEY_ED25519)), public_pem(key(EVP_PKEY_X25519)), good + good,
                                  good.substr(0, 60), std::string("-----BEGIN "), std::string()}) {
    EXPECT_THROW((void)read_public_key(text, "k"), Malformed) << text;
  }
}

// As `openssl pkey -pubin -outform DER | sha256sum` says of the key of RFC 8032's test 1.
TEST(Signature, FingerprintIsThatOfTheKeyInDer) {
  EXPECT_EQ(fingerprint(kPublicKey), "SHA256:06e3fd8fda29bb60ab59557de61edb0aecdb231134be30e75b455f8e1b792fa9");
}

}  // namespace
}  // namespace taut::checker
