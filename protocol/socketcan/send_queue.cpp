#include "protocol/socketcan/send_queue.hpp"

#include <algorithm>

namespace pinjaw::socketcan {

bool SendQueue::push(const wire::Frame& frame, std::int64_t now_us) {
  drop_stale(now_us);
  if (waiting_.size() >= kMostFrames) return false;
  const auto place =
      std::upper_bound(waiting_.begin(), waiting_.end(), frame.id,
                       [](std::uint32_t id, const Waiting& other) { return id < other.frame.id; });
  waiting_.insert(place, {frame, now_us});
  return true;
}

WriteResult SendQueue::flush(std::int64_t now_us, const Writer& write) {
  drop_stale(now_us);
  while (!waiting_.empty()) {
    const WriteResult result = write(waiting_.front().frame);
    if (result != WriteResult::Taken) return result;
    waiting_.erase(waiting_.begin());
  }
  return WriteResult::Taken;
}

void SendQueue::drop_stale(std::int64_t now_us) {
  dropped_ += std::erase_if(
      waiting_, [now_us](const Waiting& waiting) { return now_us - waiting.since_us > kStale_us; });
}

void SendQueue::clear() {
  dropped_ += waiting_.size();
  waiting_.clear();
}

}  // namespace pinjaw::socketcan
