#include "tests/protocol/timing/response_times.hpp"

#include <algorithm>
#include <array>
#include <cstdio>
#include <numeric>

#include "protocol/wire/timing.hpp"
#include "protocol/wire/transfer.hpp"

namespace pinjaw::timing {
namespace {

using wire::MessageType;

constexpr std::int64_t kStep_us = 1000;
constexpr std::int64_t kCommandSpacing_us = 20'000;  // chosen: a host that is quicker than any of ours

/// Least time between two frames of one id, where the table's period is not it.
std::int64_t period_us(const wire::MessageSpec& spec) {
  switch (spec.type) {
    case MessageType::GlobalHold:
      return wire::kGlobalHoldSpacing_ms * 1000;
    case MessageType::Custody:
      return wire::kCustodyHandoff_ms * 1000;
    case MessageType::Command:
    case MessageType::Acknowledge:
      return kCommandSpacing_us;
    case MessageType::TransferRequest:
    case MessageType::TransferResponse:
      return wire::kSegmentGap_ms * 1000;
    default:
      return spec.period_ms * 1000;
  }
}

/// One sender only: hosts', a GLOBAL_HOLD, which all that hear it need once, and the one transfer there is.
bool once(const wire::MessageSpec& spec) {
  return !spec.per_node || spec.type == MessageType::GlobalHold ||
         spec.type == MessageType::TransferRequest || spec.type == MessageType::TransferResponse;
}

std::int64_t divided_up(std::int64_t value, std::int64_t by) {
  return (value + by - 1) / by;
}

/// Frames of `stream` released within `span_ns`.
std::int64_t released(const Stream& stream, std::int64_t span_ns) {
  return divided_up(span_ns + stream.jitter_us * 1000, stream.period_us * 1000);
}

/// The fixed point that `next` grows to from `start`; nothing past `limit_ns`.
template <class Next>
std::optional<std::int64_t> fixed_point(std::int64_t start, std::int64_t limit_ns, const Next& next) {
  for (std::int64_t value = start; value <= limit_ns;) {
    const std::int64_t grown = next(value);
    if (grown == value) return value;
    value = grown;
  }
  return std::nullopt;
}

std::string milliseconds(std::optional<std::int64_t> ns) {
  if (!ns) return "overloaded";
  std::array<char, 16> text{};
  std::snprintf(text.data(), text.size(), "%.1f", static_cast<double>(*ns) * 1e-6);
  return text.data();
}

}  // namespace

Traffic worst_traffic(int nodes, std::int64_t bit_rate) {
  Traffic traffic{.nodes = nodes, .bit_rate = bit_rate, .streams = {}};
  for (const wire::MessageSpec& spec : wire::kMessages) {
    const int senders = once(spec) ? 1 : nodes;
    for (int i = 1; i <= senders; ++i) {
      const auto node = static_cast<std::uint8_t>(spec.per_node ? i : 0);
      traffic.streams.push_back({spec.type, node, period_us(spec), kStep_us});
    }
  }
  std::ranges::sort(traffic.streams, {}, &Stream::id);
  return traffic;
}

std::int64_t frame_ns(std::int64_t bit_rate) {
  return kLongestFrame_bits * 1'000'000'000 / bit_rate;
}

double load(const Traffic& traffic) {
  double load = 0;
  for (const Stream& stream : traffic.streams) {
    load += static_cast<double>(frame_ns(traffic.bit_rate)) / (static_cast<double>(stream.period_us) * 1e3);
  }
  return load;
}

std::optional<std::int64_t> response_ns(const Traffic& traffic, const Stream& stream) {
  constexpr std::int64_t kLimit_ns = 10'000'000'000;
  const std::int64_t frame = frame_ns(traffic.bit_rate);
  const std::int64_t bit = 1'000'000'000 / traffic.bit_rate;
  const auto own = std::ranges::find(traffic.streams, stream.id(), &Stream::id);
  const std::vector<Stream> higher(traffic.streams.begin(), own);
  const auto interference = [&](std::int64_t span_ns) {
    return std::accumulate(
        higher.begin(), higher.end(), std::int64_t{0},
        [&](std::int64_t sum, const Stream& one) { return sum + released(one, span_ns) * frame; });
  };
  const std::int64_t blocking = own + 1 == traffic.streams.end() ? 0 : frame;  // equation 4
  const auto busy = fixed_point(frame, kLimit_ns, [&](std::int64_t t) {        // equation 9
    return blocking + interference(t) + released(stream, t) * frame;
  });
  if (!busy) return std::nullopt;
  std::int64_t worst = 0;
  for (std::int64_t q = 0; q < released(stream, *busy); ++q) {  // equations 7, 8, 10 and 11
    const auto waits = fixed_point(blocking + q * frame, kLimit_ns, [&](std::int64_t w) {
      return blocking + q * frame + interference(w + bit);
    });
    if (!waits) return std::nullopt;
    worst = std::max(worst, stream.jitter_us * 1000 + *waits - q * stream.period_us * 1000 + frame);
  }
  return worst;
}

std::optional<std::int64_t> response_ns(const Traffic& traffic, wire::MessageType type) {
  std::int64_t worst = 0;
  for (const Stream& stream : traffic.streams) {
    if (stream.type != type) continue;
    const auto response = response_ns(traffic, stream);
    if (!response) return std::nullopt;
    worst = std::max(worst, *response);
  }
  return worst;
}

std::int64_t spare_frames(const Traffic& traffic) {
  const std::int64_t slack_ns = (wire::kPeerFresh_ms - 3 * wire::kStatePeriod_ms) * std::int64_t{1'000'000} -
                                response_ns(traffic, MessageType::State).value_or(1'000'000'000);
  return slack_ns / frame_ns(traffic.bit_rate);
}

std::string table() {
  std::string text = "| nodes | kbit/s | load |";
  std::string rule = "| --- | --- | --- |";
  for (const wire::MessageSpec& spec : wire::kMessages) {
    text += std::string(" ") + spec.name + " |";
    rule += " --- |";
  }
  text += " spare |\n" + rule + " --- |\n";
  for (const std::int64_t bit_rate : {500'000, 1'000'000}) {
    for (const int nodes : {3, 6, 8}) {
      const Traffic traffic = worst_traffic(nodes, bit_rate);
      std::array<char, 64> head{};
      std::snprintf(head.data(), head.size(), "| %d | %d | %.1f %% |", nodes,
                    static_cast<int>(bit_rate / 1000), 100 * load(traffic));
      text += head.data();
      for (const wire::MessageSpec& spec : wire::kMessages)
        text += " " + milliseconds(response_ns(traffic, spec.type)) + " |";
      text += " " + std::to_string(spare_frames(traffic)) + " |\n";
    }
  }
  return text;
}

}  // namespace pinjaw::timing
