#include "host/part/cad_process.hpp"

#include <charconv>
#include <cstdlib>
#include <string_view>

#include "host/base/rules.hpp"

namespace pinjaw::part {
namespace {

constexpr const char* kSeconds = "PINJAW_CAD_SECONDS";
constexpr const char* kMemory = "PINJAW_CAD_MEMORY_MB";

/// The number that an environment variable holds; `otherwise` where it is not set or empty.
base::Expected<double> from_environment(const char* name, const base::NumberRule& rule, double otherwise) {
  const char* set = std::getenv(name);
  const std::string_view text = set == nullptr ? "" : set;
  if (text.empty()) return otherwise;
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error == std::errc() && end == text.data() + text.size() && rule.allows(value)) return value;
  return base::failure(std::string(name) + ": expected " + rule.what + ", found " + std::string(text));
}

std::string advice(base::Misfortune::Kind kind) {
  switch (kind) {
    case base::Misfortune::Kind::Crashed:
    case base::Misfortune::Kind::Garbled:
      return "; the file may be damaged";
    case base::Misfortune::Kind::Memory:
      return std::string("; ") + kMemory + " allows more";
    case base::Misfortune::Kind::Time:
      return std::string("; ") + kSeconds + " allows more";
    default:
      return "";
  }
}

}  // namespace

base::Expected<base::IsolationLimits> cad_limits() {
  base::IsolationLimits limits;
  const auto seconds =
      from_environment(kSeconds, {"seconds from 0.001 to 86400", 0.001, 86400}, limits.seconds);
  if (!seconds) return tl::unexpected(seconds.error());
  const auto memory_mb =
      from_environment(kMemory, {"megabytes from 16 to 1e6", 16, 1e6}, static_cast<double>(limits.memory_mb));
  if (!memory_mb) return tl::unexpected(memory_mb.error());
  return base::IsolationLimits{*seconds, static_cast<std::uint64_t>(*memory_mb)};
}

base::Expected<std::string> in_cad_process(const std::string& file, const base::IsolatedWork& work) {
  const auto limits = cad_limits();
  if (!limits) return tl::unexpected(limits.error());
  auto answer = base::run_isolated(*limits, work);
  if (answer) return std::move(*answer);
  const base::Misfortune& wrong = answer.error();
  if (wrong.kind == base::Misfortune::Kind::Refused) return base::failure(wrong.message);
  return base::failure(file + ": OpenCASCADE " + wrong.message + advice(wrong.kind));
}

}  // namespace pinjaw::part
