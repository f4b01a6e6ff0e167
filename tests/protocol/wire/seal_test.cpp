// Promises: AUTH-MAC.
#include "protocol/wire/seal.hpp"

#include <gtest/gtest.h>

#include <random>

#include "protocol/wire/commands.hpp"
#include "tests/protocol/wire/reference_mac.hpp"

/// What a command's MAC covers, and how a host learns the number that it is over.
namespace pinjaw::wire {
namespace {

constexpr Key kSealKey{1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16};

Command squeeze() {
  Command command = squeeze_command({520, 1400});
  command.sequence = 9;
  return command;
}

using testing::with_number;

/// The first two bytes of OpenSSL's CMAC.
std::uint16_t short_mac(const testing::Bytes& message) {
  const AesBlock mac = testing::openssl_cmac(kSealKey, message);
  return static_cast<std::uint16_t>(mac[0] * 256 + mac[1]);
}

TEST(Seal, is_the_truncated_cmac_of_what_a_command_says_and_belongs_to) {
  std::mt19937 random(20);
  const auto below = [&random](std::uint32_t limit) { return static_cast<std::uint32_t>(random() % limit); };
  for (int i = 0; i < 300; ++i) {
    const Command command{.sequence = static_cast<std::uint8_t>(below(256)),
                          .op = static_cast<Op>(below(kOpCount)),
                          .argument = static_cast<std::uint8_t>(below(16)),
                          .session = static_cast<std::uint16_t>(below(65536)),
                          .a = static_cast<std::uint16_t>(below(4096)),
                          .b = static_cast<std::uint16_t>(below(4096))};
    const auto node = static_cast<std::uint8_t>(1 + below(14));
    const Freshness freshness{static_cast<std::uint32_t>(random()), static_cast<std::uint16_t>(below(65536))};
    testing::Bytes message{0x20, node, command.sequence};
    message.push_back(static_cast<std::uint8_t>(command.argument * 16 + static_cast<int>(command.op)));
    message = with_number(with_number(message, command.a, 2), command.b, 2);
    message = with_number(with_number(message, freshness.number, 4), freshness.epoch, 2);
    Command wanted = command;
    wanted.session = short_mac(message);
    ASSERT_EQ(sealed(kSealKey, node, command, freshness), wanted);
    EXPECT_TRUE(seal_is_right(kSealKey, node, wanted, freshness));
    ++wanted.session;
    EXPECT_FALSE(seal_is_right(kSealKey, node, wanted, freshness));
  }
}

TEST(Seal, a_number_is_told_in_halves_and_proven_by_a_cmac_over_it_the_node_and_the_nonce) {
  std::mt19937 random(21);
  for (int i = 0; i < 300; ++i) {
    const auto node = static_cast<std::uint8_t>(1 + random() % 14);
    const auto number = static_cast<std::uint32_t>(random());
    const Nonce nonce{static_cast<std::uint16_t>(random() % 65536),
                      static_cast<std::uint16_t>(random() % 4096),
                      static_cast<std::uint16_t>(random() % 4096)};
    testing::Bytes message = with_number({0x21, node}, number, 4);
    message = with_number(with_number(with_number(message, nonce.session, 2), nonce.a, 2), nonce.b, 2);
    const auto answer = [&](ArmStep step) { return number_answer(kSealKey, node, step, number, nonce); };
    EXPECT_EQ(answer(ArmStep::LowHalf), number % 65536);
    EXPECT_EQ(answer(ArmStep::HighHalf), number / 65536);
    EXPECT_EQ(answer(ArmStep::Proof), short_mac(message));
  }
}

TEST(Seal, a_question_for_the_number_is_an_arm_with_its_step_and_the_nonce) {
  for (const ArmStep step : {ArmStep::LowHalf, ArmStep::HighHalf, ArmStep::Proof}) {
    const Command question = ask_number(step, {0xABCD, 0x123, 0x456});
    const Command wanted{.op = Op::Arm,
                         .argument = static_cast<std::uint8_t>(step),
                         .session = 0xABCD,
                         .a = 0x123,
                         .b = 0x456};
    EXPECT_EQ(question, wanted);
    EXPECT_EQ(nonce_of(question), (Nonce{0xABCD, 0x123, 0x456}));
  }
  EXPECT_EQ(Nonce{}, (Nonce{0, 0, 0}));
  EXPECT_EQ(Freshness{}, (Freshness{0, 0}));
}

TEST(Seal, one_of_65536_values_is_right) {
  int right = 0;
  Command guess = squeeze();
  for (std::uint32_t value = 0; value < 0x10000; ++value) {
    guess.session = static_cast<std::uint16_t>(value);
    if (guess.session == command_mac(kSealKey, 2, squeeze(), {5, 77})) ++right;
  }
  EXPECT_EQ(right, 1);
}

/// The share of 2^16 changed commands whose old MAC is still right, for one way of changing them.
template <class Change>
double share_that_passes(Change change) {
  int passed = 0;
  constexpr int kTries = 0x10000;
  for (int i = 0; i < kTries; ++i) {
    Command command = squeeze();
    command.sequence = static_cast<std::uint8_t>(i & 0xFF);
    command.a = static_cast<std::uint16_t>(i >> 4);
    Freshness freshness{static_cast<std::uint32_t>(i) * 2654435761U, 77};
    std::uint8_t node = 2;
    const Command said = sealed(kSealKey, node, command, freshness);
    Command heard = said;
    change(heard, node, freshness);
    if (seal_is_right(kSealKey, node, heard, freshness)) ++passed;
  }
  return passed / static_cast<double>(kTries);
}

TEST(Seal, of_another_command_node_number_or_epoch_passes_no_more_often_than_a_guess) {
  // Of 2^16 guesses at 2^-16 more than 8 come with a probability below 1e-5; these are the same each run.
  const double most = 8.0 / 0x10000;
  EXPECT_LE(share_that_passes([](Command& c, std::uint8_t&, Freshness&) { c.sequence ^= 1U; }), most);
  EXPECT_LE(share_that_passes([](Command& c, std::uint8_t&, Freshness&) { c.op = Op::Offer; }), most);
  EXPECT_LE(share_that_passes([](Command& c, std::uint8_t&, Freshness&) { c.argument ^= 8U; }), most);
  EXPECT_LE(share_that_passes([](Command& c, std::uint8_t&, Freshness&) { c.a ^= 0x800U; }), most);
  EXPECT_LE(share_that_passes([](Command& c, std::uint8_t&, Freshness&) { c.b ^= 1U; }), most);
  EXPECT_LE(share_that_passes([](Command&, std::uint8_t& node, Freshness&) { node = 3; }), most);
  EXPECT_LE(share_that_passes([](Command&, std::uint8_t&, Freshness& f) { f.number ^= 0x80000000U; }), most);
  EXPECT_LE(share_that_passes([](Command&, std::uint8_t&, Freshness& f) { f.epoch ^= 1U; }), most);
}

TEST(Seal, a_proof_of_a_number_is_no_seal_and_binds_node_number_and_nonce) {
  const auto proof = [](std::uint8_t node, std::uint32_t number, Nonce nonce) {
    return number_answer(kSealKey, node, ArmStep::Proof, number, nonce);
  };
  const std::uint16_t right = proof(2, 70000, {1, 2, 3});
  EXPECT_NE(proof(3, 70000, {1, 2, 3}), right);
  EXPECT_NE(proof(2, 70001, {1, 2, 3}), right);
  EXPECT_NE(proof(2, 70000, {1, 2, 4}), right);
  EXPECT_EQ(number_answer(kSealKey, 2, ArmStep::LowHalf, 70000, {}), 70000 & 0xFFFF);
  EXPECT_EQ(number_answer(kSealKey, 2, ArmStep::HighHalf, 70000, {}), 1);
}

}  // namespace
}  // namespace pinjaw::wire
