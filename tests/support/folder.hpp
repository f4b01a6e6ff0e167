#pragma once

#include <filesystem>
#include <string>

namespace pinjaw::test {

/// A new folder for temporary files, removed with them. Its name is short, as the path of a socket must be,
/// and nobody else's, also where process numbers repeat (User-Mode Linux).
class Folder {
 public:
  Folder();
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;
  ~Folder();

  /// Where `name` is, or comes to be, in it.
  [[nodiscard]] std::string path(const std::string& name) const { return (path_ / name).string(); }
  /// Writes a file; gives its path.
  std::string write(const std::string& name, const std::string& text) const;

 private:
  std::filesystem::path path_;
};

}  // namespace pinjaw::test
