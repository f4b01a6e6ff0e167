#include "tests/scenarios/vcan/programs.hpp"

#include <unistd.h>

#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
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

bool shell(const std::string& command) {
  return std::system(("PATH=$PATH:/usr/sbin:/sbin; " + command).c_str()) == 0;
}

Controllers::Controllers(const std::vector<std::string>& names, const std::string& interface,
                         const std::vector<std::string>& options, std::vector<std::string> under)
    : path_(new_folder() + "/world"),
      program_(jaw_command(names, interface, path_, options, std::move(under)), "", path_ + ".said") {
  for (int tries = 0; tries < 1000 && !world_; ++tries) {
    if (auto world = bench::SocketWorld::connect(path_)) world_ = std::move(*world);
    std::this_thread::sleep_for(kPoll);
  }
  if (!world_) throw std::runtime_error("pinjaw-jaw does not serve its world: " + said());
}

Controllers::~Controllers() {
  program_.signal(SIGTERM);  // so that it removes its socket
  program_.wait();
  std::error_code ignored;
  std::filesystem::remove_all(std::filesystem::path(path_).parent_path(), ignored);
}

std::string Controllers::said() const {
  return content(path_ + ".said");
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

std::string new_folder() {
  std::string name = (std::filesystem::temp_directory_path() / "pinjaw-scenario-XXXXXX").string();
  if (mkdtemp(name.data()) == nullptr) throw std::runtime_error("no folder for temporary files");
  return name;
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
