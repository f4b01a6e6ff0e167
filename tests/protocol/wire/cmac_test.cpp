// Promises: AUTH-MAC.
#include "protocol/wire/cmac.hpp"

#include <gtest/gtest.h>

#include <random>
#include <string>
#include <vector>

#include "tests/protocol/wire/reference_mac.hpp"
#include "tests/support/figures.hpp"

/// AES-128 and its CMAC against the standards' examples and OpenSSL.
namespace pinjaw::wire {
namespace {

using testing::openssl_aes;
using testing::openssl_cmac;

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

}  // namespace
}  // namespace pinjaw::wire
