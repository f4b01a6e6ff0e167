// Promises: AUTH-MAC.
#include "protocol/wire/cmac.hpp"

#include <gtest/gtest.h>
#include <openssl/core_names.h>
#include <openssl/evp.h>
#include <openssl/params.h>

#include <memory>
#include <random>
#include <string>
#include <vector>

#include "protocol/wire/commands.hpp"
#include "protocol/wire/seal.hpp"
#include "tests/support/figures.hpp"

/// AES-128 and its CMAC against the standards' examples and OpenSSL; what a command's MAC covers.
namespace pinjaw::wire {
namespace {

std::vector<std::uint8_t> bytes_of(const std::string& hex) {
  std::vector<std::uint8_t> bytes;
  for (std::size_t i = 0; i + 1 < hex.size(); i += 2) {
    bytes.push_back(static_cast<std::uint8_t>(std::stoi(hex.substr(i, 2), nullptr, 16)));
  }
  return bytes;
}

AesBlock block_of(const std::string& hex) {
  AesBlock block{};
  const std::vector<std::uint8_t> bytes = bytes_of(hex);
  std::copy(bytes.begin(), bytes.end(), block.begin());
  return block;
}

AesBlock openssl_aes(const Key& key, const AesBlock& block) {
  const std::unique_ptr<EVP_CIPHER_CTX, decltype(&EVP_CIPHER_CTX_free)> context(EVP_CIPHER_CTX_new(),
                                                                                &EVP_CIPHER_CTX_free);
  AesBlock out{};
  int length = 0;
  EXPECT_EQ(EVP_EncryptInit_ex(context.get(), EVP_aes_128_ecb(), nullptr, key.data(), nullptr), 1);
  EVP_CIPHER_CTX_set_padding(context.get(), 0);
  EXPECT_EQ(EVP_EncryptUpdate(context.get(), out.data(), &length, block.data(), 16), 1);
  return out;
}

AesBlock openssl_cmac(const Key& key, const std::vector<std::uint8_t>& message) {
  const std::unique_ptr<EVP_MAC, decltype(&EVP_MAC_free)> kind(EVP_MAC_fetch(nullptr, "CMAC", nullptr),
                                                               &EVP_MAC_free);
  const std::unique_ptr<EVP_MAC_CTX, decltype(&EVP_MAC_CTX_free)> context(EVP_MAC_CTX_new(kind.get()),
                                                                          &EVP_MAC_CTX_free);
  std::string cipher = "AES-128-CBC";
  const OSSL_PARAM parameters[] = {OSSL_PARAM_construct_utf8_string(OSSL_MAC_PARAM_CIPHER, cipher.data(), 0),
                                   OSSL_PARAM_construct_end()};
  AesBlock out{};
  std::size_t length = 0;
  EXPECT_EQ(EVP_MAC_init(context.get(), key.data(), key.size(), parameters), 1);
  EXPECT_EQ(EVP_MAC_update(context.get(), message.data(), message.size()), 1);
  EXPECT_EQ(EVP_MAC_final(context.get(), out.data(), &length, out.size()), 1);
  return out;
}

// FIPS 197, appendix C.1.
static_assert(aes128(Key{0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15},
                     AesBlock{0x00, 0x11, 0x22, 0x33, 0x44, 0x55, 0x66, 0x77, 0x88, 0x99, 0xAA, 0xBB, 0xCC,
                              0xDD, 0xEE, 0xFF}) == AesBlock{0x69, 0xC4, 0xE0, 0xD8, 0x6A, 0x7B, 0x04, 0x30,
                                                             0xD8, 0xCD, 0xB7, 0x80, 0x70, 0xB4, 0xC5, 0x5A});

TEST(Aes128, encrypts_the_example_of_fips_197_appendix_b) {
  EXPECT_EQ(
      aes128(block_of("2b7e151628aed2a6abf7158809cf4f3c"), block_of("3243f6a8885a308d313198a2e0370734")),
      block_of("3925841d02dc09fbdc118597196a0b32"));
}

TEST(Cmac, gives_the_four_examples_of_rfc_4493) {
  const Key key = block_of("2b7e151628aed2a6abf7158809cf4f3c");
  const std::vector<std::uint8_t> message = bytes_of(
      "6bc1bee22e409f96e93d7e117393172aae2d8a571e03ac9c9eb76fac45af8e5130c81c46a35ce411e5fbc1191a0a52ef"
      "f69f2445df4f9b17ad2b417be66c3710");
  const std::span<const std::uint8_t> all(message);
  EXPECT_EQ(cmac(key, {}), block_of("bb1d6929e95937287fa37d129b756746"));
  EXPECT_EQ(cmac(key, all.first(16)), block_of("070a16b46b4d4144f79bdd9dd04a287c"));
  EXPECT_EQ(cmac(key, all.first(40)), block_of("dfa66747de9ae63030ca32611497c827"));
  EXPECT_EQ(cmac(key, all), block_of("51f0bebf7e3b9d92fc49741779363cfe"));
}

TEST(Cmac, agrees_with_openssl_on_random_keys_and_messages_of_every_length) {
  std::mt19937_64 random(4493);
  const auto byte = [&random] { return static_cast<std::uint8_t>(random()); };
  int compared = 0;
  for (int round = 0; round < 20; ++round) {
    for (std::size_t length = 0; length <= 80; ++length) {
      Key key{};
      AesBlock block{};
      std::vector<std::uint8_t> message(length);
      for (auto* bytes : {key.begin(), block.begin()}) std::generate(bytes, bytes + 16, byte);
      std::generate(message.begin(), message.end(), byte);
      ASSERT_EQ(aes128(key, block), openssl_aes(key, block));
      ASSERT_EQ(cmac(key, message), openssl_cmac(key, message)) << "length " << length;
      ++compared;
    }
  }
  test::figure("AUTH-MAC", "CMACs and AES blocks equal to OpenSSL's", compared, "pairs");
}

constexpr Key kKey{1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16};

Command squeeze() {
  Command command = squeeze_command({520, 1400});
  command.sequence = 9;
  return command;
}

TEST(Seal, is_the_truncated_cmac_of_what_a_command_says_and_belongs_to) {
  const std::vector<std::uint8_t> message{0x20,      2,    9,    4,    520 & 0xFF, 520 >> 8, 1400 & 0xFF,
                                          1400 >> 8, 0x78, 0x56, 0x34, 0x12,       77,       0};
  const AesBlock mac = openssl_cmac(kKey, message);
  EXPECT_EQ(sealed(kKey, 2, squeeze(), {0x12345678, 77}).session, mac[0] << 8 | mac[1]);
}

TEST(Seal, one_of_65536_values_is_right) {
  int right = 0;
  Command guess = squeeze();
  for (std::uint32_t value = 0; value < 0x10000; ++value) {
    guess.session = static_cast<std::uint16_t>(value);
    if (guess.session == command_mac(kKey, 2, squeeze(), {5, 77})) ++right;
  }
  EXPECT_EQ(right, 1);
}

/// The share of 2^16 changed commands whose old MAC is still right, for one way of changing them.
template <class Change>
double share_that_passes(Change change) {
  int passed = 0;
  constexpr int kTries = 0x10000;
  for (int i = 0; i < kTries; ++i) {
    Command command = squeeze();
    command.sequence = static_cast<std::uint8_t>(i & 0xFF);
    command.a = static_cast<std::uint16_t>(i >> 4);
    Freshness freshness{static_cast<std::uint32_t>(i) * 2654435761U, 77};
    std::uint8_t node = 2;
    const Command said = sealed(kKey, node, command, freshness);
    Command heard = said;
    change(heard, node, freshness);
    if (seal_is_right(kKey, node, heard, freshness)) ++passed;
  }
  return passed / static_cast<double>(kTries);
}

TEST(Seal, of_another_command_node_number_or_epoch_passes_no_more_often_than_a_guess) {
  // Of 2^16 guesses at 2^-16 more than 8 come with a probability below 1e-5; these are the same each run.
  const double most = 8.0 / 0x10000;
  EXPECT_LE(share_that_passes([](Command& c, std::uint8_t&, Freshness&) { c.sequence ^= 1U; }), most);
  EXPECT_LE(share_that_passes([](Command& c, std::uint8_t&, Freshness&) { c.op = Op::Offer; }), most);
  EXPECT_LE(share_that_passes([](Command& c, std::uint8_t&, Freshness&) { c.argument ^= 8U; }), most);
  EXPECT_LE(share_that_passes([](Command& c, std::uint8_t&, Freshness&) { c.a ^= 0x800U; }), most);
  EXPECT_LE(share_that_passes([](Command& c, std::uint8_t&, Freshness&) { c.b ^= 1U; }), most);
  EXPECT_LE(share_that_passes([](Command&, std::uint8_t& node, Freshness&) { node = 3; }), most);
  EXPECT_LE(share_that_passes([](Command&, std::uint8_t&, Freshness& f) { f.number ^= 0x80000000U; }), most);
  EXPECT_LE(share_that_passes([](Command&, std::uint8_t&, Freshness& f) { f.epoch ^= 1U; }), most);
}

TEST(Seal, a_proof_of_a_number_is_no_seal_and_binds_node_number_and_nonce) {
  const auto proof = [](std::uint8_t node, std::uint32_t number, Nonce nonce) {
    return number_answer(kKey, node, ArmStep::Proof, number, nonce);
  };
  const std::uint16_t right = proof(2, 70000, {1, 2, 3});
  EXPECT_NE(proof(3, 70000, {1, 2, 3}), right);
  EXPECT_NE(proof(2, 70001, {1, 2, 3}), right);
  EXPECT_NE(proof(2, 70000, {1, 2, 4}), right);
  EXPECT_EQ(number_answer(kKey, 2, ArmStep::LowHalf, 70000, {}), 70000 & 0xFFFF);
  EXPECT_EQ(number_answer(kKey, 2, ArmStep::HighHalf, 70000, {}), 1);
}

}  // namespace
}  // namespace pinjaw::wire
