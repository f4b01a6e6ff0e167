#include "protocol/bench/bench.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

namespace pinjaw::bench {
namespace {

using ::testing::HasSubstr;

std::vector<Request> every_request() {
  return {Place{3, {{1, 31.25, 12.5}, {3, 0, 0}}},
          Remove{3},
          Meet{{1, 3}},
          Enable{3, true},
          Move{1, 2.0, 0.5, {0, 0, -1}},
          Rotate{1, 3.14159, 2, 6},
          Disturb{"spray[17]", {{1, 77.1}, {2, std::numeric_limits<double>::infinity()}}},
          Power{2, false},
          Break{2, "leak=0.05"},
          AskTruth{}};
}

TEST(Bench, every_request_comes_back_from_its_line) {
  const std::vector<Request> requests = every_request();
  ASSERT_EQ(requests.size(), std::variant_size_v<Request>);
  for (std::size_t i = 0; i < requests.size(); ++i) {
    EXPECT_EQ(requests[i].index(), i);
    const std::string line = encode(requests[i]);
    EXPECT_EQ(line.find('\n'), std::string::npos);
    const auto decoded = decode_request(line);
    ASSERT_TRUE(decoded) << line << ": " << decoded.error().message;
    EXPECT_EQ(decoded->index(), i);
    EXPECT_EQ(encode(*decoded), line);
  }
}

TEST(Bench, an_infinite_need_survives) {
  const auto decoded = decode_request(encode(every_request()[6]));
  ASSERT_TRUE(decoded);
  EXPECT_EQ(std::get<Disturb>(*decoded).needed[1].squeeze_n, std::numeric_limits<double>::infinity());
}

TEST(Bench, every_reply_comes_back_from_its_line) {
  Truth truth;
  truth.time_s = 1.2345678901234567;
  truth.holders = {1, 3};
  truth.min_holders = 1;
  truth.nodes = {{.node = 1, .squeeze_n = 80.1, .needed_n = 77.1}, {.node = 3, .passive = true}};
  for (const Reply& reply : {Reply(Done{}), Reply(Refused{"no"}), Reply(truth), Reply(Truth{})}) {
    const auto decoded = decode_reply(encode(reply));
    ASSERT_TRUE(decoded) << decoded.error().message;
    EXPECT_EQ(encode(*decoded), encode(reply));
  }
  const auto again = std::get<Truth>(*decode_reply(encode(Reply(truth))));
  EXPECT_EQ(again.time_s, truth.time_s);
  EXPECT_EQ(again.min_holders, 1);
}

TEST(Bench, what_is_no_message_is_told) {
  const auto why = [](const char* line) {
    const auto decoded = decode_request(line);
    return decoded ? std::string("decoded") : decoded.error().message;
  };
  EXPECT_THAT(why(""), HasSubstr("parse error"));
  EXPECT_THAT(why("[]"), HasSubstr("one message"));
  EXPECT_THAT(why(R"({"place":{},"remove":{}})"), HasSubstr("one message"));
  EXPECT_THAT(why(R"({"explode":{}})"), HasSubstr("no such message: explode"));
  EXPECT_THAT(why(R"({"remove":{}})"), HasSubstr("from"));
  EXPECT_THAT(why(R"({"remove":{"from":"three"}})"), HasSubstr("type"));
  EXPECT_THAT(why(R"({"remove":{"from":3,"frm":4}})"), HasSubstr("remove: a key"));
}

TEST(Bench, in_process_a_request_is_a_call) {
  InProcessWorld world([](const Request& request) -> Reply {
    return Refused{"remove " + std::to_string(std::get<Remove>(request).from)};
  });
  const auto reply = world.ask(Remove{3});
  ASSERT_TRUE(reply);
  EXPECT_EQ(std::get<Refused>(*reply).reason, "remove 3");
}

}  // namespace
}  // namespace pinjaw::bench
