#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace pinjaw::world {

/// What one station does to the part within one millisecond.
struct Touch {
  int node = 0;
  bool passive = false;
  bool seated = false;  ///< the part rests on it
  double least_n = 0;   ///< squeeze at its least in this millisecond; 0 where it has no contact
  double needed_n = 0;  ///< squeeze with which it alone would hold the part; infinite: it cannot
};

/// A jaw presses, or the part rests on the station.
[[nodiscard]] bool touches(const Touch& touch);

/// Alone, the station would hold the part. A passive one holds what rests on it, unless told it needs a
/// squeeze.
[[nodiscard]] bool holds(const Touch& touch);

/// Whether the part is held, slides or falls; latched from one Place to the next.
///
/// A part held by several stays while one of them alone would hold it. Where none would and something still
/// touches it, it slides under the share of gravity that the best of them leaves, and has fallen after
/// kLost_mm. Where nothing touches it, it has fallen at once.
class PartTruth {
 public:
  void place();
  /// A hand holds it as well; it counts for the part's fall, not as a holder.
  void set_hand(bool on) { hand_ = on; }
  void remove();

  /// One millisecond.
  void observe(const std::vector<Touch>& touches, double time_s);

  [[nodiscard]] bool placed() const { return placed_; }
  [[nodiscard]] bool hand() const { return hand_; }
  /// It is where stations can touch it.
  [[nodiscard]] bool here() const { return placed_ && !dropped_; }
  [[nodiscard]] const std::vector<int>& holders() const { return holders_; }
  [[nodiscard]] std::optional<int> min_holders() const { return min_holders_; }
  [[nodiscard]] bool slipped() const { return slipped_; }
  [[nodiscard]] double slip_mm() const { return slip_mm_; }
  [[nodiscard]] bool dropped() const { return dropped_; }
  [[nodiscard]] double dropped_at_s() const { return dropped_at_s_; }

  static constexpr double kLost_mm = 2.0;  // chosen: twice the usual minimum engagement of a pin

 private:
  void slide(const std::vector<Touch>& touches, double time_s);
  void drop(double time_s);

  bool placed_ = false;
  bool hand_ = false;
  std::vector<int> holders_;
  std::optional<int> min_holders_;
  bool slipped_ = false;
  double slip_speed_mm_s_ = 0;
  double slip_mm_ = 0;
  bool dropped_ = false;
  double dropped_at_s_ = 0;
};

}  // namespace pinjaw::world
