#include "host/jaw_client/layout_transfer.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include "protocol/wire/bits.hpp"

namespace pinjaw::jaw_client {

namespace {

const char* verb(wire::Service service) {
  switch (service) {
    case wire::Service::Write:
      return "WRITE";
    case wire::Service::Commit:
      return "COMMIT";
    default:
      return "READBACK";
  }
}

}  // namespace

void LayoutTransfer::begin(const wire::Layout& layout) {
  layout_ = wire::encode(layout);
  crc_ = wire::layout_crc_of(layout);
  outcome_ = {};
  flow_.clear();
  request(wire::Service::Write);
}

void LayoutTransfer::request(wire::Service service) {
  service_ = service;
  tries_ = 0;
  ask();
}

void LayoutTransfer::ask() {
  ++tries_;
  ++transaction_;
  std::array<std::uint8_t, wire::kMaxTransferBytes> bytes{};
  wire::ByteWriter out(bytes);
  out.put(static_cast<std::uint8_t>(service_), 1);
  out.put(transaction_, 1);
  if (service_ == wire::Service::Commit) out.put(crc_, 4);
  if (service_ == wire::Service::Write) {
    for (const std::uint8_t byte : layout_.span()) out.put(byte, 1);
  }
  sender_.start(std::span(bytes).first(out.used()));
  patience_.start(kAnswer_ms);
}

void LayoutTransfer::try_again() {
  if (tries_ < kTries) return ask();
  outcome_.kind = OutcomeKind::Silent;
  outcome_.sentence = std::string("no answer to ") + verb(service_);
}

void LayoutTransfer::refuse(wire::TransferStatus status) {
  outcome_.kind = wire::is_force_refusal(status) ? OutcomeKind::ForceRefused : OutcomeKind::Refused;
  outcome_.status = status;
  outcome_.sentence = std::string(verb(service_)) + " was refused: " + wire::to_string(status);
}

void LayoutTransfer::take(const wire::Payload& segment) {
  if (wire::kind_of(segment) == wire::SegmentKind::FlowControl) {
    sender_.accept(segment);
    return;
  }
  if (const auto flow = receiver_.accept(segment)) flow_.push_back(*flow);
  if (const auto response = receiver_.take()) answered(*response);
}

void LayoutTransfer::answered(std::span<const std::uint8_t> response) {
  if (!outcome_.pending() || response.size() < wire::kResponseHeader) return;
  if (response[0] != (static_cast<unsigned>(service_) | wire::kResponseBit) || response[1] != transaction_)
    return;
  if (response[2] >= wire::kTransferStatusCount) return;
  const auto status = static_cast<wire::TransferStatus>(response[2]);
  sender_.cancel();
  if (status != wire::TransferStatus::Ok) return refuse(status);
  content(response.subspan(wire::kResponseHeader));
}

void LayoutTransfer::content(std::span<const std::uint8_t> body) {
  if (service_ == wire::Service::Readback) {
    const std::span<const std::uint8_t> meant = layout_.span();
    if (!std::equal(body.begin(), body.end(), meant.begin(), meant.end())) {
      return refuse(wire::TransferStatus::CommitDiffers);
    }
    outcome_.kind = OutcomeKind::Done;
    return;
  }
  wire::ByteReader in(body);
  const std::uint32_t told = in.take(4);
  if (service_ == wire::Service::Write) {
    if (in.truncated() || told != crc_) return refuse(wire::TransferStatus::LayoutChecksum);
    return request(wire::Service::Commit);
  }
  request(wire::Service::Readback);
}

std::vector<wire::Payload> LayoutTransfer::advance(std::uint16_t elapsed_ms) {
  std::vector<wire::Payload> out = std::exchange(flow_, {});
  receiver_.advance(elapsed_ms);
  if (const auto segment = sender_.advance(elapsed_ms)) out.push_back(*segment);
  if (!outcome_.pending()) return out;
  if (sender_.busy() || receiver_.busy()) {
    patience_.start(kAnswer_ms);
  } else {
    patience_.advance(elapsed_ms);
    if (!patience_.running()) try_again();
  }
  return out;
}

}  // namespace pinjaw::jaw_client
