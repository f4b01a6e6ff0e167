// Promises: AUTH-VCAN.
// A cell whose controllers share a key with their host, on a real vcan, classic and CAN FD: pinjaw and
// pinjaw-jaw play handoffs with it; a pinjaw that has no key, or another one, is told so, ends with exit code
// 4 or 5 and changes nothing.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "tests/scenarios/vcan/programs.hpp"
#include "tests/support/figures.hpp"

namespace pinjaw::scenario {
namespace {

using testing::HasSubstr;

/// The shipped controllers' files with a key, and a short sequence.
class Files {
 public:
  explicit Files(bool can_fd) {
    write_key("cell.key", "00112233445566778899aabbccddeeff");
    write_key("other.key", "ffeeddccbbaa99887766554433221100");
    for (const std::string& controller : kThree) {
      std::string text = content(config("controllers/" + controller + ".yaml"));
      text.replace(text.find("../kits/"), 8, config("kits/"));
      text += std::string("authentication: {key_file: cell.key") + (can_fd ? ", can_fd: true}\n" : "}\n");
      controllers_.push_back(folder_.write(controller + ".yaml", text));
    }
    folder_.write("two.yaml", "sequence: two\ncell: " + config("cells/acc.yaml") +
                                  "\ndesign: best\nsteps:\n  - place: {on: pallet}\n"
                                  "  - handoff: {from: pallet, to: arm}\n"
                                  "  - handoff: {from: arm, to: pedestal}\nfaults: []\n");
  }
  [[nodiscard]] std::string path(const std::string& name) const { return folder_.path(name); }
  [[nodiscard]] const std::vector<std::string>& controllers() const { return controllers_; }

 private:
  void write_key(const std::string& name, const std::string& digits) const {
    std::filesystem::permissions(folder_.write(name, digits + '\n'), std::filesystem::perms::owner_read);
  }
  test::Folder folder_;
  std::vector<std::string> controllers_;
};

/// What pinjaw, given these arguments, ends with and says on stderr.
struct Ended {
  int code = 0;
  std::string said;
};

class KeyedOnVcan : public testing::TestWithParam<bool> {
 protected:
  [[nodiscard]] bool can_fd() const { return GetParam(); }
  [[nodiscard]] Ended pinjaw_with(const std::string& key, std::vector<std::string> arguments) const {
    if (!key.empty()) arguments.insert(arguments.end(), {"--key-file", files_.path(key)});
    if (!key.empty() && can_fd()) arguments.emplace_back("--can-fd");
    const std::string errors = files_.path("errors");
    const int code = pinjaw(std::move(arguments), "/dev/null", errors);
    return {code, content(errors)};
  }
  [[nodiscard]] std::vector<std::string> send() const {
    return {"send", kOut + "/plan.json", "--design", "best", "--node", "2"};
  }

  const Files files_{GetParam()};
  Controllers controllers_{files_.controllers()};
};
INSTANTIATE_TEST_SUITE_P(Buses, KeyedOnVcan, testing::Bool(),
                         [](const auto& fd) { return fd.param ? "can_fd" : "classic"; });

TEST_P(KeyedOnVcan, a_cell_with_a_key_plays_handoffs_and_says_every_frame_in_its_form) {
  const std::string heard = files_.path("heard.log");
  Candump candump(heard);
  const Ended run = pinjaw_with("cell.key", {"run", files_.path("two.yaml"), "--plan", kOut + "/cell.json",
                                             "--world", controllers_.world_path()});
  candump.stop();
  EXPECT_EQ(run.code, 0) << run.said;
  const bench::Truth truth = controllers_.truth();
  EXPECT_EQ(truth.holders, std::vector{2});
  expect_held(truth);

  std::ifstream lines(heard);
  int fd_frames = 0;
  int classic_frames = 0;
  for (std::string line; std::getline(lines, line);) {
    ++(line.find("##") == std::string::npos ? classic_frames : fd_frames);
  }
  EXPECT_GT(can_fd() ? fd_frames : classic_frames, 500);
  EXPECT_EQ(can_fd() ? classic_frames : fd_frames, 0);
  test::figure("AUTH-VCAN",
               can_fd() ? "frames of a run with MAC, CAN FD" : "frames of a run with key, classic",
               can_fd() ? fd_frames : classic_frames, "frames");
}

TEST_P(KeyedOnVcan, a_host_without_the_key_is_told_so_and_changes_nothing) {
  ASSERT_EQ(pinjaw_with("cell.key", send()).code, 0);
  for (const std::string key : {"", "other.key"}) {
    SCOPED_TRACE(key);
    for (const std::vector<std::string>& arguments :
         {std::vector<std::string>{"jaw", "close", "--node", "2"}, send()}) {
      const Ended stranger = pinjaw_with(key, arguments);
      if (can_fd()) {
        EXPECT_EQ(stranger.code, 5) << stranger.said;
        EXPECT_THAT(stranger.said, HasSubstr("does not answer"));
      } else {
        EXPECT_EQ(stranger.code, 4) << stranger.said;
        EXPECT_THAT(stranger.said, HasSubstr(key.empty() ? "requires authentication" : "key"));
      }
    }
  }
  const bench::Truth truth = controllers_.truth();
  EXPECT_GT(truth.nodes.at(1).separation_mm, 50) << "nobody without the key closed the jaws";
  EXPECT_EQ(pinjaw_with("cell.key", {"jaw", "status", "--node", "2"}).code, 0);
}

}  // namespace
}  // namespace pinjaw::scenario
