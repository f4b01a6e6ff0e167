#include "firmware_sim/node/nvm.hpp"

namespace pinjaw::node {

void Nvm::store(const core::NvmWrite& request) {
  if (under_way_) {
    if (next_) {
      // Both parts of an overtaken request stay to be stored, the newer of each.
      if (request.record) next_->record = request.record;
      if (request.layout) next_->layout = request.layout;
      next_->sequence = request.sequence;
    } else {
      next_ = request;
    }
    return;
  }
  under_way_ = request;
  left_ms_ = kWrite_ms;
}

void Nvm::advance_ms(unsigned elapsed_ms) {
  while (under_way_ && elapsed_ms >= left_ms_) {
    elapsed_ms -= left_ms_;
    commit(*under_way_);
    under_way_ = next_;
    next_.reset();
    left_ms_ = kWrite_ms;
  }
  if (under_way_) left_ms_ -= elapsed_ms;
}

void Nvm::cut_power() {
  under_way_.reset();
  next_.reset();
  done_ = 0;
}

void Nvm::commit(const core::NvmWrite& request) {
  if (broken_) return;
  if (request.record) image_.record = request.record;
  if (request.layout) image_.layout = *request.layout;
  done_ = request.sequence;
}

}  // namespace pinjaw::node
