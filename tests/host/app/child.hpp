#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace pinjaw::app_test {

/// How a program ended, with all that it said.
struct Ran {
  int exit_code = -1;  ///< -1 where a signal ended it
  std::string out;
  std::string err;
};

/// A folder of its own for each test, the working folder of what it runs, gone at its end.
class Bench {
 public:
  Bench();
  ~Bench();
  Bench(const Bench&) = delete;
  Bench& operator=(const Bench&) = delete;

  /// Settings of the environment for the runs that follow, e.g. "NO_COLOR=1".
  void set(const std::string& variable) { environment_.push_back(variable); }
  /// build/bin/pinjaw with these arguments, split at blanks.
  [[nodiscard]] Ran pinjaw(const std::string& arguments) const { return run("pinjaw", arguments); }
  [[nodiscard]] Ran run(const std::string& program, const std::string& arguments) const;
  /// Starts pinjaw, sends it `signal` so many `seconds` after its first words on stderr, and waits for its
  /// end.
  [[nodiscard]] Ran interrupted(const std::string& arguments, int signal, double seconds) const;
  /// Runs pinjaw with a terminal of so many columns as its input and outputs, and types `typed` after
  /// `seconds`; all that the terminal was sent is in `out`.
  [[nodiscard]] Ran on_terminal(const std::string& arguments, int columns, const std::string& typed = {},
                                double seconds = 0) const;

  /// Writes a file of this folder; gives its name.
  std::string write(const std::string& name, std::string_view bytes) const;
  [[nodiscard]] std::string read(const std::string& name) const;
  [[nodiscard]] bool has(const std::string& name) const { return std::filesystem::exists(folder_ / name); }
  /// Names of all that is in the folder, sorted.
  [[nodiscard]] std::vector<std::string> names() const;
  [[nodiscard]] const std::filesystem::path& folder() const { return folder_; }

 private:
  std::filesystem::path folder_;
  std::vector<std::string> environment_;
};

/// A file of the checkout.
std::string shipped(const std::string& path);

}  // namespace pinjaw::app_test
