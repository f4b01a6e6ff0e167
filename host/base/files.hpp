#pragma once

#include <cstddef>
#include <filesystem>
#include <limits>
#include <string>
#include <string_view>

#include "host/base/expected.hpp"

namespace pinjaw::base {

/// The content of a regular file of at most `at_most_bytes`; the failure says why not, without the name.
Expected<std::string> read_file(const std::filesystem::path& path,
                                std::size_t at_most_bytes = std::numeric_limits<std::size_t>::max());

/// Writes the file so that it appears whole or not at all: into a neighbour file, flushed to disk, then
/// renamed. An existing file is replaced, its permissions kept; a link is followed; devices and pipes are
/// written straight.
Expected<void> write_file_whole(const std::filesystem::path& path, std::string_view bytes);

/// Removes the neighbour file that write_file_whole is writing, if any. For a signal handler that ends the
/// program: it calls nothing else that such a handler may not.
void drop_unfinished_file() noexcept;

}  // namespace pinjaw::base
