#include "tests/support/places.hpp"

namespace pinjaw::test {

namespace {
std::string in(std::string folder, const std::string& path) {
  return path.empty() ? folder : std::move(folder) + "/" + path;
}
}  // namespace

std::string source_dir(const std::string& path) {
  return in(PINJAW_SOURCE_DIR, path);
}

std::string program(const std::string& name) {
  return in(PINJAW_BIN_DIR, name);
}

}  // namespace pinjaw::test
