/// The core as an image for Cortex-M: its size and stack as the build reports them, and the tests of the core
/// played on an emulated Cortex-M4, byte for byte. Promises: I9, T-IMAGE.
#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <string>

#include "tests/support/figures.hpp"
#include "tests/support/places.hpp"

namespace pinjaw::firmware {
namespace {

namespace fs = std::filesystem;

fs::path images() {
  return fs::path(test::program()).parent_path() / "firmware";
}

/// Exit code of a shell command.
int run(const std::string& command) {
  const int status = std::system(command.c_str());
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

std::string contents(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

/// Configures and builds the images once; the build fails where one is over budget.
bool built() {
  static const bool done = [] {
    const std::string source = test::source_dir();
    return run("cmake -S '" + source + "' -B '" + images().string() + "' -G Ninja --toolchain '" + source +
               "/cmake/arm-none-eabi.cmake' -DCMAKE_BUILD_TYPE=MinSizeRel >&2") == 0 &&
           run("cmake --build '" + images().string() + "' >&2") == 0;
  }();
  return done;
}

nlohmann::json report_of(const std::string& image) {
  return nlohmann::json::parse(contents(images() / "bin" / (image + ".elf.json")));
}

class Image : public testing::TestWithParam<const char*> {};

TEST_P(Image, stays_within_flash_memory_and_stack_and_links_no_heap) {
  ASSERT_TRUE(built());
  const std::string name = GetParam();
  const auto report = report_of(name);
  EXPECT_LE(report.at("flash"), 32768);
  EXPECT_LE(report.at("ram"), 4096);
  EXPECT_LE(report.at("stack"), 768);
  EXPECT_TRUE(report.at("troubles").empty()) << report.at("troubles");
  for (const char* what : {"flash", "ram", "stack"}) {
    test::figure("I9", name + ": " + what, report.at(what).get<std::int64_t>(), "B");
  }
}

TEST_P(Image, over_budget_fails_the_build) {
  ASSERT_TRUE(built());
  const std::string name = GetParam();
  const auto report = report_of(name);
  const std::string elf = (images() / "bin" / (name + ".elf")).string();
  const std::string tool = "'" + test::source_dir("tools/image-report") + "' '" + elf + "' --calls '" +
                           images().string() + "/firmware_sim/target/CMakeFiles/" + name + ".dir' ";
  ASSERT_EQ(run(tool + ">&2"), 0);
  for (const char* what : {"flash", "ram", "stack"}) {
    const int less = report.at(what).get<int>() - 1;
    EXPECT_EQ(run(tool + "--" + what + " " + std::to_string(less) + " >/dev/null 2>&1"), 1) << what;
  }
  EXPECT_EQ(run(tool + "--root no_such_function >/dev/null 2>&1"), 1) << "an unknown stack is no stack of 0";
}

INSTANTIATE_TEST_SUITE_P(CortexM, Image, testing::Values("replay-m4", "replay-m0plus"),
                         [](const auto& tested) { return std::string(tested.param).substr(7); });

/// A folder of its own for files of a run.
class Folder {
 public:
  Folder() { fs::create_directories(path_); }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;
  ~Folder() { fs::remove_all(path_); }
  [[nodiscard]] const fs::path& path() const { return path_; }

 private:
  fs::path path_ = fs::path(testing::TempDir()) / ("pinjaw-trace-" + std::to_string(getpid()));
};

/// Instructions, from `name ticks` in the emulator's output: its clock of 25 MHz ticks each 40 ns, and
/// -icount shift=0 makes an instruction last 1 ns.
std::int64_t number_after(const std::string& text, const std::string& name) {
  const auto at = text.find(name + " ");
  return at == std::string::npos ? -1 : std::stoll(text.substr(at + name.size() + 1));
}

/// Plays those tests of the core that `filter` (as GoogleTest takes it) names; no step may take more than
/// `most_instructions`.
void play(const std::string& name, const std::string& filter, std::int64_t most_instructions) {
  ASSERT_TRUE(built());
  const Folder folder;
  const std::string in = "cd '" + folder.path().string() + "' && ";
  ASSERT_EQ(run(in + "PINJAW_TRACE=. PINJAW_FIGURES= '" + test::program("core_test") + "' --gtest_filter='" +
                filter + "' >/dev/null 2>&1"),
            0);
  ASSERT_EQ(run(in +
                "qemu-system-arm -M mps2-an386 -cpu cortex-m4 -semihosting -icount shift=0 -display none"
                " -monitor none -serial none -nic none -kernel '" +
                (images() / "bin/replay-m4.elf").string() + "' >told 2>&1"),
            0)
      << contents(folder.path() / "told");
  const std::string expected = contents(folder.path() / "trace.expected");
  const std::string made = contents(folder.path() / "trace.out");
  ASSERT_GT(expected.size(), 1'000'000U);
  ASSERT_EQ(made.size(), expected.size());
  const auto [there, here] = std::mismatch(made.begin(), made.end(), expected.begin());
  EXPECT_TRUE(there == made.end()) << "they differ at byte " << there - made.begin();

  std::int64_t lanes = 0;
  std::int64_t steps = 0;
  std::int64_t skipped = 0;
  std::ifstream(folder.path() / "trace.counts") >> lanes >> steps >> skipped;
  EXPECT_LT(skipped * 8, steps)
      << "too many steps of mistaken tables or of controllers changed behind their back";
  const std::string told = contents(folder.path() / "told");
  EXPECT_EQ(number_after(told, "steps"), steps);
  const std::int64_t most = 40 * (number_after(told, "most_ticks") + 1);
  EXPECT_LE(most, most_instructions);
  test::figure("T-IMAGE", name + ": controllers played on an emulated Cortex-M4", lanes);
  test::figure("T-IMAGE", name + ": steps equal byte for byte", steps, "steps");
  test::figure("T-IMAGE", name + ": steps not played: their test changed the state itself", skipped, "steps");
  test::figure("I9", name + ": instructions of the longest step on Cortex-M4", most);
  test::figure("I9", name + ": instructions of a step on Cortex-M4, mean",
               40 * number_after(told, "ticks") / steps);
}

TEST(ImageOnCortexM4, makes_of_the_inputs_of_all_tests_of_the_core_what_the_host_makes_of_them) {
  play("without a key", "-*uthent*:*Key*", 30'000);
}

TEST(ImageOnCortexM4, does_so_where_commands_have_macs) {
  play("with a key", "*uthent*:*Key*", 80'000);
}

}  // namespace
}  // namespace pinjaw::firmware
