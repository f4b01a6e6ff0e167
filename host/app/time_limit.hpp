#pragma once

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <stop_token>
#include <thread>

namespace pinjaw::app {

/// Asks for a stop once its time is over, while it lives.
class TimeLimit {
 public:
  explicit TimeLimit(std::chrono::seconds limit);

  [[nodiscard]] std::stop_token token() const { return source_.get_token(); }

 private:
  std::stop_source source_;
  std::mutex mutex_;
  std::condition_variable_any wake_;
  std::jthread clock_;  // last: it uses the others
};

}  // namespace pinjaw::app
