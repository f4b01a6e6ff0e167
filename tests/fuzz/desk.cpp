#include <unistd.h>

#include <fstream>
#include <stdexcept>

#include "tests/fuzz/targets.hpp"
#include "tests/support/places.hpp"

namespace pinjaw::fuzz {
namespace {

namespace fs = std::filesystem;

/// A folder like configs/, with an empty folder `inputs` beside the others.
class Desk {
 public:
  Desk() {
    std::string name = (fs::temp_directory_path() / "pinjaw-fuzz-XXXXXX").string();
    if (::mkdtemp(name.data()) == nullptr) throw std::runtime_error("cannot make " + name);
    folder_ = name;
    for (const auto& entry : fs::directory_iterator(test::source_dir("configs"))) {
      fs::create_symlink(entry.path(), folder_ / entry.path().filename());
    }
    fs::create_directory(folder_ / "inputs");
  }
  ~Desk() {
    std::error_code ignored;
    fs::remove_all(folder_, ignored);
  }
  Desk(const Desk&) = delete;
  Desk& operator=(const Desk&) = delete;
  [[nodiscard]] fs::path inputs() const { return folder_ / "inputs"; }

 private:
  fs::path folder_;
};

}  // namespace

fs::path written(std::string_view bytes, const std::string& ending) {
  static const Desk desk;
  const fs::path file = desk.inputs() / ("input" + ending);
  std::ofstream(file, std::ios::binary).write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  return file;
}

}  // namespace pinjaw::fuzz
