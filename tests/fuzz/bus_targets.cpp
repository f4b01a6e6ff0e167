// Promises: FUZZ, CODEC, TRANSFER.
//
// What takes bytes from the bus or from memory: frames, segments, layouts, custody records.
#include <algorithm>
#include <array>
#include <optional>
#include <span>

#include "firmware_sim/core/core.hpp"
#include "firmware_sim/core/record.hpp"
#include "protocol/wire/dispatch.hpp"
#include "protocol/wire/layout.hpp"
#include "protocol/wire/transfer.hpp"
#include "tests/firmware_sim/core/toy_jaw.hpp"
#include "tests/firmware_sim/faults/scenes.hpp"
#include "tests/fuzz/byte_source.hpp"
#include "tests/fuzz/targets.hpp"

namespace pinjaw::fuzz {
namespace {

/// What was parsed says the same frame again.
struct SaysItAgain {
  const wire::Frame& frame;
  template <class Message>
  void operator()(const wire::Received<Message>& received) const {
    must(wire::pack(received.message, received.label) == frame, "a frame is not said again as it was parsed");
  }
  void operator()(const wire::Segment& segment) const {
    must(wire::pack_segment(segment) == frame, "a segment is not said again as it was parsed");
  }
};

void answer_frames(std::string_view bytes) {
  ByteSource source(bytes);
  while (!source.empty()) {
    const wire::Frame frame = source.frame();
    const auto error = wire::dispatch(frame, SaysItAgain{frame});
    if (!error) must(frame.length == 8 && !frame.extended, "a message in a frame of another form");
  }
}

/// Two machines of a transfer and a line between them that a script disturbs.
class Line {
 public:
  explicit Line(ByteSource& script) : script_(script) {
    std::vector<std::uint8_t> message(1 + script.below(wire::kMaxTransferBytes));
    for (std::size_t i = 0; i < message.size(); ++i)
      message[i] = static_cast<std::uint8_t>(7 * i + message.size());
    sent_ = message;
    must(sender_.start(message), "a message of 1 to 256 bytes is not sent");
  }

  void run() {
    constexpr int kLongest_ms = 20'000;  // 37 gaps of at most 127 ms, and every wait that may come between
    for (int ms = 0; ms < kLongest_ms && (!script_.empty() || sender_.busy() || receiver_.busy()); ++ms)
      step();
    must(!sender_.busy(), "a sender that never ends");
    for (int ms = 0; ms <= wire::kTransferTimeout_ms; ++ms) receiver_.advance(1);
    must(!receiver_.busy(), "a receiver that never ends");
  }

 private:
  void step() {
    receiver_.advance(1);
    if (const auto segment = sender_.advance(1)) pass_on(*segment);
    if (!script_.empty() && script_.below(8) == 0) {
      hostile_ = true;
      to_receiver(script_.payload());
    }
  }

  void pass_on(wire::Payload segment) {
    switch (script_.empty() ? 0 : script_.below(12)) {
      case 1:
        return;
      case 2:
        to_receiver(segment);
        break;
      case 3:
        segment[script_.below(8)] = script_.byte();
        hostile_ = true;
        break;
      default:
        break;
    }
    to_receiver(segment);
  }

  void to_receiver(const wire::Payload& segment) {
    const auto flow = receiver_.accept(segment);
    if (const auto message = receiver_.take()) {
      must(message->size() <= wire::kMaxTransferBytes && !message->empty(), "a message of impossible length");
      must(hostile_ || std::ranges::equal(*message, sent_), "a message other than the one that was sent");
    }
    if (!flow) return;
    must(wire::kind_of(*flow) == wire::SegmentKind::FlowControl, "an answer that is no flow control");
    if (!script_.empty() && script_.below(10) == 0) {
      sender_.accept(script_.payload());
    } else {
      sender_.accept(*flow);
    }
  }

  ByteSource& script_;
  std::vector<std::uint8_t> sent_;
  wire::TransferSender sender_;
  wire::TransferReceiver receiver_;
  bool hostile_ = false;
};

void answer_transfer(std::string_view bytes) {
  ByteSource script(bytes);
  Line(script).run();
}

void put_crc(std::vector<std::uint8_t>& bytes, std::size_t from, std::size_t to) {
  if (to + 4 > bytes.size()) return;
  wire::ByteWriter(std::span(bytes).subspan(to, 4))
      .put(wire::crc_of<wire::Crc32>(std::span(bytes).subspan(from, to - from)), 4);
}

/// Both checksums of a layout made right, where there is room for them.
void seal_layout(std::vector<std::uint8_t>& bytes) {
  constexpr std::size_t kPinCount = 20;  // place of the number of pins
  if (bytes.size() <= kPinCount) return;
  const std::size_t body = kPinCount + 1 + std::size_t{6} * bytes[kPinCount] + 17;
  put_crc(bytes, 0, body);
  const std::size_t peers = body + 4;
  if (peers < bytes.size()) put_crc(bytes, peers, peers + 1 + std::size_t{9} * bytes[peers]);
}

/// First byte: whether the checksums are made right. The rest is the record.
void answer_layout(std::string_view text) {
  if (text.empty()) return;
  std::vector<std::uint8_t> bytes(text.begin() + 1, text.end());
  if (text[0] % 2 != 0) seal_layout(bytes);
  const auto layout = wire::decode_layout(bytes);
  if (!layout) return must(layout.error() != wire::TransferStatus::Ok, "refused as good");
  must(std::ranges::equal(wire::encode(*layout).span(), bytes),
       "a layout that is not said again as it was read");
  must(layout->f_required_dn <= layout->f_limit_dn, "a layout that needs more force than it allows");
  const wire::LayoutTarget target{.node = 1,
                                  .node_class = layout->node_class,
                                  .kit_id = layout->kit_id,
                                  .f_hardware_dn = 1400,
                                  .f_uncertainty_dn = 120};
  if (wire::admissible(*layout, target) != wire::TransferStatus::Ok) return;
  must(layout->f_limit_dn <= 1400 || layout->passive, "a layout over the hardware's limit is admitted");
}

template <std::size_t Size>
void seal_slot(std::array<std::uint8_t, Size>& slot) {
  std::span<std::uint8_t> bytes(slot);
  wire::ByteWriter(bytes.last(4)).put(wire::crc_of<wire::Crc32>(bytes.first(Size - 4)), 4);
}

/// Whatever memory holds, a controller comes up that opens nothing it has not decided to open.
void comes_up(const core::NvmImage& image) {
  core::Config config;
  config.node = core::test::kArm;
  config.kit_id = 0x1234;
  core::State state = core::power_on(config, image);
  core::test::ToyJaw jaw;
  jaw.part_10um = 3000;
  jaw.separation_10um = 3000;
  const bool decided = image.record && image.record->custody == core::Custody::Decided;
  for (int ms = 0; ms < 20; ++ms) {
    const core::Outputs outputs =
        core::step(state, {.sensors = jaw.read(), .nvm = {.done = state.store.requested}});
    must(decided || outputs.valves.spool != core::Spool::Open, "a controller opens as it comes up");
    jaw.step(outputs.valves);
  }
  must(static_cast<std::size_t>(state.id) < core::kStates, "no state");
}

/// First byte: which slots get a right checksum. Then the slots, what is missing blank.
void answer_memory(std::string_view bytes) {
  ByteSource source(bytes);
  const std::uint8_t flags = source.byte();
  core::Memory memory;
  for (auto& slot : memory.records) source.fill(slot);
  for (auto& slot : memory.layouts) source.fill(slot);
  for (std::size_t i = 0; i < 2; ++i) {
    if ((flags >> i & 1U) != 0) seal_slot(memory.records[i]);
    if ((flags >> (2 + i) & 1U) != 0) seal_slot(memory.layouts[i]);
    if (const auto record = core::decode_record(memory.records[i])) {
      must(core::encode(*record) == memory.records[i], "a record that is not stored again as it was read");
    }
  }
  const core::NvmImage image = core::image_of(memory);
  must(image.readable || !image.record, "an unreadable record that was read");
  comes_up(image);
  const core::NvmWrite request{
      .sequence = 1, .record = image.record.value_or(core::NvmRecord{.token = 7}), .layout = std::nullopt};
  const core::MemoryUpdate update(memory, request);
  for (std::size_t i = 0; i < update.size(); ++i) {
    update.put(i, memory);
    const core::NvmImage cut = core::image_of(memory);
    must(!image.record || cut.record == image.record, "a store cut short loses the record");
  }
  must(core::image_of(memory).record == request.record, "a record does not come back");
}

}  // namespace

std::vector<Target> bus_targets() {
  std::vector<Target> all = {{"frame", answer_frames, {}, "bus.dict"},
                             {"transfer", answer_transfer, {}, "bus.dict"},
                             {"layout-record", answer_layout, {}, "bus.dict"},
                             {"custody-record", answer_memory, {}, "bus.dict"}};
  for (const Target& target : controller_targets()) all.push_back(target);
  for (const Target& target : link_targets()) all.push_back(target);
  return all;
}

}  // namespace pinjaw::fuzz
