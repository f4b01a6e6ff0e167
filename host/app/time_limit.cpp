#include "host/app/time_limit.hpp"

namespace pinjaw::app {

TimeLimit::TimeLimit(std::chrono::seconds limit)
    : clock_([this, limit](const std::stop_token& ended) {
        std::unique_lock lock(mutex_);
        wake_.wait_for(lock, ended, limit, [] { return false; });
        if (!ended.stop_requested()) source_.request_stop();
      }) {
  if (limit.count() == 0) source_.request_stop();
}

}  // namespace pinjaw::app
