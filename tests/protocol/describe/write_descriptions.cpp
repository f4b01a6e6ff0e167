#include <fstream>
#include <iostream>
#include <sstream>
#include <string>

#include "protocol/describe/describe.hpp"

/// Writes what is checked in from the message table: protocol/pinjaw.dbc and the tables of docs/bus.md.
/// usage: write_descriptions CHECKOUT
int main(int count, char** arguments) {
  if (count != 2) return 2;
  const std::string root = arguments[1];
  std::ofstream(root + "/protocol/pinjaw.dbc") << pinjaw::describe::to_dbc(pinjaw::describe::all_nodes());

  std::stringstream page;
  page << std::ifstream(root + "/docs/bus.md").rdbuf();
  const std::string text = page.str();
  const std::size_t tables = text.find("## Messages\n");
  if (tables == std::string::npos) {
    std::cerr << "docs/bus.md has no '## Messages'\n";
    return 1;
  }
  std::ofstream(root + "/docs/bus.md") << text.substr(0, tables) << pinjaw::describe::to_markdown();
  return 0;
}
