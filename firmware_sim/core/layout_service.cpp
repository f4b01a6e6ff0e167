#include "firmware_sim/core/layout_service.hpp"

#include <optional>
#include <span>

#include "firmware_sim/core/sending.hpp"
#include "firmware_sim/core/transitions.hpp"
#include "protocol/wire/identification.hpp"

namespace pinjaw::core {
namespace {

using wire::TransferStatus;

wire::LayoutTarget target_of(const Config& config) {
  return {.node = config.node,
          .node_class = config.passive ? wire::NodeClass::Passive : wire::NodeClass::Gripper,
          .kit_id = config.kit_id,
          .f_hardware_dn = static_cast<std::uint16_t>(config.hardware_limit_dn),
          .f_uncertainty_dn = static_cast<std::uint16_t>(config.uncertainty_dn)};
}

void take_up_layout(State& state) {
  state.layouts.committed = true;
  state.layouts.is_staged = false;
  state.layouts.layout = state.layouts.staged;
  state.layouts.crc = wire::layout_crc_of(state.layouts.layout);
  state.peers.follow(state.layouts.layout);
}

/// An answer under construction, in the room of the sender.
class ServiceAnswer {
 public:
  ServiceAnswer(State& state, wire::Service service, std::uint8_t transaction, TransferStatus status)
      : sender_(state.service.sender), out_(sender_.compose()) {
    out_.put(static_cast<unsigned>(service) | wire::kResponseBit, 1);
    out_.put(transaction, 1);
    out_.put(static_cast<std::uint8_t>(status), 1);
  }
  wire::ByteWriter& body() { return out_; }
  void start() const { sender_.start(out_.used()); }

 private:
  wire::TransferSender& sender_;
  wire::ByteWriter out_;
};

void answer_status(State& state, wire::Service service, std::uint8_t transaction, TransferStatus status) {
  ServiceAnswer(state, service, transaction, status).start();
}

void answer_commit(State& state, std::uint8_t transaction) {
  ServiceAnswer answer(state, wire::Service::Commit, transaction, TransferStatus::Ok);
  answer.body().put(state.layouts.crc, 4);
  answer.start();
}

TransferStatus write(State& state, std::span<const std::uint8_t> body) {
  if (!apply(state, Event::CmdWrite)) return TransferStatus::WrongState;
  const TransferStatus status = wire::decode_layout(body, state.layouts.staged);
  state.layouts.is_staged = status == TransferStatus::Ok;
  return status;
}

/// Ok where the layout is now being stored, or was committed already.
TransferStatus commit(State& state, std::uint32_t crc) {
  const Layouts& layouts = state.layouts;
  if (!layouts.is_staged) {
    const bool again = layouts.committed && layouts.crc == crc;
    return again ? TransferStatus::Ok : TransferStatus::NothingStaged;
  }
  if (wire::layout_crc_of(layouts.staged) != crc) return TransferStatus::CommitDiffers;
  const TransferStatus status = wire::admissible(layouts.staged, target_of(state.config));
  if (status != TransferStatus::Ok) {
    state.faults.note(wire::FaultCode::LayoutRefused);
    return status;
  }
  if (!apply(state, Event::CmdCommit)) return TransferStatus::WrongState;
  take_up_layout(state);
  state.store.layout_waits = true;
  return TransferStatus::Ok;
}

void serve_write(State& state, std::uint8_t transaction, std::span<const std::uint8_t> body) {
  const TransferStatus status = write(state, body);
  ServiceAnswer answer(state, wire::Service::Write, transaction, status);
  if (status == TransferStatus::Ok) answer.body().put(wire::layout_crc_of(state.layouts.staged), 4);
  answer.start();
}

void serve_commit(State& state, std::uint8_t transaction, std::span<const std::uint8_t> body) {
  wire::ByteReader in(body);
  const std::uint32_t crc = in.take(4);
  const bool well_formed = !in.truncated() && in.left() == 0;
  const TransferStatus status = well_formed ? commit(state, crc) : TransferStatus::Length;
  if (status != TransferStatus::Ok) {
    return answer_status(state, wire::Service::Commit, transaction, status);
  }
  state.service.commit_waits = true;
  state.service.commit_transaction = transaction;
}

void serve_readback(State& state, std::uint8_t transaction) {
  if (!state.layouts.committed)
    return answer_status(state, wire::Service::Readback, transaction, TransferStatus::NothingStaged);
  ServiceAnswer answer(state, wire::Service::Readback, transaction, TransferStatus::Ok);
  wire::encode(state.layouts.layout, answer.body());
  answer.start();
}

void serve_identify(State& state, std::uint8_t transaction) {
  const wire::LayoutTarget target = target_of(state.config);
  ServiceAnswer answer(state, wire::Service::Identify, transaction, TransferStatus::Ok);
  wire::Identification{.node = target.node,
                       .node_class = target.node_class,
                       .kit_id = target.kit_id,
                       .f_hardware_dn = target.f_hardware_dn,
                       .f_uncertainty_dn = target.f_uncertainty_dn,
                       .layout_crc = state.layouts.crc,
                       .layout_committed = state.layouts.committed}
      .put(answer.body());
  answer.start();
  state.identity_burst = true;
  state.identity_page = 0;
  state.timers.identity.stop();
}

void serve_log(State& state, std::uint8_t transaction) {
  ServiceAnswer answer(state, wire::Service::Log, transaction, TransferStatus::Ok);
  const Counters& counters = state.counters;
  for (const std::uint32_t count :
       {counters.bad_frames, counters.events_ignored, counters.events_refused, counters.frames_not_sent,
        counters.steps, counters.wrong_macs, state.link.refused(), state.service.receiver.ignored()}) {
    answer.body().put(count, 4);
  }
  answer.start();
}

void serve(State& state, std::span<const std::uint8_t> request) {
  if (request.size() < wire::kRequestHeader) return;
  const std::uint8_t transaction = request[1];
  const std::span<const std::uint8_t> body = request.subspan(wire::kRequestHeader);
  const auto service = static_cast<wire::Service>(request[0]);
  switch (service) {
    case wire::Service::Write:
      return serve_write(state, transaction, body);
    case wire::Service::Commit:
      return serve_commit(state, transaction, body);
    case wire::Service::Readback:
      return serve_readback(state, transaction);
    case wire::Service::Identify:
      return serve_identify(state, transaction);
    case wire::Service::Log:
      return serve_log(state, transaction);
    default:
      return answer_status(state, service, transaction, TransferStatus::UnknownService);
  }
}

void send_segment(State& state, SendQueue& queue, const wire::Payload& data) {
  const wire::Identifier id{wire::MessageType::TransferResponse, state.config.node};
  send(state, queue, wire::pack_segment({id, data}));
}

}  // namespace

void take_segment(State& state, const wire::Segment& segment, SendQueue& queue) {
  if (wire::kind_of(segment.data) == wire::SegmentKind::FlowControl)
    return state.service.sender.accept(segment.data);
  if (const auto flow = state.service.receiver.accept(segment.data)) send_segment(state, queue, *flow);
  if (const auto request = state.service.receiver.take()) serve(state, *request);
}

void advance_service(State& state, std::uint16_t elapsed_ms, SendQueue& queue) {
  LayoutService& service = state.service;
  service.receiver.advance(elapsed_ms);
  if (service.commit_waits && (state.store.failed || state.store.durable())) {
    service.commit_waits = false;
    if (state.store.failed) {
      answer_status(state, wire::Service::Commit, service.commit_transaction, TransferStatus::Memory);
    } else {
      answer_commit(state, service.commit_transaction);
    }
  }
  if (const auto segment = service.sender.advance(elapsed_ms)) send_segment(state, queue, *segment);
}

void restore_layout(State& state, const LayoutBlob& blob) {
  if (blob.size > blob.bytes.size()) return;
  const std::span<const std::uint8_t> record = std::span(blob.bytes).first(blob.size);
  wire::Layout& layout = state.layouts.staged;
  if (wire::decode_layout(record, layout) != TransferStatus::Ok) return;
  if (wire::admissible(layout, target_of(state.config)) == TransferStatus::Ok) take_up_layout(state);
}

}  // namespace pinjaw::core
