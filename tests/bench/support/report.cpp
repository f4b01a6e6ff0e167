#include "tests/bench/support/report.hpp"

#include <fmt/format.h>
#include <fmt/ostream.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <thread>

namespace pinjaw::bench {
namespace {

std::string processor() {
  std::ifstream file("/proc/cpuinfo");
  for (std::string line; std::getline(file, line);) {
    if (line.starts_with("model name")) return line.substr(line.find(':') + 2);
  }
  return "unknown";
}

std::string verdict(double bar, bool met) {
  if (bar <= 0) return {};
  return fmt::format("  {} {:g}", met ? "meets" : "MISSES", bar);
}

}  // namespace

void Report::add(Measurement measurement) {
  fmt::print(out_, "{}: {:.4g} {}{}{}{}\n", measurement.thing, measurement.ours, measurement.unit,
             verdict(measurement.at_most, measurement.ours <= measurement.at_most),
             measurement.note.empty() ? "" : "  ", measurement.note);
  for (const PeerFigure& peer : measurement.peers) {
    const double ratio = peer.value / measurement.ours;
    fmt::print(out_, "    {:<44} {:>12.4g}  {:>9.1f} x ours{}\n", peer.name, peer.value, ratio,
               verdict(peer.at_least, ratio >= peer.at_least));
  }
  out_.flush();
  measurements_.push_back(std::move(measurement));
}

std::string Report::json() const {
  const nlohmann::ordered_json machine = {{"processor", processor()},
                                          {"threads", std::thread::hardware_concurrency()}};
  auto rows = nlohmann::ordered_json::array();
  for (const Measurement& measured : measurements_) {
    nlohmann::ordered_json row = {{"name", measured.thing}, {"unit", measured.unit}, {"ours", measured.ours}};
    if (measured.at_most > 0) row["at_most"] = measured.at_most;
    if (!measured.note.empty()) row["note"] = measured.note;
    auto peers = nlohmann::ordered_json::array();
    for (const PeerFigure& peer : measured.peers) {
      nlohmann::ordered_json of_peer = {
          {"name", peer.name}, {"value", peer.value}, {"ratio", peer.value / measured.ours}};
      if (peer.at_least > 0) of_peer["at_least"] = peer.at_least;
      peers.push_back(std::move(of_peer));
    }
    row["peers"] = std::move(peers);
    row["machine"] = machine;
    rows.push_back(std::move(row));
  }
  return rows.dump(2) + "\n";
}

}  // namespace pinjaw::bench
