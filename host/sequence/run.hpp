#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "host/model/sequence.hpp"
#include "host/sequence/crew.hpp"
#include "host/sequence/run_report.hpp"
#include "host/sequence/script.hpp"

namespace pinjaw::sequence {

/// Where a run takes place. Both must outlive it.
struct Venue {
  bus::Bus* bus = nullptr;            ///< not null
  bench::WorldPort* world = nullptr;  ///< nothing: the report says `"plant": null`
  /// Loses a share (0..1) of all frames for so many seconds from now on; empty where the bus cannot.
  std::function<void(double share, double seconds)> lose_frames;
};

/// Plays a script on the controllers, step by step, and writes down what happened. It has no clock: its
/// caller steps it, at least every 5 ms of the time it passes in.
///
/// A failed handoff is tried again, three times at most; after any other failure the run ends, aborted, with
/// the part wherever it is held. A killed host falls silent at once; the run then only watches, for
/// kAftermathS.
class Run {
 public:
  static constexpr double kAftermathS = 5;

  Run(const model::Sequence& sequence, const Crew& crew, std::vector<StepScript> scripts, Venue venue,
      jaw_client::Client::Settings host);

  void step(std::int64_t now_us);
  [[nodiscard]] bool over() const { return over_; }
  /// What kind of trouble ended the run; nothing where it is done or goes on.
  [[nodiscard]] std::optional<Trouble> trouble() const { return trouble_; }
  /// Name of the step being played.
  [[nodiscard]] const std::string& playing() const;

  /// Precondition: over(). Asks the world for the truth.
  [[nodiscard]] RunReport report();

 private:
  void note_states();
  /// Faults of the script that are due.
  void inject_faults();
  void play();
  void begin_try();
  void advance(const ActionState& state);
  void finish_step(const std::string& result);
  /// Undoes the try where there may be another, else gives up.
  void fail(const Failed& failure);
  void give_up(const Failed& failure);
  [[nodiscard]] double time_s() const {
    return static_cast<double>(now_us_ - started_us_.value_or(now_us_)) * 1e-6;
  }
  [[nodiscard]] StepReport& current();
  [[nodiscard]] const std::vector<Action>& list() const;

  const model::Sequence& sequence_;
  std::vector<int> nodes_;
  std::vector<StepScript> scripts_;
  Venue venue_;
  std::vector<bool> injected_;
  jaw_client::Client client_;
  Stage stage_;
  RunReport report_;
  std::vector<StateChange> last_;

  std::size_t step_ = 0;
  std::size_t action_ = 0;
  bool undoing_ = false;
  bool begun_ = false;
  bool killed_ = false;
  bool over_ = false;
  std::optional<Trouble> trouble_;
  std::optional<std::int64_t> started_us_;
  std::int64_t now_us_ = 0;
  std::int64_t action_since_us_ = 0;
  double over_at_s_ = 0;
};

}  // namespace pinjaw::sequence
