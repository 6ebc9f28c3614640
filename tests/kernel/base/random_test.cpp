// Random: the numbers of its generator, and distributions within their bounds.
#include "kernel/base/random.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cstdint>

namespace {

using namespace tappet;

constexpr std::uint64_t draw(std::uint64_t seed, int nth) {
    Random random{seed};
    for (int i = 0; i < nth; ++i) static_cast<void>(random.next());
    return random.next();
}
static_assert(draw(42, 5) == draw(42, 5) && draw(42, 5) != draw(43, 5), "usable in constant expressions");

// The published algorithms, written again from the formulas of their papers.
struct Reference {
    std::array<std::uint64_t, 4> s{};
    explicit Reference(std::uint64_t x) {
        for (std::uint64_t& word : s) {
            std::uint64_t z = (x += 0x9e3779b97f4a7c15);
            z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9;
            z = (z ^ (z >> 27)) * 0x94d049bb133111eb;
            word = z ^ (z >> 31);
        }
    }
    static std::uint64_t rotl(std::uint64_t x, int k) { return (x << k) | (x >> (64 - k)); }
    std::uint64_t next() {
        const std::uint64_t result = rotl(s[1] * 5, 7) * 9;
        const std::uint64_t t = s[1] << 17;
        s[2] ^= s[0];
        s[3] ^= s[1];
        s[1] ^= s[2];
        s[0] ^= s[3];
        s[2] ^= t;
        s[3] = rotl(s[3], 45);
        return result;
    }
};

TEST(Random, reproduces_splitmix64_and_xoshiro256) {
    // The first word of splitmix64 for seed 0 is published; xoshiro's first result follows from its second
    // word.
    EXPECT_EQ(Reference{0}.s[0], 0xe220a8397b1dcdafu);
    for (const std::uint64_t seed : {std::uint64_t{0}, std::uint64_t{1}, ~std::uint64_t{0}}) {
        Random random{seed};
        Reference reference{seed};
        for (int i = 0; i < 100; ++i) ASSERT_EQ(random.next(), reference.next());
    }
}

TEST(Random, stays_below_its_bound) {
    Random random{3};
    for (const std::uint64_t bound : {std::uint64_t{1}, std::uint64_t{7}, std::uint64_t{1} << 40}) {
        for (int i = 0; i < 1000; ++i) ASSERT_LT(random.below(bound), bound);
    }
    EXPECT_EQ(random.below(0), 0u);
}

TEST(Random, reaches_both_ends_of_a_range) {
    Random random{3};
    bool low = false;
    bool high = false;
    for (int i = 0; i < 1000; ++i) {
        const std::int64_t value = random.between(-2, 2);
        ASSERT_GE(value, -2);
        ASSERT_LE(value, 2);
        low = low || value == -2;
        high = high || value == 2;
    }
    EXPECT_TRUE(low && high);
    EXPECT_EQ(random.between(5, 5), 5);
}

TEST(Random, is_distributed_evenly) {
    Random random{99};
    std::array<int, 10> hits{};
    for (int i = 0; i < 100'000; ++i) ++hits[random.below(10)];
    for (const int n : hits) EXPECT_NEAR(n, 10'000, 500);
}

TEST(Random, is_true_with_a_probability_of_one_in_n) {
    Random random{5};
    int hits = 0;
    for (int i = 0; i < 100'000; ++i) hits += random.one_in(50) ? 1 : 0;
    EXPECT_NEAR(hits, 2'000, 250);
    EXPECT_FALSE(random.one_in(0));
    EXPECT_TRUE(random.one_in(1));
}

TEST(Random, gives_reals_from_zero_up_to_but_below_one) {
    Random random{8};
    double sum = 0;
    for (int i = 0; i < 10'000; ++i) {
        const double value = random.unit();
        ASSERT_GE(value, 0.0);
        ASSERT_LT(value, 1.0);
        sum += value;
    }
    EXPECT_NEAR(sum / 10'000, 0.5, 0.02);
}

} // namespace
