#include "host/config/key_file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cctype>
#include <cerrno>
#include <string>
#include <string_view>
#include <system_error>

#include "host/config/fields.hpp"

namespace pinjaw::config {
namespace {

constexpr std::size_t kMostBytes = 1024;

std::optional<unsigned> hexadecimal_digit(char digit) {
  if (digit >= '0' && digit <= '9') return static_cast<unsigned>(digit - '0');
  const char lower = static_cast<char>(std::tolower(static_cast<unsigned char>(digit)));
  if (lower >= 'a' && lower <= 'f') return static_cast<unsigned>(lower - 'a' + 10);
  return std::nullopt;
}

std::string_view without_spaces_around(std::string_view text) {
  constexpr std::string_view kSpaces = " \t\r\n";
  const auto first = text.find_first_not_of(kSpaces);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(kSpaces) - first + 1);
}

/// The content of an opened key file; its permissions are those of what is read, not of what was named.
base::Expected<std::string> content_of(int file) {
  struct stat about {};
  if (::fstat(file, &about) != 0) return base::failure(std::generic_category().message(errno));
  if (!S_ISREG(about.st_mode)) return base::failure("is not a regular file");
  if ((about.st_mode & S_IRWXO) != 0) {
    return base::failure("everyone can read or change it; a key is its owner's: chmod 600");
  }
  std::string text(kMostBytes, '\0');
  const ssize_t length = ::read(file, text.data(), text.size());
  if (length < 0) return base::failure(std::generic_category().message(errno));
  text.resize(static_cast<std::size_t>(length));
  return text;
}

}  // namespace

base::Expected<std::array<std::uint8_t, 16>> read_key_file(const std::filesystem::path& path) {
  const auto wrong = [&path](const std::string& why) {
    return base::failure(fmt::format("key file {}: {}", path.string(), why));
  };
  const int file = ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NOCTTY | O_NONBLOCK);
  if (file < 0) return wrong("cannot be read: " + std::generic_category().message(errno));
  const base::Expected<std::string> content = content_of(file);
  ::close(file);
  if (!content) return wrong(content.error().message);
  const std::string_view digits = without_spaces_around(*content);
  std::array<std::uint8_t, 16> key{};
  if (digits.size() != 2 * key.size()) return wrong("expected 32 hexadecimal digits and nothing else");
  for (std::size_t i = 0; i < key.size(); ++i) {
    const auto high = hexadecimal_digit(digits[2 * i]);
    const auto low = hexadecimal_digit(digits[2 * i + 1]);
    if (!high || !low) return wrong("expected 32 hexadecimal digits and nothing else");
    key[i] = static_cast<std::uint8_t>(*high << 4U | *low);
  }
  return key;
}

std::optional<model::Authentication> read_authentication(const base::YamlValue& value) {
  base::YamlMap map = value.map("settings {key_file: ...}");
  std::optional<model::Authentication> authentication;
  if (const auto file = map.require("key_file")) {
    if (const auto path = named_file(*file)) {
      if (const auto key = read_key_file(*path)) {
        authentication = model::Authentication{.key = *key};
      } else {
        file->mistake(key.error().message);
      }
    }
  }
  if (const auto can_fd = map.find("can_fd")) {
    const bool wanted = can_fd->truth().value_or(false);
    if (authentication) authentication->can_fd = wanted;
  }
  map.finish();
  return authentication;
}

}  // namespace pinjaw::config
