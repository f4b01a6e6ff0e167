#pragma once

#include <gtest/gtest.h>
#include <openssl/core_names.h>
#include <openssl/evp.h>
#include <openssl/params.h>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "protocol/wire/cmac.hpp"

/// AES-128 and its CMAC as OpenSSL has them, and the messages of docs/authentication.md byte by byte.
namespace pinjaw::wire::testing {

using Bytes = std::vector<std::uint8_t>;

inline AesBlock openssl_aes(const Key& key, const AesBlock& block) {
  const std::unique_ptr<EVP_CIPHER_CTX, decltype(&EVP_CIPHER_CTX_free)> context(EVP_CIPHER_CTX_new(),
                                                                                &EVP_CIPHER_CTX_free);
  AesBlock out{};
  int length = 0;
  EXPECT_EQ(EVP_EncryptInit_ex(context.get(), EVP_aes_128_ecb(), nullptr, key.data(), nullptr), 1);
  EVP_CIPHER_CTX_set_padding(context.get(), 0);
  EXPECT_EQ(EVP_EncryptUpdate(context.get(), out.data(), &length, block.data(), 16), 1);
  return out;
}

inline AesBlock openssl_cmac(const Key& key, const Bytes& message) {
  static const std::unique_ptr<EVP_MAC, decltype(&EVP_MAC_free)> kind(EVP_MAC_fetch(nullptr, "CMAC", nullptr),
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

/// `message` with `number` behind it, the low byte first.
inline Bytes with_number(Bytes message, std::uint64_t number, int bytes) {
  for (; bytes > 0; --bytes, number /= 256) message.push_back(static_cast<std::uint8_t>(number % 256));
  return message;
}

}  // namespace pinjaw::wire::testing
