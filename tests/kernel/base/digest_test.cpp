// Digest: one number that shows whether two logs are equal.
#include "kernel/base/digest.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <initializer_list>
#include <set>

namespace {

using namespace tappet;

constexpr Digest of(std::initializer_list<std::uint64_t> words) {
    Digest digest;
    for (const std::uint64_t word : words) digest.add(word);
    return digest;
}
static_assert(of({1, 2, 3}) == of({1, 2, 3}));

TEST(Digest, depends_on_the_order) { EXPECT_NE(of({1, 2}), of({2, 1})); }

TEST(Digest, depends_on_the_number_of_zeros_added) { EXPECT_NE(of({0}), of({0, 0})); }

TEST(Digest, encodes_signed_words_as_their_bits) {
    Digest digest;
    digest.add(std::int64_t{-1});
    EXPECT_EQ(digest, of({~std::uint64_t{0}}));
}

TEST(Digest, changes_with_every_single_bit) {
    std::set<std::uint64_t> values;
    for (unsigned bit = 0; bit < 64; ++bit) values.insert(of({std::uint64_t{1} << bit, 5}).value());
    EXPECT_EQ(values.size(), 64u);
}

TEST(Digest, propagates_the_highest_bit_to_lower_bits) {
    const std::uint64_t difference = of({std::uint64_t{1} << 63}).value() ^ of({0}).value();
    EXPECT_NE(difference << 16, 0u);
}

TEST(Digest, is_the_same_with_every_compiler) { EXPECT_EQ(of({1, 2, 3}).value(), 0x6da0eea95f45479eu); }

} // namespace
