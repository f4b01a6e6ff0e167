#pragma once

#include <string>

/// Where tests find what they run and read. Told to one source file only, so that the objects of all tests
/// are the same in every checkout and a compiler cache serves them.
namespace pinjaw::test {

/// The checkout, or `path` in it.
std::string source_dir(const std::string& path = {});
/// The folder of the programs, or the program of that name in it.
std::string program(const std::string& name = {});

}  // namespace pinjaw::test
