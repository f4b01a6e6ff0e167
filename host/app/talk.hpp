#pragma once

#include <functional>
#include <memory>
#include <string>

#include "host/app/context.hpp"
#include "host/app/venue.hpp"
#include "host/jaw_client/client.hpp"

namespace pinjaw::app {

inline constexpr double kAnswerS = 2;  ///< chosen: after it, a controller counts as not there

/// A host of its own for one command: a heartbeat with a fresh epoch on a CAN interface, for as long as it
/// lives.
class Talk {
 public:
  /// Nothing, with the exit code set, where the bus cannot be opened (sim: lives inside run and demo alone).
  static std::unique_ptr<Talk> open(Context& context);

  Talk(const Talk&) = delete;
  Talk& operator=(const Talk&) = delete;

  [[nodiscard]] jaw_client::Client& client() { return client_; }

  /// Begins an operation and waits for its end. False, with the reason told and the exit code set, where it
  /// did not come to a good one.
  bool carry_out(std::uint8_t node, const std::function<void(jaw_client::Client&)>& begin);

  /// Waits until `condition` holds; false, with exit code 5 and `otherwise`, after `seconds`.
  bool wait_for(double seconds, const std::string& otherwise, const std::function<bool()>& condition);

 private:
  Talk(Context& context, std::unique_ptr<Venue> venue, jaw_client::Client::Settings host);
  void tick();

  Context& context_;
  std::unique_ptr<Venue> venue_;
  jaw_client::Client client_;
  std::int64_t now_us_ = 0;
};

/// What a person wants to know of a node's outcome: the exit code it stands for.
ExitCode code_of(const jaw_client::Outcome& outcome);

}  // namespace pinjaw::app
