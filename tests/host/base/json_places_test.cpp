#include "host/base/json_places.hpp"

#include <gtest/gtest.h>

namespace pinjaw::base {
namespace {

Place place_of(const std::string& key, std::string_view text) {
  const Diagnostics placed = placed_in_json(Diagnostics({{"f", 0, 0}, key, "wrong"}), text);
  return placed.begin()->place;
}

constexpr std::string_view kText = R"({"a": 1,
 "list": [{"b": "x, \"y\" ]"}, [2,
   3]],
 "c": {"d": null}
})";

TEST(JsonPlaces, are_those_where_values_begin) {
  EXPECT_EQ(place_of("a", kText), (Place{"f", 1, 7}));
  EXPECT_EQ(place_of("list[0].b", kText), (Place{"f", 2, 17}));
  EXPECT_EQ(place_of("list[1][1]", kText), (Place{"f", 3, 4}));
  EXPECT_EQ(place_of("c.d", kText), (Place{"f", 4, 13}));
}

TEST(JsonPlaces, of_what_is_missing_are_its_holder_s) {
  EXPECT_EQ(place_of("c.missing.deeper", kText), (Place{"f", 4, 7}));
  EXPECT_EQ(place_of("list[7]", kText), (Place{"f", 2, 10}));
  EXPECT_EQ(place_of("nothing", kText), (Place{"f", 1, 1}));
  EXPECT_EQ(place_of("a", "3"), (Place{"f", 1, 1}));
}

}  // namespace
}  // namespace pinjaw::base
