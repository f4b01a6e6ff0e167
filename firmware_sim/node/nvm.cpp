#include "firmware_sim/node/nvm.hpp"

#include <utility>

namespace pinjaw::node {

void Nvm::begin(const core::NvmWrite& request) {
  under_way_ = Write{.update = {memory_, request}, .sequence = request.sequence};
}

void Nvm::store(const core::NvmWrite& request) {
  if (!under_way_) return begin(request);
  if (!next_) {
    next_ = request;
    return;
  }
  // Both parts of an overtaken request stay to be stored, the newer of each.
  if (request.record) next_->record = request.record;
  if (request.layout) next_->layout = request.layout;
  next_->sequence = request.sequence;
}

void Nvm::advance_ms(unsigned elapsed_ms) {
  for (; under_way_ && elapsed_ms > 0; --elapsed_ms) {
    ++under_way_->elapsed_ms;
    write_on();
  }
}

void Nvm::cut_power() {
  under_way_.reset();
  next_.reset();
  done_ = 0;
  image_ = core::image_of(memory_);
}

void Nvm::write_on() {
  Write& write = *under_way_;
  const std::size_t due = write.update.size() * write.elapsed_ms / kWrite_ms;
  for (; write.written < due; ++write.written) {
    if (!broken_) write.update.put(write.written, memory_);
  }
  if (write.elapsed_ms < kWrite_ms) return;
  if (!broken_) {
    done_ = write.sequence;
    image_ = core::image_of(memory_);
  }
  under_way_.reset();
  if (const auto next = std::exchange(next_, std::nullopt)) begin(*next);
}

}  // namespace pinjaw::node
