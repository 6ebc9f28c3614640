// LocalRing: the buffer inside one activity (thesis 4.4), judged by a queue of the standard library.
#include "kernel/exchange/local_ring.hpp"

#include "kernel/base/random.hpp"

#include <gtest/gtest.h>

#include <Eigen/Core>

#include <deque>
#include <vector>

namespace {

using namespace tappet;

template <class T>
struct Placed {
    Placed(std::size_t capacity, Overflow overflow)
        : storage(capacity), ring{reinterpret_cast<std::byte*>(storage.data()), capacity, overflow} {}
    std::vector<T> storage; // as much room, at the right alignment, as the ring asks for
    LocalRing<T> ring;
};
static_assert(LocalRing<int>::bytes_for(7) == sizeof(int) * 7 && LocalRing<double>::alignment == 8);

void behaves_as_a_queue(std::size_t capacity, Overflow overflow, std::uint64_t seed) {
    Placed<Eigen::Vector3d> placed{capacity, overflow};
    std::deque<double> queue;
    std::uint64_t lost = 0;
    std::size_t most = 0;
    Random random{seed};
    for (int i = 0; i < 3'000; ++i) {
        const auto number = static_cast<double>(i);
        if (random.below(2 + static_cast<std::uint64_t>(i) / 1'000) != 0) {
            const bool full = queue.size() == capacity;
            EXPECT_EQ(placed.ring.push({number, 0, -number}), !full || overflow == Overflow::drop_oldest);
            lost += full;
            if (full && overflow == Overflow::drop_oldest) queue.pop_front();
            if (!full || overflow == Overflow::drop_oldest) queue.push_back(number);
        } else {
            Eigen::Vector3d value{-1, -1, -1};
            ASSERT_EQ(placed.ring.pop(value), !queue.empty());
            if (queue.empty()) {
                EXPECT_EQ(value, Eigen::Vector3d(-1, -1, -1)) << "untouched";
                continue;
            }
            ASSERT_EQ(value, Eigen::Vector3d(queue.front(), 0, -queue.front()));
            queue.pop_front();
        }
        most = std::max(most, queue.size());
        ASSERT_EQ(placed.ring.size(), queue.size());
        ASSERT_EQ(placed.ring.empty(), queue.empty());
        ASSERT_EQ(placed.ring.lost(), lost);
        ASSERT_EQ(placed.ring.high_water(), most);
    }
    EXPECT_EQ(placed.ring.capacity(), capacity);
    EXPECT_GT(lost, 0u) << "the run met a full ring";
}

TEST(LocalRing, behaves_as_a_queue_that_refuses_or_drops_when_it_is_full) {
    const auto seed = static_cast<std::uint64_t>(testing::UnitTest::GetInstance()->random_seed());
    for (std::size_t capacity : {1u, 2u, 3u, 7u, 16u}) {
        behaves_as_a_queue(capacity, Overflow::reject, seed + capacity);
        behaves_as_a_queue(capacity, Overflow::drop_oldest, seed - capacity);
    }
}

} // namespace
