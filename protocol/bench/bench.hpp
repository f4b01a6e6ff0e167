#pragma once

#include <array>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <tl/expected.hpp>
#include <utility>
#include <variant>
#include <vector>

/// What a run says to a world, the simulated truth, and what the world answers. These messages never travel
/// on CAN: no controller hears them, and only a run's oracle asks for the truth.
namespace pinjaw::bench {

/// How one station grips the part: what the world must be told, since it knows no planning.
struct Grasp {
  int node = 0;              ///< 1..14
  double separation_mm = 0;  ///< jaw separation at which all pins of the station's layout touch the part
  double needed_n = 0;  ///< squeeze (sum of both jaws) that holds the part at rest; 0 for a passive station
};

/// A fresh part is put down on the passive station `on`, or between the open jaws of it and held there by
/// hand until the station holds it. The statistics of the truth start again. Only `on` is at the part (see
/// Meet).
struct Place {
  int on = 0;
  std::vector<Grasp> grasps;  ///< one per station that will ever grip this part
};

/// A hand takes hold of the part, and takes it away as soon as no jaw presses on it and the local enable of
/// the station is let go (whoever holds the button still waits for the release). Refused where the station
/// does not touch it.
struct Remove {
  int from = 0;
};

/// The frames of these stations coincide in plan from now on (the handoff frame of the cell): each can touch
/// the part, and a passive one among them carries it. Stations not named are away. Refused where a station
/// that now grips the part is not named.
struct Meet {
  std::vector<int> nodes;
};

/// The local enable input (hold-to-run button) of a node.
struct Enable {
  int node = 0;
  bool on = false;
};

/// The station travels, with the part when it grips it, and leaves the stations that it met. Refused while
/// another station grips the part too. Its inertia is told by Disturb.
struct Move {
  int node = 0;
  double seconds = 0;
  double peak_g = 0;
  std::array<double, 3> along = {1, 0, 0};
};

/// As Move, turning about the station's own axis.
struct Rotate {
  int node = 0;
  double angle_rad = 0;
  double seconds = 0;
  double peak_g = 0;
};

struct NeededSqueeze {
  int node = 0;
  double squeeze_n = 0;  ///< may be infinite: no squeeze of this station resists
};

/// The wrench that acts on the part from now on, as the squeeze each station needs to balance it alone.
/// Stations not named keep what they needed.
struct Disturb {
  std::string name;
  std::vector<NeededSqueeze> needed;
};

/// Electric power of a node off or on. Off is a cut: what is not in its permanent memory is lost.
struct Power {
  int node = 0;
  bool on = true;
};

/// A fault of a node's plant from now on, `leak=0.05` for one; the world's help lists what it knows.
struct Break {
  int node = 0;
  std::string fault;
};

struct AskTruth {};

using Request = std::variant<Place, Remove, Meet, Enable, Move, Rotate, Disturb, Power, Break, AskTruth>;

struct NodeTruth {
  int node = 0;
  bool passive = false;
  bool powered = true;
  bool touches = false;  ///< a jaw presses on the part, or the part rests on the station
  bool holds = false;    ///< alone it would hold the part against the present disturbance
  bool seated = false;   ///< the part rests on the station's seats
  double separation_mm = 0;
  double squeeze_n = 0;  ///< true contact force now, sum of both jaws
  double left_n = 0;     ///< of it, on the left jaw
  double right_n = 0;
  double needed_n = 0;       ///< under the present disturbance
  double limit_n = 0;        ///< of the hardware
  double max_squeeze_n = 0;  ///< largest true squeeze on a part since the last Place
  double max_steady_n = 0;   ///< largest true squeeze that lasted longer than 20 ms
  double over_limit_s = 0;   ///< total time with the true squeeze above limit_n
};

/// The simulated truth at one instant, and what was seen since the last Place.
struct Truth {
  double time_s = 0;
  bool placed = false;  ///< a part is in the cell
  std::string disturbance;
  std::vector<int> holders;        ///< stations that each hold the part; ascending
  std::optional<int> min_holders;  ///< least number of holders at any instant; nothing before the first Place
  bool slipped = false;            ///< latched: jaws touched it and none held it
  double slip_mm = 0;              ///< how far it slid in all
  bool dropped = false;            ///< latched: nothing touched it, or it slid out
  double dropped_at_s = 0;
  std::vector<NodeTruth> nodes;  ///< ascending by node
};

struct Done {};

/// The world did not do it, and why, for a person.
struct Refused {
  std::string reason;
};

using Reply = std::variant<Done, Refused, Truth>;

/// The world cannot be reached, or a line is not a message.
struct Trouble {
  std::string message;
};

/// One line of JSON, without the line feed.
std::string encode(const Request& request);
std::string encode(const Reply& reply);
tl::expected<Request, Trouble> decode_request(std::string_view line);
tl::expected<Reply, Trouble> decode_reply(std::string_view line);

/// A run's end of the bench, over any transport.
class WorldPort {
 public:
  WorldPort() = default;
  WorldPort(const WorldPort&) = delete;
  WorldPort& operator=(const WorldPort&) = delete;
  virtual ~WorldPort() = default;

  /// Asks and waits for the answer.
  virtual tl::expected<Reply, Trouble> ask(const Request& request) = 0;
};

using Handler = std::function<Reply(const Request&)>;

/// A world in the same process: every request is a call.
class InProcessWorld final : public WorldPort {
 public:
  explicit InProcessWorld(Handler handler) : handler_(std::move(handler)) {}
  tl::expected<Reply, Trouble> ask(const Request& request) override { return handler_(request); }

 private:
  Handler handler_;
};

}  // namespace pinjaw::bench
