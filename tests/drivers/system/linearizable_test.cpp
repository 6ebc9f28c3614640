// The search finds an order of calls exactly when there is one.
#include "tests/drivers/system/linearizable.hpp"

#include "kernel/base/random.hpp"

#include <gtest/gtest.h>

#include <numeric>
#include <vector>

namespace tappet::history {
namespace {

std::int32_t add_to(std::int32_t& sum, std::int32_t number) { return sum += number; }

bool is_linearizable(const std::vector<Operation>& operations) {
    return Linearization{operations, add_to}.exists();
}
Operation done(int invoked, int responded, std::int32_t argument, std::int32_t result) {
    return {Time{} + Duration{invoked}, Time{} + Duration{responded}, argument, result};
}
Operation open(int invoked, std::int32_t argument) {
    return {.invoked = Time{} + Duration{invoked}, .argument = argument};
}

TEST(Linearizable, accepts_simultaneous_calls_in_either_order) {
    EXPECT_TRUE(is_linearizable({done(0, 10, 1, 1), done(5, 15, 2, 3)}));
    EXPECT_TRUE(is_linearizable({done(0, 10, 1, 3), done(5, 15, 2, 2)}));
    EXPECT_FALSE(is_linearizable({done(0, 10, 1, 1), done(5, 15, 2, 2)})) << "an update is lost";
}

TEST(Linearizable, requires_an_earlier_call_before_a_later_one) {
    EXPECT_TRUE(is_linearizable({done(0, 10, 1, 1), done(11, 15, 2, 3)}));
    EXPECT_FALSE(is_linearizable({done(0, 10, 1, 3), done(11, 15, 2, 2)}));
}

TEST(Linearizable, accepts_an_unanswered_call_at_most_once_after_its_start) {
    EXPECT_TRUE(is_linearizable({open(0, 5), done(11, 15, 2, 2)}));
    EXPECT_TRUE(is_linearizable({open(0, 5), done(11, 15, 2, 7)}));
    EXPECT_TRUE(is_linearizable({open(0, 5), done(11, 15, 2, 2), done(20, 25, 1, 8)})) << "late";
    EXPECT_FALSE(is_linearizable({open(0, 5), done(11, 15, 2, 7), done(20, 25, 1, 13)})) << "twice";
    EXPECT_FALSE(is_linearizable({open(16, 5), done(11, 15, 2, 7)}));
}

TEST(Linearizable, refuses_too_many_calls) {
    std::vector<Operation> calls;
    for (int i = 0; i < 64; ++i) calls.push_back(done(i, i, 1, i + 1));
    EXPECT_TRUE(is_linearizable(calls));
    calls.push_back(done(64, 64, 1, 65));
    EXPECT_FALSE(is_linearizable(calls));
}

/// Tries every order of every choice of the open calls.
bool is_linearizable_by_trial(const std::vector<Operation>& calls) {
    std::vector<std::size_t> order(calls.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    const auto explains = [&](std::uint64_t left_out) {
        std::int32_t sum = 0;
        for (std::size_t i = 0; i < order.size(); ++i) {
            const Operation& one = calls[order[i]];
            if ((left_out >> order[i] & 1u) != 0) {
                if (one.result) return false;
                continue;
            }
            for (std::size_t k = i + 1; k < order.size(); ++k)
                if ((left_out >> order[k] & 1u) == 0 && calls[order[k]].responded < one.invoked) return false;
            if (add_to(sum, one.argument); one.result && *one.result != sum) return false;
        }
        return true;
    };
    do
        for (std::uint64_t left_out = 0; left_out < std::uint64_t{1} << calls.size(); ++left_out)
            if (explains(left_out)) return true;
    while (std::ranges::next_permutation(order).found);
    return false;
}

TEST(Linearizable, agrees_with_trying_every_order) {
    Random random{1};
    int right = 0, wrong = 0;
    for (int n = 0; n < 2000; ++n) {
        std::vector<Operation> calls;
        for (std::uint64_t i = 2 + random.below(3); i > 0; --i) {
            const auto invoked = static_cast<int>(random.below(20));
            const auto responded = invoked + static_cast<int>(random.below(12));
            const auto argument = static_cast<std::int32_t>(random.between(1, 2));
            const auto result = static_cast<std::int32_t>(random.between(1, 5));
            calls.push_back(random.one_in(3) ? open(invoked, argument)
                                             : done(invoked, responded, argument, result));
        }
        const bool found = is_linearizable(calls);
        ASSERT_EQ(found, is_linearizable_by_trial(calls)) << "history " << n;
        ++(found ? right : wrong);
    }
    EXPECT_GT(right, 200);
    EXPECT_GT(wrong, 200);
}

} // namespace
} // namespace tappet::history
