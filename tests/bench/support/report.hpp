#pragma once

#include <iosfwd>
#include <string>
#include <vector>

namespace pinjaw::bench {

/// A peer's figure for the thing measured, from the same run.
struct PeerFigure {
  std::string name;
  double value = 0;
  double at_least = 0;  ///< the ratio that is asked of ours; 0: none
};

/// One measured thing: ours, and the peers' figures beside it.
struct Measurement {
  std::string thing;
  std::string unit;  ///< of all its figures: "us of CPU time", "s of CPU time", "MB"
  double ours = 0;
  std::vector<PeerFigure> peers{};
  double at_most = 0;  ///< a bar for ours itself; 0: none
  std::string note{};  ///< conditions a reader needs, such as counts
};

/// All that a run of the bench measured. Figures are costs, so a ratio is the peer's over ours.
class Report {
 public:
  /// Keeps the measurement and prints it to `out` at once.
  explicit Report(std::ostream& out) : out_(out) {}
  void add(Measurement measurement);

  /// CONTRACT: for each measured thing its name, ours and each peer's figure, the ratio, the unit, the
  /// machine.
  [[nodiscard]] std::string json() const;

 private:
  std::ostream& out_;
  std::vector<Measurement> measurements_;
};

}  // namespace pinjaw::bench
