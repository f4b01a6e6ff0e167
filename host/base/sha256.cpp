#include "host/base/sha256.hpp"

#include <openssl/evp.h>

#include <array>
#include <stdexcept>

#include "host/base/files.hpp"

namespace pinjaw::base {

std::string sha256(std::string_view bytes) {
  std::array<unsigned char, EVP_MAX_MD_SIZE> digest{};
  unsigned int length = 0;
  if (EVP_Digest(bytes.data(), bytes.size(), digest.data(), &length, EVP_sha256(), nullptr) != 1) {
    throw std::logic_error("the cryptography library refuses SHA-256");
  }
  constexpr std::string_view kDigits = "0123456789abcdef";
  std::string text;
  for (unsigned int i = 0; i < length; ++i) {
    text += kDigits[digest[i] >> 4U];
    text += kDigits[digest[i] & 15U];
  }
  return text;
}

Expected<std::string> sha256_of_file(const std::filesystem::path& path) {
  const Expected<std::string> bytes = read_file(path);
  if (!bytes) return failure(path.string() + " " + bytes.error().message);
  return sha256(*bytes);
}

}  // namespace pinjaw::base
