#include <gmock/gmock.h>

#include "tests/host/app/child.hpp"

namespace pinjaw::app_test {
namespace {

using testing::HasSubstr;

struct Mistake {
  const char* arguments;
  const char* sentence;
};

class Usage : public testing::TestWithParam<Mistake> {};

TEST_P(Usage, ends_with_2_and_a_sentence_on_stderr_alone) {
  const Bench bench;
  const Ran ran = bench.pinjaw(GetParam().arguments);
  EXPECT_EQ(ran.exit_code, 2);
  EXPECT_EQ(ran.out, "");
  EXPECT_THAT(ran.err, HasSubstr(GetParam().sentence));
  EXPECT_THAT(ran.err, testing::StartsWith("pinjaw: "));
  EXPECT_TRUE(bench.names().empty());
}

INSTANTIATE_TEST_SUITE_P(
    CommandLines, Usage,
    testing::Values(
        Mistake{"", "which command? pinjaw takes plan, planar,"},
        Mistake{"pln x", "there is no command pinjaw pln; did you mean plan?"},
        Mistake{"kit", "which command? pinjaw kit takes list, show, check"},
        Mistake{"kit lst", "there is no command pinjaw kit lst; did you mean list?"},
        Mistake{"jaw opn --node 1", "there is no command pinjaw jaw opn"},
        Mistake{"plan", "TASK is required\nRun 'pinjaw plan --help'"},
        Mistake{"plan ''", "expected the name of a file, found nothing"},
        Mistake{"plan a.yaml b.yaml", "pinjaw plan takes no further argument, found b.yaml"},
        Mistake{"plan a.yaml --thread 2", "there is no option --thread; did you mean --threads?"},
        Mistake{"plan a.yaml --threads", "--threads needs a value"},
        Mistake{"plan a.yaml --threads -1", "--threads: expected a whole number from 0 to 1024, found -1"},
        Mistake{"plan a.yaml --threads 1.5", "--threads: expected a whole number from 0 to 1024, found 1.5"},
        Mistake{"plan a.yaml --top 0", "--top: expected a whole number above 0 or all, found 0"},
        Mistake{"plan a.yaml --top x", "--top: expected a whole number above 0 or all, found x"},
        Mistake{"plan a.yaml --friction cones",
                "--friction: expected pyramid or cone, found cones; did you mean cone?"},
        Mistake{"plan a.yaml --loading 4d", "--loading: expected 3d or 2d, found 4d"},
        Mistake{"planar a.yaml", "--kit is required"},
        Mistake{"features a.yaml -o a.png", "expected a name that ends in .json or .svg, found a.png"},
        Mistake{"sheet plan.json", "--output is required"},
        Mistake{"sheet plan.json -o a.bmp", "expected a name that ends in .svg, .pdf or .png, found a.bmp"},
        Mistake{"kit check", "KIT is required"},
        Mistake{"dbc --nodes 0", "--nodes: expected a whole number from 1 to 14, found 0"},
        Mistake{"jaw close", "--node is required"},
        Mistake{"jaw close --node 15", "--node: expected a whole number from 1 to 14, found 15"},
        Mistake{"jaw squeeze --node 1 --force-n 9 --permit-n 900",
                "--permit-n: expected newtons from 0 to 250, found 900"},
        Mistake{"jaw squeeze --node 1 --force-n nan --permit-n 9",
                "--force-n: expected newtons from 0 to 250, found nan"},
        Mistake{"--progress loud kit list", "--progress: expected one of auto, none, json, found loud"},
        Mistake{"--seed -1 kit list", "--seed: expected a whole number from 0"}),
    [](const auto& mistake) { return "no_" + std::to_string(mistake.index); });

}  // namespace
}  // namespace pinjaw::app_test
