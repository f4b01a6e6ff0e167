#include "tests/firmware_sim/core/recorder.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdlib>
#include <memory>
#include <new>
#include <optional>
#include <stdexcept>

#include "firmware_sim/target/firmware.hpp"
#include "firmware_sim/target/trace.hpp"

namespace pinjaw::core::test {
namespace {

#if defined(__has_builtin) && __has_builtin(__builtin_clear_padding)
template <class T>
void clear_padding(T& value) {
  __builtin_clear_padding(&value);
}
constexpr bool kRecords = true;
#else  // Clang 14, which builds the fuzzers
template <class T>
void clear_padding(T&) {}
constexpr bool kRecords = false;
#endif

/// A state as its default makes it, where all memory was `fill` before.
std::array<std::uint8_t, sizeof(State)> state_in(std::uint8_t fill) {
  alignas(State) std::array<std::uint8_t, sizeof(State)> memory{};
  memory.fill(fill);
  asm volatile("" : : "r"(memory.data()) : "memory");  // the fill is read below
  new (memory.data()) State;
  return memory;
}

/// Which bytes of a state count. Not padding: the compiler tells where that is, here and not on the other
/// processor, for GCC 12 clears wrong bytes of arrays in structures for 32-bit Arm, and nowhere what follows
/// the last member; a default state does not write there. And no optional, for an empty one holds what was in
/// memory before: of the gate its last command, of each peer what it may not know. Those show in what the
/// controller does.
trace::StateMask mask_of_state() {
  State state;
  const std::span<std::uint8_t> bytes = trace::bytes_of(state);
  std::ranges::fill(bytes, std::uint8_t{0xFF});
  clear_padding(state);
  const auto leave_out = [](std::span<std::uint8_t> optional) {
    std::ranges::fill(optional, std::uint8_t{0});
  };
  constexpr std::size_t kCommand = sizeof(std::optional<wire::Command>);
  leave_out(trace::bytes_of(state.gate).last(kCommand + sizeof(wire::Acknowledge)).first(kCommand));
  std::span<std::uint8_t> peers = trace::bytes_of(state.peers).last(wire::kMaxPeers * sizeof(Peer));
  for (; !peers.empty(); peers = peers.subspan(sizeof(Peer))) {
    for (const std::size_t at : {offsetof(Peer, custody), offsetof(Peer, past)}) {
      leave_out(peers.subspan(at + offsetof(wire::Custody, f_low_n), sizeof(wire::Custody::f_low_n)));
    }
    const auto status = peers.subspan(offsetof(Peer, state));
    leave_out(status.subspan(offsetof(wire::NodeState, f_low_dn), sizeof(wire::NodeState::f_low_dn)));
    leave_out(
        status.subspan(offsetof(wire::NodeState, separation_50um), sizeof(wire::NodeState::separation_50um)));
  }
  const auto zeros = state_in(0);
  const auto ones = state_in(0xFF);
  for (std::size_t i = 0; i < zeros.size(); ++i) {
    if (zeros.at(i) != ones.at(i)) bytes[i] = 0;
  }
  trace::StateMask mask;
  std::ranges::copy(bytes.last(mask.size()), mask.begin());
  return mask;
}

const trace::StateMask kMask = mask_of_state();

struct Into {
  std::vector<std::uint8_t>& bytes;
  void put(std::span<const std::uint8_t> added) { bytes.insert(bytes.end(), added.begin(), added.end()); }
};

void write_file(const std::string& path, const std::vector<const std::vector<std::uint8_t>*>& pieces) {
  std::ofstream file(path, std::ios::binary);
  for (const auto* piece : pieces) {
    file.write(reinterpret_cast<const char*>(piece->data()), static_cast<std::streamsize>(piece->size()));
  }
}

}  // namespace

Recorder* Recorder::wanted() {
  static const std::unique_ptr<Recorder> recorder = []() -> std::unique_ptr<Recorder> {
    const char* folder = std::getenv("PINJAW_TRACE");
    if (folder != nullptr && !kRecords)
      throw std::runtime_error("PINJAW_TRACE: this compiler clears no padding");
    return folder == nullptr ? nullptr : std::make_unique<Recorder>(folder);
  }();
  return recorder.get();
}

Recorder::Key Recorder::key_of(const State& state) {
  Config config = state.config;
  clear_padding(config);
  const auto bytes = trace::bytes_of(std::as_const(config)).first(trace::kConfigBytes);
  return {Bytes(bytes.begin(), bytes.end()), trace::digest_of(state, kMask)};
}

void Recorder::power_on(const Config& config, const NvmImage& image, const State& made) {
  if (config.table != &kStateTable || on_can_fd(config)) return;  // images have the true table, classic CAN
  Lane& lane = lanes_.emplace_back();
  Into into{lane.given};
  trace::Writer<Into> out{into};
  out.byte(trace::kPowerOn);
  const Key key = key_of(made);
  into.put(key.first);
  out.byte(image.record ? 1 : 0);
  if (image.record) out.raw(*image.record);
  out.byte(image.readable ? 1 : 0);
  out.byte(static_cast<std::uint8_t>(image.reset));
  out.raw(image.layout.size);
  into.put(std::span(image.layout.bytes).first(image.layout.size));
  at_[key] = lanes_.size() - 1;
}

void Recorder::before(const State& state) {
  current_ = lanes_.size();
  if (state.config.table != &kStateTable) return;
  const auto found = at_.find(key_of(state));
  if (found == at_.end()) return;
  current_ = found->second;
  at_.erase(found);
}

void Recorder::after(const Inputs& inputs, const Outputs& outputs, const State& state) {
  if (current_ == lanes_.size() || inputs.received.size() > firmware::kReceivedPerStep) {
    ++skipped_;
    return;
  }
  ++steps_;
  Lane& lane = lanes_[current_];
  Into given{lane.given};
  trace::Writer<Into> in{given};
  Inputs copy = inputs;
  clear_padding(copy);
  in.byte(trace::kStep);
  in.raw(inputs.elapsed_ms);
  given.put(trace::tail_of(copy));
  in.byte(static_cast<std::uint8_t>(inputs.received.size()));
  for (const wire::Frame& frame : inputs.received) in.frame(frame);

  Into made{lane.made};
  trace::Writer<Into> out{made};
  out.valves(outputs.valves);
  if (outputs.nvm) {
    out.byte('N');
    out.write(*outputs.nvm);
  }
  for (const wire::Frame& frame : outputs.send.view()) {
    out.byte('F');
    out.frame(frame);
  }
  if (outputs.restart_bus) out.byte('B');
  out.byte('.');
  const Key key = key_of(state);
  out.raw(key.second);
  at_[key] = current_;
}

Recorder::~Recorder() {
  Bytes head;
  Into into{head};
  trace::Writer<Into>{into}.raw(static_cast<std::uint16_t>(kMask.size()));
  into.put(kMask);
  std::vector<const Bytes*> given{&head};
  std::vector<const Bytes*> made;
  for (const Lane& lane : lanes_) {
    given.push_back(&lane.given);
    made.push_back(&lane.made);
  }
  const Bytes end{trace::kEnd};
  given.push_back(&end);
  write_file(folder_ + "/trace.in", given);
  write_file(folder_ + "/trace.expected", made);
  std::ofstream(folder_ + "/trace.counts") << lanes_.size() << ' ' << steps_ << ' ' << skipped_ << '\n';
}

}  // namespace pinjaw::core::test
