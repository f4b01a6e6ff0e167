#include "protocol/bench/bench.hpp"

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

namespace pinjaw::bench {
namespace {

using nlohmann::json;

/// JSON has no infinity: null stands for it.
json finite_or_null(double value) {
  return std::isfinite(value) ? json(value) : json(nullptr);
}

double number_or_infinite(const json& j) {
  return j.is_null() ? std::numeric_limits<double>::infinity() : j.get<double>();
}

}  // namespace

static void to_json(json& j, const NeededSqueeze& needed) {
  j = {{"node", needed.node}, {"squeeze_n", finite_or_null(needed.squeeze_n)}};
}
static void from_json(const json& j, NeededSqueeze& needed) {
  needed.node = j.at("node").get<int>();
  needed.squeeze_n = number_or_infinite(j.at("squeeze_n"));
}

NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Grasp, node, separation_mm, needed_n)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Place, on, grasps)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Remove, from)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Meet, nodes)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Enable, node, on)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Move, node, seconds, peak_g, along)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Rotate, node, angle_rad, seconds, peak_g)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Disturb, name, needed)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Power, node, on)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Break, node, fault)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Refused, reason)

static void to_json(json& j, const NodeTruth& t) {
  j = {{"node", t.node},
       {"passive", t.passive},
       {"powered", t.powered},
       {"touches", t.touches},
       {"holds", t.holds},
       {"seated", t.seated},
       {"separation_mm", t.separation_mm},
       {"squeeze_n", t.squeeze_n},
       {"left_n", t.left_n},
       {"right_n", t.right_n},
       {"needed_n", finite_or_null(t.needed_n)},
       {"limit_n", t.limit_n},
       {"max_squeeze_n", t.max_squeeze_n},
       {"max_steady_n", t.max_steady_n},
       {"over_limit_s", t.over_limit_s}};
}
static void from_json(const json& j, NodeTruth& t) {
  j.at("node").get_to(t.node);
  j.at("passive").get_to(t.passive);
  j.at("powered").get_to(t.powered);
  j.at("touches").get_to(t.touches);
  j.at("holds").get_to(t.holds);
  j.at("seated").get_to(t.seated);
  j.at("separation_mm").get_to(t.separation_mm);
  j.at("squeeze_n").get_to(t.squeeze_n);
  j.at("left_n").get_to(t.left_n);
  j.at("right_n").get_to(t.right_n);
  t.needed_n = number_or_infinite(j.at("needed_n"));
  j.at("limit_n").get_to(t.limit_n);
  j.at("max_squeeze_n").get_to(t.max_squeeze_n);
  j.at("max_steady_n").get_to(t.max_steady_n);
  j.at("over_limit_s").get_to(t.over_limit_s);
}

static void to_json(json& j, const Truth& t) {
  j = {{"time_s", t.time_s},
       {"placed", t.placed},
       {"disturbance", t.disturbance},
       {"holders", t.holders},
       {"min_holders", t.min_holders ? json(*t.min_holders) : json(nullptr)},
       {"slipped", t.slipped},
       {"slip_mm", t.slip_mm},
       {"dropped", t.dropped},
       {"dropped_at_s", t.dropped_at_s},
       {"nodes", t.nodes}};
}
static void from_json(const json& j, Truth& t) {
  j.at("time_s").get_to(t.time_s);
  j.at("placed").get_to(t.placed);
  j.at("disturbance").get_to(t.disturbance);
  j.at("holders").get_to(t.holders);
  t.min_holders =
      j.at("min_holders").is_null() ? std::nullopt : std::optional(j.at("min_holders").get<int>());
  j.at("slipped").get_to(t.slipped);
  j.at("slip_mm").get_to(t.slip_mm);
  j.at("dropped").get_to(t.dropped);
  j.at("dropped_at_s").get_to(t.dropped_at_s);
  j.at("nodes").get_to(t.nodes);
}

static void to_json(json& j, const AskTruth&) {
  j = json::object();
}
static void from_json(const json&, AskTruth&) {}
static void to_json(json& j, const Done&) {
  j = json::object();
}
static void from_json(const json&, Done&) {}

namespace {

/// The name of each message on the line, in the order of the variant.
constexpr std::array kRequestNames = {"place",  "remove",  "meet",  "enable", "move",
                                      "rotate", "disturb", "power", "break",  "ask_truth"};
constexpr std::array kReplyNames = {"done", "refused", "truth"};
static_assert(kRequestNames.size() == std::variant_size_v<Request>);
static_assert(kReplyNames.size() == std::variant_size_v<Reply>);

template <class Message, std::size_t kCount>
json to_line(const Message& message, const std::array<const char*, kCount>& names) {
  json body;
  std::visit([&](const auto& m) { to_json(body, m); }, message);
  return json{{names.at(message.index()), body}};
}

template <class Message, std::size_t kIndex = 0>
Message from_body(std::size_t index, const json& body) {
  if constexpr (kIndex + 1 < std::variant_size_v<Message>) {
    if (index != kIndex) return from_body<Message, kIndex + 1>(index, body);
  }
  return Message(std::in_place_index<kIndex>, body.get<std::variant_alternative_t<kIndex, Message>>());
}

template <class Message, std::size_t kCount>
tl::expected<Message, Trouble> decode(std::string_view line, const std::array<const char*, kCount>& names) {
  try {
    const json parsed = json::parse(line);
    if (!parsed.is_object() || parsed.size() != 1) {
      return tl::unexpected(Trouble{"expected one message, an object with one key"});
    }
    for (std::size_t i = 0; i < kCount; ++i) {
      if (!parsed.contains(names.at(i))) continue;
      Message message = from_body<Message>(i, parsed.at(names.at(i)));
      if (to_line(message, names) != parsed) {
        return tl::unexpected(
            Trouble{std::string(names.at(i)) + ": a key or value that this message has not"});
      }
      return message;
    }
    return tl::unexpected(Trouble{"no such message: " + parsed.begin().key()});
  } catch (const json::exception& mistake) {
    return tl::unexpected(Trouble{mistake.what()});
  }
}

}  // namespace

std::string encode(const Request& request) {
  return to_line(request, kRequestNames).dump();
}
std::string encode(const Reply& reply) {
  return to_line(reply, kReplyNames).dump();
}

tl::expected<Request, Trouble> decode_request(std::string_view line) {
  return decode<Request>(line, kRequestNames);
}
tl::expected<Reply, Trouble> decode_reply(std::string_view line) {
  return decode<Reply>(line, kReplyNames);
}

}  // namespace pinjaw::bench
