#include "protocol/bus/statistics.hpp"

namespace pinjaw::bus {

Statistics& Statistics::operator+=(const Statistics& other) {
  sent += other.sent;
  received += other.received;
  for (const Trouble& trouble : kTroubles) this->*trouble.count += other.*trouble.count;
  return *this;
}

std::string to_text(const Statistics& statistics) {
  std::string text;
  for (const Trouble& trouble : kTroubles) {
    const std::uint64_t count = statistics.*trouble.count;
    if (count == 0) continue;
    if (!text.empty()) text += ", ";
    text += trouble.text + (' ' + std::to_string(count));
  }
  return text;
}

}  // namespace pinjaw::bus
