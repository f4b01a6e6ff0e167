#include "protocol/socketcan/lasting_bus.hpp"

#include <utility>

namespace pinjaw::socketcan {

bus::Expected<std::unique_ptr<LastingBus>> LastingBus::open(const std::string& interface,
                                                            const Settings& settings) {
  const Opener opener = [interface, settings] {
    return SocketBus::open(interface, settings).map([](std::unique_ptr<SocketBus> opened) {
      return std::unique_ptr<bus::Bus>(std::move(opened));
    });
  };
  auto opened = opener();
  if (!opened) return tl::unexpected(opened.error());
  return std::make_unique<LastingBus>(std::move(*opened), opener, settings.now_us);
}

LastingBus::LastingBus(std::unique_ptr<bus::Bus> opened, Opener opener, Clock now_us)
    : open_(std::move(opened)), opener_(std::move(opener)), now_us_(std::move(now_us)) {}

bus::Expected<void> LastingBus::send(const wire::Frame& frame) {
  bus::Bus* bus = present();
  if (bus == nullptr) {
    ++past_.lost_sending;
    return tl::unexpected(why_);
  }
  auto sent = bus->send(frame);
  if (!sent && sent.error().kind != bus::FailureKind::Overflow) lose(sent.error());
  return sent;
}

bus::Expected<std::optional<bus::Received>> LastingBus::receive() {
  bus::Bus* bus = present();
  if (bus == nullptr) return tl::unexpected(why_);
  auto received = bus->receive();
  if (!received) lose(received.error());
  return received;
}

bus::Statistics LastingBus::statistics() const {
  bus::Statistics statistics = past_;
  if (open_) statistics += open_->statistics();
  return statistics;
}

bus::Health LastingBus::health() const {
  bus::Health health = open_ ? open_->health() : bus::Health{.off = true};
  health.overruns += static_cast<std::uint32_t>(past_.lost_receiving + past_.overruns);
  return health;
}

void LastingBus::restart() {
  if (open_) open_->restart();
}

bus::Bus* LastingBus::present() {
  if (open_ || now_us_() < next_try_us_) return open_.get();
  auto opened = opener_();
  if (opened) {
    open_ = std::move(*opened);
  } else {
    why_ = opened.error();
    next_try_us_ = now_us_() + kRetry_us;
  }
  return open_.get();
}

void LastingBus::lose(const bus::Failure& why) {
  past_ += open_->statistics();
  ++past_.outages;
  open_.reset();
  why_ = why;
  next_try_us_ = now_us_() + kRetry_us;
}

}  // namespace pinjaw::socketcan
