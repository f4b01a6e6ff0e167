#include "tests/support/places.hpp"

#include <cstdlib>

namespace pinjaw::test {

namespace {
std::string in(std::string folder, const std::string& path) {
  return path.empty() ? folder : std::move(folder) + "/" + path;
}
}  // namespace

std::string source_dir(const std::string& path) {
  // tests/lint/seeded_faults.py shows tests a copy with faults in it
  const char* seeded = std::getenv("PINJAW_SEEDED_SOURCE_DIR");
  return in(seeded != nullptr ? seeded : PINJAW_SOURCE_DIR, path);
}

std::string program(const std::string& name) {
  return in(PINJAW_BIN_DIR, name);
}

}  // namespace pinjaw::test
