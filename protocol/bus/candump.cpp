#include "protocol/bus/candump.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cstddef>
#include <cstdio>

namespace pinjaw::bus {

namespace {

constexpr std::uint32_t kErrorFlag = 0x20000000;  // as candump prints error frames
constexpr std::uint32_t kExtendedMask = 0x1FFFFFFF;
constexpr std::uint32_t kStandardMask = 0x7FF;

tl::unexpected<Failure> bad(std::string_view text, std::string_view why) {
  return tl::unexpected(Failure{FailureKind::System, std::string("not a line of a candump log (") +
                                                         std::string(why) + "): " + std::string(text)});
}

/// The number that all of `digits` spells.
template <class Number>
std::optional<Number> number_of(std::string_view digits, int base) {
  Number value = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value, base);
  if (error != std::errc{} || end != digits.data() + digits.size() || digits.empty()) return std::nullopt;
  return value;
}

std::optional<std::int64_t> time_of(std::string_view stamp) {
  const std::size_t point = stamp.find('.');
  if (point == std::string_view::npos || stamp.size() - point - 1 != 6) return std::nullopt;
  const auto seconds = number_of<std::uint32_t>(stamp.substr(0, point), 10);
  const auto micros = number_of<std::uint32_t>(stamp.substr(point + 1), 10);
  if (!seconds || !micros) return std::nullopt;
  return std::int64_t{*seconds} * 1'000'000 + *micros;
}

bool read_id(std::string_view digits, wire::Frame& frame) {
  const auto id = number_of<std::uint32_t>(digits, 16);
  if (!id) return false;
  if (digits.size() == 3) {
    frame.id = *id;
    return *id <= kStandardMask;
  }
  if (digits.size() != 8) return false;
  if ((*id & kErrorFlag) != 0) {
    frame.kind = wire::FrameKind::Error;
    frame.id = *id & kExtendedMask;
  } else {
    frame.extended = true;
    frame.id = *id;
  }
  return *id <= (kErrorFlag | kExtendedMask);
}

/// Flags and the 12 bytes of a CAN FD frame of ours; other lengths are not ours.
bool read_fd_data(std::string_view digits, wire::Frame& frame) {
  constexpr std::size_t kDigits = 1 + 2 * std::size_t{wire::kFdLength};
  if (frame.kind == wire::FrameKind::Error || digits.size() != kDigits ||
      !number_of<std::uint8_t>(digits.substr(0, 1), 16))
    return false;
  frame.kind = wire::FrameKind::Fd;
  frame.length = wire::kFdLength;
  for (std::size_t i = 0; i < wire::kFdLength; ++i) {
    const auto byte = number_of<std::uint8_t>(digits.substr(1 + 2 * i, 2), 16);
    if (!byte) return false;
    (i < frame.data.size() ? frame.data[i] : frame.tail[i - frame.data.size()]) = *byte;
  }
  return true;
}

bool read_data(std::string_view digits, wire::Frame& frame) {
  if (digits.starts_with('#')) return read_fd_data(digits.substr(1), frame);
  if (!digits.empty() && digits.front() == 'R') {
    if (frame.kind == wire::FrameKind::Error) return false;
    frame.kind = wire::FrameKind::Remote;
    if (digits.size() > 2) return false;
    const auto length = digits.size() == 2 ? number_of<std::uint8_t>(digits.substr(1), 16) : std::uint8_t{0};
    if (!length || *length > 8) return false;
    frame.length = *length;
    return true;
  }
  if (digits.size() % 2 != 0 || digits.size() > 16) return false;
  frame.length = static_cast<std::uint8_t>(digits.size() / 2);
  for (std::size_t i = 0; i < frame.length; ++i) {
    const auto byte = number_of<std::uint8_t>(digits.substr(2 * i, 2), 16);
    if (!byte) return false;
    frame.data[i] = *byte;
  }
  return true;
}

}  // namespace

std::string to_log_line(const LogLine& line) {
  std::array<char, 64> head{};
  std::snprintf(head.data(), head.size(), "(%010lld.%06lld) ",
                static_cast<long long>(line.time_us / 1'000'000),
                static_cast<long long>(line.time_us % 1'000'000));
  std::string text = head.data() + line.interface + ' ';
  const bool error = line.frame.kind == wire::FrameKind::Error;
  const bool wide = line.frame.extended || error;
  std::snprintf(head.data(), head.size(), wide ? "%08X#" : "%03X#",
                line.frame.id | (error ? kErrorFlag : 0U));
  text += head.data();
  if (line.frame.kind == wire::FrameKind::Remote) {
    text += 'R';
    if (line.frame.length > 0) text += static_cast<char>('0' + std::min<int>(line.frame.length, 8));
    return text;
  }
  const bool fd = line.frame.kind == wire::FrameKind::Fd;
  if (fd) text += "#1";  // with a bit rate switch
  for (std::size_t i = 0; i < std::min<std::size_t>(line.frame.length, 8); ++i) {
    std::snprintf(head.data(), head.size(), "%02X", unsigned{line.frame.data[i]});
    text += head.data();
  }
  for (std::size_t i = 0; fd && i < line.frame.tail.size(); ++i) {
    std::snprintf(head.data(), head.size(), "%02X", unsigned{line.frame.tail[i]});
    text += head.data();
  }
  return text;
}

Expected<LogLine> parse_log_line(std::string_view text) {
  LogLine line;
  const std::size_t close = text.find(") ");
  if (text.empty() || text.front() != '(' || close == std::string_view::npos) return bad(text, "no time");
  const auto time_us = time_of(text.substr(1, close - 1));
  if (!time_us) return bad(text, "time is not seconds with six decimals");
  line.time_us = *time_us;
  std::string_view rest = text.substr(close + 2);
  const std::size_t space = rest.find(' ');
  if (space == std::string_view::npos || space == 0) return bad(text, "no interface");
  line.interface = rest.substr(0, space);
  rest.remove_prefix(space + 1);
  while (!rest.empty() && (rest.back() == '\r' || rest.back() == ' ')) rest.remove_suffix(1);
  if (rest.ends_with(" R") || rest.ends_with(" T")) rest.remove_suffix(2);  // direction, as newer tools write
  const std::size_t hash = rest.find('#');
  if (hash == std::string_view::npos) return bad(text, "no frame");
  if (!read_id(rest.substr(0, hash), line.frame)) return bad(text, "no such id");
  if (!read_data(rest.substr(hash + 1), line.frame))
    return bad(text, "data are neither up to 8 bytes nor CAN FD's 12");
  return line;
}

}  // namespace pinjaw::bus
