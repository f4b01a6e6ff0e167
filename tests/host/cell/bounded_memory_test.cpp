#include <gtest/gtest.h>
#include <malloc.h>

#include <atomic>
#include <cstdlib>
#include <new>

#include "tests/host/cell/synthetic.hpp"

namespace {

std::atomic<std::int64_t> held_bytes{
    0};  // NOLINT(cppcoreguidelines-avoid-non-const-global-variables): as new is
std::atomic<std::int64_t> most_bytes{0};  // NOLINT(cppcoreguidelines-avoid-non-const-global-variables)

}  // namespace

void* operator new(std::size_t size) {
  void* block = std::malloc(size);
  if (block == nullptr) throw std::bad_alloc();
  const std::int64_t held = held_bytes += static_cast<std::int64_t>(malloc_usable_size(block));
  for (std::int64_t most = most_bytes; held > most && !most_bytes.compare_exchange_weak(most, held);) {
  }
  return block;
}
void operator delete(void* block) noexcept {
  held_bytes -= static_cast<std::int64_t>(malloc_usable_size(block));
  std::free(block);
}
void operator delete(void* block, std::size_t /*size*/) noexcept {
  operator delete(block);
}

namespace pinjaw::cell {
namespace {

/// Pins so short that none ever meets another, and stations that reach everything.
testing::TestCell agreeable_cell(std::size_t designs) {
  base::Random random(71);
  testing::TestCell cell;
  for (auto kind : {testing::arm(), testing::pedestal(), testing::pallet()}) {
    if (kind.name != "arm") kind.adjust.x_mm = kind.adjust.y_mm = {-99, 99};
    cell.stations.push_back(testing::random_station(random, kind, designs));
    for (model::Design& design : cell.stations.back().designs) {
      for (model::PinDesign& pin : design.pins) {
        pin.top_z_mm += 5 - pin.length_mm;
        pin.length_mm = 5;
      }
    }
  }
  cell.handoffs = {{2, 0}, {0, 1}};
  return cell;
}

TEST(Join, of_eight_million_combinations_holds_but_the_pairs_and_the_best) {
  constexpr std::int64_t kDesigns = 200;
  constexpr std::int64_t kOneByteEach = kDesigns * kDesigns * kDesigns;
  const testing::TestCell cell = agreeable_cell(kDesigns);
  const std::int64_t before = held_bytes;
  most_bytes = before;
  const testing::Joined answer = testing::joined(cell, 50);
  EXPECT_EQ(answer.result.count, kDesigns * kDesigns * kDesigns);
  EXPECT_EQ(answer.result.best.size(), 50U);
  constexpr std::int64_t kSetups = kDesigns * 3 * 12 * static_cast<std::int64_t>(sizeof(cell::Setup));
  EXPECT_LT(most_bytes - before, kSetups + kOneByteEach / 4);
}

}  // namespace
}  // namespace pinjaw::cell
