#include "host/model/design.hpp"

namespace pinjaw::model {

std::string_view to_string(Split split) {
  switch (split) {
    case Split::TwoTwo:
      return "2+2";
    case Split::ThreeOne:
      return "3+1";
    case Split::OneThree:
      return "1+3";
  }
  return "?";
}

}  // namespace pinjaw::model
