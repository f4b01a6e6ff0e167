#include "tests/scenarios/vcan/programs.hpp"

#include <gtest/gtest.h>

#include <csignal>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <stdexcept>
#include <thread>
#include <utility>

#include "tests/support/places.hpp"

namespace pinjaw::scenario {

namespace {

using Clock = std::chrono::steady_clock;
constexpr std::chrono::milliseconds kPoll(50);

std::vector<std::string> jaw_command(const std::vector<std::string>& names, const std::string& interface,
                                     const std::string& path, const std::vector<std::string>& options,
                                     std::vector<std::string> command) {
  command.push_back(test::program("pinjaw-jaw"));
  for (const std::string& name : names) {
    const bool is_path = name.find('/') != std::string::npos;
    command.push_back(is_path ? name : config("controllers/" + name + ".yaml"));
  }
  command.insert(command.end(), {"--bus", "can:" + interface, "--world", path});
  command.insert(command.end(), options.begin(), options.end());
  return command;
}

}  // namespace

int pinjaw(std::vector<std::string> arguments, const std::string& output, const std::string& errors) {
  arguments.insert(arguments.begin(), test::program("pinjaw"));
  arguments.insert(arguments.end(), {"--bus", "can:vcan0"});
  return Process(std::move(arguments), output, errors).wait();
}

Candump::Candump(const std::string& file) : program_({"candump", "-L", "vcan0"}, file) {}

void Candump::stop() {
  program_.signal(SIGINT);
  program_.wait();
}

Controllers::Controllers(const std::vector<std::string>& names, const std::string& interface,
                         const std::vector<std::string>& options, std::vector<std::string> under)
    : program_(jaw_command(names, interface, world_path(), options, std::move(under)), "",
               folder_.path("said")) {
  for (int tries = 0; tries < 1000 && !world_; ++tries) {
    if (auto world = bench::SocketWorld::connect(world_path())) world_ = std::move(*world);
    std::this_thread::sleep_for(kPoll);
  }
  if (!world_) throw std::runtime_error("pinjaw-jaw does not serve its world: " + said());
}

Controllers::~Controllers() {
  program_.signal(SIGTERM);  // so that it removes its socket
  program_.wait();
}

std::string Controllers::said() const {
  return content(folder_.path("said"));
}

bool Controllers::tells(const std::string& text, std::chrono::seconds patience) const {
  const auto give_up = Clock::now() + patience;
  while (said().find(text) == std::string::npos) {
    if (Clock::now() > give_up) return false;
    std::this_thread::sleep_for(kPoll);
  }
  return true;
}

bench::Reply Controllers::ask(const bench::Request& request) {
  auto reply = world_->ask(request);
  if (!reply) throw std::runtime_error(reply.error().message);
  if (const auto* refused = std::get_if<bench::Refused>(&*reply)) throw std::runtime_error(refused->reason);
  return std::move(*reply);
}

bool Controllers::comes_true(const std::function<bool(const bench::Truth&)>& condition,
                             std::chrono::seconds patience) {
  const auto give_up = Clock::now() + patience;
  while (!condition(truth())) {
    if (Clock::now() > give_up) return false;
    std::this_thread::sleep_for(kPoll);
  }
  return true;
}

std::vector<std::string> run_command(const std::string& sequence, const Controllers& controllers,
                                     const std::string& report) {
  std::vector<std::string> command{test::program("pinjaw"), "run",   sequence,    "--plan",
                                   kOut + "/cell.json",     "--bus", "can:vcan0", "--world",
                                   controllers.world_path()};
  if (!report.empty()) command.insert(command.end(), {"--report", report});
  return command;
}

std::string handoffs() {
  return test::source_dir("tests/scenarios/vcan/handoffs.yaml");
}

nlohmann::json finished_report(const std::string& file, std::size_t steps) {
  auto report = nlohmann::json::parse(content(file), nullptr, false);
  if (report.is_discarded()) {
    ADD_FAILURE() << "no report in " << file;
    return nullptr;
  }
  EXPECT_EQ(report.at("result"), "done");
  EXPECT_EQ(report.at("steps").size(), steps);
  EXPECT_EQ(report.at("plant").at("dropped"), false);
  EXPECT_GE(report.at("plant").at("min_holders"), 1);
  return report;
}

bool arm_touches(const bench::Truth& truth) {
  return truth.nodes.at(0).touches;
}

void expect_held(const bench::Truth& truth, const std::string& when) {
  EXPECT_FALSE(truth.dropped) << when;
  EXPECT_FALSE(truth.holders.empty()) << when;
  EXPECT_GE(truth.min_holders.value_or(0), 1) << when;
  EXPECT_EQ(truth.slip_mm, 0) << when;
}

std::string config(const std::string& name) {
  return test::source_dir("configs/" + name);
}

std::string content(const std::string& path) {
  std::stringstream text;
  text << std::ifstream(path).rdbuf();
  return text.str();
}

}  // namespace pinjaw::scenario
