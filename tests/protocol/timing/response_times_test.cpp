// Promises: TIME-BUS.
// What the analysis says of response times, the page that tells it, and the in-process bus, on which no frame
// may take longer.
#include "tests/protocol/timing/response_times.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <map>
#include <random>
#include <sstream>

#include "protocol/bus/frame_bits.hpp"
#include "protocol/bus/sim_bus.hpp"
#include "protocol/wire/timing.hpp"
#include "protocol/wire/transfer.hpp"
#include "tests/support/figures.hpp"
#include "tests/support/places.hpp"

namespace pinjaw::timing {
namespace {

using wire::MessageType;

constexpr std::array<std::int64_t, 2> kBitRates = {500'000, 1'000'000};
constexpr std::array kNodes = {3, 6, 8};

/// Where a test runs every night it simulates longer.
int simulated_s() {
  const char* seconds = std::getenv("PINJAW_TIMING_SECONDS");
  return seconds != nullptr ? std::atoi(seconds) : 3;
}

TEST(ResponseTimes, of_the_page_are_those_of_the_message_table) {
  std::stringstream page;
  page << std::ifstream(test::source_dir("docs/timing.md")).rdbuf();
  EXPECT_NE(page.str().find("\n\n" + table() + "\n"), std::string::npos) << "docs/timing.md should say:\n"
                                                                         << table();
}

/// Section 7.2 of the paper: three messages of 135 bits at 125 kbit/s, periods 2.5, 3.5 and 3.5 ms, of which
/// the analysis before 2007 missed that the last may take 3.5 ms, its second instance more than its first.
TEST(ResponseTimes, are_those_of_the_paper_s_own_example) {
  Traffic traffic{.nodes = 1, .bit_rate = 135'000, .streams = {}};  // a frame takes 1 ms, as there
  traffic.streams = {{MessageType::GlobalHold, 0, 2500, 0},
                     {MessageType::Fault, 1, 3500, 0},
                     {MessageType::Custody, 1, 3500, 0}};
  const auto rounded_ms = [&](int i) {
    const auto ns = response_ns(traffic, traffic.streams.at(static_cast<std::size_t>(i)));
    return ns ? static_cast<double>(*ns) * 1e-6 : -1;
  };
  EXPECT_NEAR(rounded_ms(0), 2.0, 1e-3);
  EXPECT_NEAR(rounded_ms(1), 3.0, 1e-3);
  EXPECT_NEAR(rounded_ms(2), 3.5, 1e-3);
}

TEST(ResponseTimes, of_an_overloaded_bus_are_none) {
  const Traffic traffic = worst_traffic(8, 125'000);
  EXPECT_GT(load(traffic), 1);
  EXPECT_FALSE(response_ns(traffic, MessageType::TransferResponse));
}

TEST(ResponseTimes, leave_every_message_its_deadline_and_peers_and_hosts_their_freshness) {
  for (const std::int64_t bit_rate : kBitRates) {
    for (const int nodes : kNodes) {
      const Traffic traffic = worst_traffic(nodes, bit_rate);
      for (const Stream& stream : traffic.streams) {
        const auto response = response_ns(traffic, stream);
        ASSERT_TRUE(response);
        if (stream.type == MessageType::TransferRequest || stream.type == MessageType::TransferResponse) {
          EXPECT_LE(*response, wire::kTransferTimeout_ms * 1'000'000);
        } else {
          EXPECT_LE(*response, stream.period_us * 1000) << stream.id() << " of " << nodes;
        }
      }
      EXPECT_LT(*response_ns(traffic, MessageType::State) + 3 * wire::kStatePeriod_ms * 1'000'000,
                wire::kPeerFresh_ms * 1'000'000);
      EXPECT_LT(*response_ns(traffic, MessageType::HostHeartbeat) + 3 * wire::kHostHeartbeat_ms * 1'000'000,
                wire::kHostFresh_ms * 1'000'000);
      EXPECT_LT(*response_ns(traffic, MessageType::Command) +
                    *response_ns(traffic, MessageType::Acknowledge) + 2'000'000,
                wire::kAcknowledge_ms * 1'000'000)
          << "a host that repeats sooner would do so for nothing";
      EXPECT_GE(spare_frames(traffic), 0);
    }
  }
}

/// Data with which the frame of this id is longest, of those that alternate a few bits.
wire::Frame longest(std::uint32_t id) {
  wire::Frame best{.id = id};
  for (unsigned pattern = 0; pattern < 256; ++pattern) {
    wire::Frame frame{.id = id};
    frame.data.fill(static_cast<std::uint8_t>(pattern));
    for (const std::uint8_t last : {std::uint8_t{0}, static_cast<std::uint8_t>(pattern)}) {
      frame.data[7] = last;
      if (bus::bits_on_bus(frame) > bus::bits_on_bus(best)) best = frame;
    }
  }
  return best;
}

TEST(ResponseTimes, no_frame_is_longer_than_the_analysis_takes_them_to_be) {
  std::int64_t most = 0;
  for (const Stream& stream : worst_traffic(14, 500'000).streams)
    most = std::max<std::int64_t>(most, bus::bits_on_bus(longest(stream.id())));
  EXPECT_LE(most, kLongestFrame_bits);
  EXPECT_GT(most, 125) << "else the measurement below would not press";
}

/// The streams of a traffic on the in-process bus: each released at its period from an offset, handed to the
/// bus up to its jitter later, and timed from release to last bit.
class Measurement {
 public:
  Measurement(const Traffic& traffic, std::uint64_t seed)
      : traffic_(traffic), random_(seed), bus_({.bit_rate = traffic.bit_rate, .seed = seed}) {
    bus_.on_frame([this](const bus::Received& received) { take(received); });
    for (const Stream& stream : traffic_.streams) {
      sources_[stream.id()] = {
          .stream = stream, .frame = longest(stream.id()), .end = bus_.open({{0, 0x7FF}})};
    }
  }

  /// All released at once, then each by its period, for `duration_us`.
  void run(std::int64_t duration_us, bool all_at_once) {
    for (auto& [id, source] : sources_)
      source.release(all_at_once ? 0 : draw(source.stream.period_us), draw_jitter(source));
    for (std::int64_t now_us = 0; now_us < duration_us; now_us += kTick_us) {
      bus_.advance_to(now_us);
      for (auto& [id, source] : sources_) {
        if (source.handed_us > now_us) continue;
        EXPECT_TRUE(source.end->send(source.frame).has_value());
        source.pending.push_back(source.released_us);
        source.release(source.released_us + source.stream.period_us, draw_jitter(source));
      }
    }
  }

  [[nodiscard]] std::int64_t worst_us(std::uint32_t id) const { return sources_.at(id).worst_us; }
  [[nodiscard]] std::int64_t frames() const { return frames_; }

 private:
  static constexpr std::int64_t kTick_us = 50;
  struct Source {
    Stream stream;
    wire::Frame frame;
    std::unique_ptr<bus::Bus> end{};
    std::vector<std::int64_t> pending{};
    std::int64_t released_us = 0;
    std::int64_t handed_us = 0;
    std::int64_t worst_us = 0;
    void release(std::int64_t at_us, std::int64_t late_us) {
      released_us = at_us;
      handed_us = at_us + late_us;
    }
  };

  std::int64_t draw(std::int64_t below_us) {
    return static_cast<std::int64_t>(random_() % static_cast<std::uint64_t>(below_us));
  }
  /// Late by nothing, all or any of the jitter; a tick less, for the bus takes it at the tick after.
  std::int64_t draw_jitter(const Source& source) {
    const std::int64_t most_us = source.stream.jitter_us - kTick_us;
    const std::int64_t kind = draw(3);
    return kind == 0 ? 0 : kind == 1 ? most_us : draw(most_us);
  }
  void take(const bus::Received& received) {
    Source& source = sources_.at(received.frame.id);
    source.worst_us = std::max(source.worst_us, received.time_us - source.pending.front());
    source.pending.erase(source.pending.begin());
    ++frames_;
  }

  Traffic traffic_;
  std::mt19937_64 random_;
  std::map<std::uint32_t, Source> sources_;
  bus::SimBus bus_;
  std::int64_t frames_ = 0;
};

TEST(ResponseTimes, no_frame_on_the_bus_takes_longer_than_the_analysis_says) {
  for (const std::int64_t bit_rate : kBitRates) {
    for (const int nodes : kNodes) {
      const Traffic traffic = worst_traffic(nodes, bit_rate);
      double closest = 0;
      std::int64_t frames = 0;
      std::map<std::uint32_t, std::int64_t> worst_us;
      for (const bool all_at_once : {true, false}) {
        Measurement measurement(traffic, 7);
        measurement.run(simulated_s() * std::int64_t{1'000'000} / 2, all_at_once);
        frames += measurement.frames();
        for (const Stream& stream : traffic.streams) {
          std::int64_t& worst = worst_us[stream.id()];
          worst = std::max(worst, measurement.worst_us(stream.id()));
        }
      }
      for (const Stream& stream : traffic.streams) {
        const std::int64_t bound_ns = response_ns(traffic, stream).value();
        EXPECT_LE(worst_us[stream.id()] * 1000, bound_ns)
            << std::hex << stream.id() << std::dec << " of " << nodes;
        EXPECT_GT(worst_us[stream.id()], 0) << std::hex << stream.id() << " never came";
        closest = std::max(closest,
                           static_cast<double>(worst_us[stream.id()]) * 1e3 / static_cast<double>(bound_ns));
      }
      EXPECT_GT(closest, 0.7) << "the measurement does not press";
      EXPECT_GT(frames, 1000);
      test::figure("TIME-BUS",
                   "worst measured / bound, " + std::to_string(nodes) + " nodes, " +
                       std::to_string(bit_rate / 1000) + " kbit/s",
                   closest);
    }
  }
}

}  // namespace
}  // namespace pinjaw::timing
