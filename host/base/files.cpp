#include "host/base/files.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <cstring>
#include <optional>
#include <system_error>

namespace pinjaw::base {
namespace {

std::string reason(int error) {
  return std::generic_category().message(error);
}

/// An open file descriptor, closed at the end.
class Descriptor {
 public:
  explicit Descriptor(int number) : number_(number) {}
  ~Descriptor() {
    if (number_ >= 0) ::close(number_);
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  [[nodiscard]] int number() const { return number_; }
  [[nodiscard]] bool is_open() const { return number_ >= 0; }
  /// Closes now; some file systems tell of a full disk only here.
  [[nodiscard]] bool close() {
    const int number = number_;
    number_ = -1;
    return ::close(number) == 0;
  }

 private:
  int number_;
};

bool write_all(int descriptor, std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t written = ::write(descriptor, bytes.data(), bytes.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) return false;
    bytes.remove_prefix(static_cast<std::size_t>(written));
  }
  return true;
}

tl::unexpected<Failure> cannot_write(const std::filesystem::path& path, int error) {
  return failure("cannot write " + path.string() + ": " + reason(error));
}

Expected<void> write_straight(const std::filesystem::path& path, std::string_view bytes) {
  Descriptor file(::open(path.c_str(), O_WRONLY | O_CLOEXEC | O_NOCTTY));
  if (!file.is_open() || !write_all(file.number(), bytes) || !file.close()) return cannot_write(path, errno);
  return {};
}

/// Opens a file beside `path` under a name that nobody has.
int open_neighbour(const std::filesystem::path& path, std::filesystem::path& name) {
  constexpr int kTries = 1000;  // chosen: leftovers of crashed runs with our process number
  for (int attempt = 0; attempt < kTries; ++attempt) {
    name = path.parent_path() / fmt::format(".pinjaw-{}-{}.part", ::getpid(), attempt);
    const int file = ::open(name.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if (file >= 0 || errno != EEXIST) return file;
  }
  return -1;
}

/// The name of the neighbour file that is being written; nothing where none is.
std::atomic<const char*> unfinished = nullptr;
static_assert(std::atomic<const char*>::is_always_lock_free);

void flush_folder(const std::filesystem::path& path) {
  const std::filesystem::path folder = path.has_parent_path() ? path.parent_path() : ".";
  const Descriptor opened(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  if (opened.is_open()) ::fsync(opened.number());
}

tl::unexpected<Failure> too_long(std::size_t at_most_bytes) {
  constexpr std::size_t kMegabyte = 1U << 20U;
  if (at_most_bytes % kMegabyte != 0) return failure(fmt::format("is longer than {} bytes", at_most_bytes));
  return failure(fmt::format("is longer than {} MB", at_most_bytes / kMegabyte));
}

}  // namespace

Expected<std::string> read_file(const std::filesystem::path& path, std::size_t at_most_bytes) {
  const Descriptor file(::open(path.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC | O_NOCTTY));
  if (!file.is_open()) return failure("cannot be read: " + reason(errno));
  struct stat status {};
  if (::fstat(file.number(), &status) != 0) return failure("cannot be read: " + reason(errno));
  if (S_ISDIR(status.st_mode)) return failure("is a folder, not a file");
  if (!S_ISREG(status.st_mode)) return failure("is not a regular file");
  if (status.st_size > 0 && static_cast<std::size_t>(status.st_size) > at_most_bytes)
    return too_long(at_most_bytes);
  std::string bytes;
  std::array<char, 65536> piece{};
  while (true) {
    const ssize_t count = ::read(file.number(), piece.data(), piece.size());
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) return failure("cannot be read: " + reason(errno));
    if (count == 0) return bytes;
    if (bytes.size() + static_cast<std::size_t>(count) > at_most_bytes) {
      return too_long(at_most_bytes);
    }
    bytes.append(piece.data(), static_cast<std::size_t>(count));
  }
}

Expected<void> write_file_whole(const std::filesystem::path& path, std::string_view bytes) {
  std::error_code ignored;
  const std::filesystem::path linked = std::filesystem::canonical(path, ignored);
  const std::filesystem::path target = linked.empty() ? path : linked;
  struct stat status {};
  const bool exists = ::stat(target.c_str(), &status) == 0;
  if (exists && S_ISDIR(status.st_mode)) return cannot_write(path, EISDIR);
  if (exists && !S_ISREG(status.st_mode)) return write_straight(target, bytes);
  if (exists && ::access(target.c_str(), W_OK) != 0) return cannot_write(path, errno);

  std::filesystem::path part;
  Descriptor file(open_neighbour(target, part));
  if (!file.is_open()) return cannot_write(path, errno);
  unfinished = part.c_str();
  const bool kept = !exists || ::fchmod(file.number(), status.st_mode & 07777U) == 0;
  const bool whole = kept && write_all(file.number(), bytes) && ::fsync(file.number()) == 0 && file.close() &&
                     ::rename(part.c_str(), target.c_str()) == 0;
  const int error = errno;
  unfinished = nullptr;
  if (!whole) {
    ::unlink(part.c_str());
    return cannot_write(path, error);
  }
  flush_folder(target);
  return {};
}

void drop_unfinished_file() noexcept {
  if (const char* name = unfinished) ::unlink(name);
}

}  // namespace pinjaw::base
