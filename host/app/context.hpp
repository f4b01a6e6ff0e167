#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "host/app/exit_code.hpp"
#include "host/base/diagnostics.hpp"
#include "host/base/expected.hpp"
#include "host/jaw_client/client.hpp"
#include "host/model/authentication.hpp"
#include "host/planner/plan/plan.hpp"

namespace CLI {
class App;
}

namespace pinjaw::app {

enum class ProgressMode { Auto, None, Json };

/// What every command shares: the global options, and the only door to the terminal.
/// Results go to stdout; progress, warnings and errors to stderr.
class Context {
 public:
  std::string bus = "sim:";
  std::string world;
  std::string key_file;
  bool can_fd = false;
  bool json = false;
  bool quiet = false;
  ProgressMode progress = ProgressMode::Auto;
  std::uint64_t seed = 1;
  ExitCode exit_code = ExitCode::Done;

  /// A line of the result.
  void print(std::string_view text) const;
  /// A remark on stderr; silent with --quiet.
  void note(std::string_view text) const;
  /// Reports why the command failed and sets the exit code.
  void fail(ExitCode code, std::string_view message);
  /// Reports every mistake of the input files; exit code 3.
  void fail(const base::Diagnostics& mistakes, std::string_view consequence);

  /// Writes the result whole to `path`, or to stdout where it is empty or "-". False, with exit code 3, where
  /// it cannot be written.
  bool write_result(const std::filesystem::path& path, std::string_view bytes);

  /// The one result of a command that makes a document. With `path` the document goes there and `summary`
  /// (the document itself with --json) to stdout; without, the document goes to stdout and the summary is a
  /// remark. False, with exit code 3, where the file cannot be written.
  bool deliver(const std::filesystem::path& path, std::string_view document, std::string_view summary);

  /// Tells in time, before long work, that `path` cannot be written, or is `input` itself; exit code 3 or 2.
  bool can_write(const std::filesystem::path& path, const std::filesystem::path& input = {});

  /// How this program speaks to controllers: with an epoch and nonces drawn anew, and the key of --key-file,
  /// else `fallback`. Nothing, with exit code 3, where the key file is none.
  std::optional<jaw_client::Client::Settings> host_settings(
      const std::optional<model::Authentication>& fallback = {});

  /// Hands on what is left of the result; exit code 3 where stdout did not take it all.
  void finish();

  /// Shows how far a command has come, until it is dropped: on a terminal, as JSON lines, or not at all.
  [[nodiscard]] planner::ProgressSink progress_sink() const;

 private:
  void put(std::string_view bytes) const;

  mutable int stdout_error_ = 0;  ///< the first errno that stdout gave
};

}  // namespace pinjaw::app
