#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "protocol/bus/bus.hpp"

/// candump's log format, `(seconds.micros) interface ID#DATA`, as canplayer, python-can and tshark read it.
namespace pinjaw::bus {

struct LogLine {
  std::int64_t time_us = 0;
  std::string interface;
  wire::Frame frame;
  friend bool operator==(const LogLine&, const LogLine&) = default;
};

/// One line without its end; always six decimals, which canplayer insists on.
std::string to_log_line(const LogLine& line);

/// A line of a log, or a sentence about what is wrong with it. Of CAN FD, frames of 12 bytes are read and
/// others refused.
Expected<LogLine> parse_log_line(std::string_view text);

}  // namespace pinjaw::bus
