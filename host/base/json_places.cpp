#include "host/base/json_places.hpp"

#include <algorithm>
#include <map>
#include <string>
#include <vector>

namespace pinjaw::base {

namespace {

struct Position {
  int line = 1;
  int column = 1;
};

/// An object or a list that the scanner is inside of.
struct Holder {
  std::string path;
  bool is_list = false;
  std::size_t entries = 0;  ///< of a list, those begun
  std::string key;          ///< of an object, the one last read
  bool key_next = true;     ///< of an object: the next string is a key
};

/// Walks through valid JSON and remembers where the values at some paths begin.
class Scanner {
 public:
  Scanner(std::string_view text, std::map<std::string, Position>& wanted) : text_(text), wanted_(&wanted) {}

  void scan() {
    while (at_ < text_.size()) take(text_[at_]);
  }

 private:
  void take(char c) {
    switch (c) {
      case '{':
      case '[': {
        std::string path = begin_value();
        holders_.push_back({std::move(path), c == '[', 0, {}, true});
        return advance();
      }
      case '}':
      case ']':
        holders_.pop_back();
        return advance();
      case ',':
        if (!holders_.empty()) holders_.back().key_next = true;
        return advance();
      case '"':
        return take_string();
      case ':':
      case ' ':
      case '\t':
      case '\r':
      case '\n':
        return advance();
      default:
        return take_plain();
    }
  }

  void take_string() {
    const bool is_key = !holders_.empty() && !holders_.back().is_list && holders_.back().key_next;
    if (!is_key) begin_value();
    const std::size_t first = at_ + 1;
    advance();
    while (text_[at_] != '"') {
      if (text_[at_] == '\\') advance();
      advance();
    }
    if (is_key) {
      constexpr std::size_t kLongest = 200;  // chosen: the paths of a longer key's values would take for ever
      holders_.back().key = std::string(text_.substr(first, std::min(at_ - first, kLongest)));
      holders_.back().key_next = false;
    }
    advance();
  }

  void take_plain() {
    begin_value();
    while (at_ < text_.size() && std::string_view(",]} \t\r\n").find(text_[at_]) == std::string_view::npos)
      advance();
  }

  /// Notes where a value begins; gives its path.
  std::string begin_value() {
    std::string path;
    if (!holders_.empty()) {
      Holder& holder = holders_.back();
      path = holder.path;
      if (holder.is_list) {
        path += '[' + std::to_string(holder.entries++) + ']';
      } else {
        path += (path.empty() ? "" : ".") + holder.key;
      }
    }
    if (const auto found = wanted_->find(path); found != wanted_->end()) found->second = position_;
    return path;
  }

  void advance() {
    if (text_[at_++] == '\n') {
      ++position_.line;
      position_.column = 1;
    } else {
      ++position_.column;
    }
  }

  std::string_view text_;
  std::map<std::string, Position>* wanted_;
  std::size_t at_ = 0;
  Position position_;
  std::vector<Holder> holders_;
};

std::string holder_of(const std::string& path) {
  const std::size_t cut = path.find_last_of(".[");
  return cut == std::string::npos ? std::string() : path.substr(0, cut);
}

}  // namespace

Diagnostics placed_in_json(const Diagnostics& mistakes, std::string_view text) {
  constexpr Position kNotThere{0, 0};
  std::map<std::string, Position> places;
  for (const Diagnostic& mistake : mistakes) {
    std::string path = mistake.key;
    while (places.emplace(path, kNotThere).second && !path.empty()) path = holder_of(path);
  }
  Scanner(text, places).scan();
  Diagnostics placed;
  for (Diagnostic mistake : mistakes) {
    std::string path = mistake.key;
    while (places[path].line == 0 && !path.empty()) path = holder_of(path);
    mistake.place.line = places[path].line;
    mistake.place.column = places[path].column;
    placed.add(std::move(mistake));
  }
  return placed;
}

}  // namespace pinjaw::base
