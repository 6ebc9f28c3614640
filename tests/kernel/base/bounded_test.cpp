// Bounded: a list of at most N elements in its own memory.
#include "kernel/base/bounded.hpp"

#include <gtest/gtest.h>

#include <numeric>

namespace {

using namespace tappet;

constexpr int sum_of_three() {
    Bounded<int, 3> items;
    for (int i = 1; i <= 3; ++i) {
        if (!items.push(i)) return -1;
    }
    int sum = 0;
    for (const int item : items) sum += item;
    return sum;
}
static_assert(sum_of_three() == 6, "usable in constant expressions");

TEST(Bounded, is_empty_at_first) {
    const Bounded<int, 2> items;
    EXPECT_TRUE(items.empty());
    EXPECT_EQ(items.begin(), items.end());
}

TEST(Bounded, keeps_pushed_elements_in_order) {
    Bounded<int, 4> items;
    for (const int item : {7, 5, 9}) EXPECT_TRUE(items.push(item));
    EXPECT_EQ(items.size(), 3u);
    EXPECT_EQ(items[0], 7);
    EXPECT_EQ(items[2], 9);
    EXPECT_EQ(std::accumulate(items.begin(), items.end(), 0), 21);
    EXPECT_EQ(items.data(), items.begin());
}

TEST(Bounded, refuses_a_push_when_full_and_keeps_its_elements) {
    Bounded<int, 2> items;
    EXPECT_TRUE(items.push(1));
    EXPECT_FALSE(items.full());
    EXPECT_TRUE(items.push(2));
    EXPECT_TRUE(items.full());
    EXPECT_FALSE(items.push(3));
    EXPECT_EQ(items.size(), 2u);
    EXPECT_EQ(items[1], 2);
}

TEST(Bounded, has_room_again_after_it_is_cleared) {
    Bounded<int, 1> items;
    EXPECT_TRUE(items.push(1));
    items.clear();
    EXPECT_TRUE(items.empty());
    EXPECT_TRUE(items.push(2));
    EXPECT_EQ(items[0], 2);
    EXPECT_EQ((Bounded<int, 1>::capacity()), 1u);
}

} // namespace
