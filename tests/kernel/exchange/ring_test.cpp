// Ring: a buffer of one writer and one reader, and its overflow policies. LocalRing: the same within one
// activity (thesis 4.4).
#include "kernel/exchange/ring.hpp"

#include "kernel/exchange/local_ring.hpp"
#include "tests/kernel/exchange/placed.hpp"

#include "tests/kernel/exchange/preemption.hpp"
#include "tests/kernel/exchange/stress.hpp"

#include <gtest/gtest.h>

#include <Eigen/Core>

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <thread>

namespace {

using namespace tappet;

template <class T, template <class> class Atomic = std::atomic>
using Placed = PlacedRing<Ring<T, Atomic>>;

static_assert(LocalRing<int>::bytes_for(7) == sizeof(int) * 7 && LocalRing<double>::alignment == 8);

TEST(Ring, refuses_everything_until_memory_is_assigned) {
    Ring<int> ring;
    int value = 7;
    EXPECT_FALSE(ring.push(1));
    EXPECT_FALSE(ring.pop(value));
    EXPECT_EQ(value, 7);
    EXPECT_EQ(ring.lost(), 1u);
    EXPECT_EQ(ring.capacity(), 0u);
}

TEST(Ring, is_empty_again_after_a_machine_restart) {
    Placed<int> placed{4, Overflow::reject};
    EXPECT_TRUE(placed.ring.push(1));
    Ring<int> again{placed.memory.data(), 4, Overflow::drop_oldest};
    int value = 0;
    EXPECT_FALSE(again.pop(value));
}

// Any sequence of pushes and pops behaves like a plain queue with the same rule, also with room for one.
// Values stay in order. On overflow the value is refused, or the oldest is dropped and counted before the
// consumer notices. The maximum fill is recorded. An empty pop leaves the caller's value unchanged. `of`
// converts a number to a value.
template <class Queue>
void agrees_with_a_plain_queue(auto of) {
    Random random{stress_seed()};
    std::uint64_t lost_in_all = 0;
    for (int round = 0; round < 200; ++round) {
        const auto capacity = static_cast<std::size_t>(random.between(1, 16));
        const Overflow overflow = random.one_in(2) ? Overflow::reject : Overflow::drop_oldest;
        const std::uint64_t bias = 2 + random.below(4);
        PlacedRing<Queue> placed{capacity, overflow};
        std::deque<std::uint64_t> model;
        std::uint64_t lost = 0;
        std::size_t mark = 0;
        for (std::uint64_t step = 0; step < 300; ++step) {
            if (random.below(bias) != 0) {
                const bool full = model.size() == capacity;
                const bool taken = !full || overflow == Overflow::drop_oldest;
                ASSERT_EQ(placed.ring.push(of(step)), taken);
                if (full) ++lost;
                if (full && taken) model.pop_front();
                if (taken) model.push_back(step);
                mark = std::max(mark, model.size());
            } else {
                auto value = of(1000);
                ASSERT_EQ(placed.ring.pop(value), !model.empty());
                ASSERT_EQ(value, of(model.empty() ? 1000 : model.front())) << "the next, or untouched";
                if (!model.empty()) model.pop_front();
            }
            ASSERT_EQ(placed.ring.size(), model.size());
            ASSERT_EQ(placed.ring.empty(), model.empty());
            ASSERT_EQ(placed.ring.lost(), lost);
            ASSERT_EQ(placed.ring.high_water(), mark);
        }
        ASSERT_EQ(placed.ring.capacity(), capacity);
        lost_in_all += lost;
    }
    EXPECT_GT(lost_in_all, 0u) << "full rings were met";
}

TEST(Ring, agrees_with_a_plain_queue_on_random_sequences) {
    agrees_with_a_plain_queue<Ring<Sealed<40>>>([](std::uint64_t number) { return Sealed<40>::of(number); });
    agrees_with_a_plain_queue<Ring<int>>([](std::uint64_t number) { return static_cast<int>(number); });
}

TEST(LocalRing, agrees_with_a_plain_queue_on_random_sequences) {
    agrees_with_a_plain_queue<LocalRing<Eigen::Vector3d>>([](std::uint64_t number) {
        const auto value = static_cast<double>(number);
        return Eigen::Vector3d{value, 0, -value};
    });
}

// The invariant of every schedule, checked at its end: whole values in order, and each pushed value popped,
// lost or still inside.
struct Ledger {
    std::uint64_t pushed = 0;
    std::uint64_t popped = 0;
    std::uint64_t last = 0;
    bool whole = true;
    bool ordered = true;

    template <class Queue> void push(Queue& ring) {
        ++pushed;
        static_cast<void>(ring.push(Sealed<16>::of(pushed)));
    }
    template <class Queue> bool pop(Queue& ring) {
        Sealed<16> value{};
        if (!ring.pop(value)) return false;
        ++popped;
        whole = whole && value.whole();
        ordered = ordered && value.number() > last;
        last = value.number();
        return true;
    }
    template <class Queue> void settle(Queue& ring) {
        EXPECT_TRUE(whole);
        EXPECT_TRUE(ordered);
        EXPECT_EQ(pushed, popped + ring.lost() + ring.size());
        while (pop(ring)) {
        }
        EXPECT_EQ(pushed, popped + ring.lost());
        EXPECT_TRUE(whole);
        EXPECT_TRUE(ordered);
    }
};

/// One call of `tested`, interrupted at each of its accesses by up to `most` calls of `other`.
void withstands_any_burst(std::size_t most, auto other, auto tested) {
    for (const Overflow overflow : {Overflow::reject, Overflow::drop_oldest}) {
        for (std::size_t before = 0; before < 8; ++before) {
            for (std::size_t burst = 0; burst <= most; ++burst) {
                std::size_t accesses = 1;
                for (std::size_t at = 0; at < accesses; ++at) {
                    SCOPED_TRACE(testing::Message()
                                 << "filled " << before << " burst " << burst << " at " << at);
                    Placed<Sealed<16>, Preemptible> placed{3, overflow};
                    Ledger ledger;
                    for (std::size_t i = 0; i < before; ++i) ledger.push(placed.ring);
                    const auto intruder = [&] {
                        for (std::size_t i = 0; i < burst; ++i) other(ledger, placed.ring);
                    };
                    bool is_done = false;
                    accesses =
                        Preemption::here().run(at, intruder, [&] { is_done = tested(ledger, placed.ring); });
                    EXPECT_TRUE(is_done || before == 0) << "one burst costs one attempt";
                    ledger.settle(placed.ring);
                }
            }
        }
    }
}
constexpr auto push_one = [](Ledger& ledger, auto& ring) {
    ledger.push(ring);
    return true;
};
constexpr auto pop_one = [](Ledger& ledger, auto& ring) { return ledger.pop(ring); };

TEST(Ring, withstands_any_burst_of_pushes_at_any_point_of_a_pop) {
    withstands_any_burst(11, push_one, pop_one);
}

TEST(Ring, withstands_any_burst_of_pops_at_any_point_of_a_push) {
    withstands_any_burst(5, pop_one, push_one);
}

TEST(Ring, gives_up_a_pop_after_its_attempts_when_it_drops) {
    Placed<Sealed<16>, Preemptible> placed{2, Overflow::drop_oldest};
    Ledger ledger;
    ledger.push(placed.ring);
    bool taken = true;
    const std::size_t accesses = Preemption::here().run_always(
        [&](std::size_t) {
            for (int i = 0; i < 5; ++i) ledger.push(placed.ring);
        },
        [&] { taken = ledger.pop(placed.ring); });
    EXPECT_FALSE(taken);
    EXPECT_LE(accesses, 3u * (1 + 3 + 2 + 1))
        << "counted: tail, three stores of a skip, two words and a number";
    EXPECT_TRUE(ledger.pop(placed.ring));
    ledger.settle(placed.ring);
}

TEST(Ring, makes_a_bounded_number_of_accesses_in_a_push) {
    Placed<Sealed<16>, Preemptible> placed{2, Overflow::drop_oldest};
    for (int i = 0; i < 10; ++i) {
        const std::size_t accesses =
            Preemption::here().run(~std::size_t{0}, [] {}, [&] { static_cast<void>(placed.ring.push({})); });
        EXPECT_LE(accesses, 2u + 2u + 4u);
    }
}

TEST(Ring, returns_the_oldest_value_despite_two_pushes_within_a_pop) {
    for (const std::uint64_t burst : {1u, 2u, 3u}) {
        for (std::size_t at = 1; at < 4; ++at) {
            Placed<Sealed<16>, Preemptible> placed{3, Overflow::drop_oldest};
            Ledger ledger;
            for (int i = 0; i < 3; ++i) ledger.push(placed.ring);
            const auto intruder = [&] {
                for (std::uint64_t i = 0; i < burst; ++i) ledger.push(placed.ring);
            };
            Preemption::here().run(at, intruder, [&] { EXPECT_TRUE(ledger.pop(placed.ring)); });
            EXPECT_EQ(ledger.last, burst <= 2 ? 1u : 4u) << "burst " << burst << " at " << at;
            ledger.settle(placed.ring);
        }
    }
}

TEST(Ring, stops_reading_the_consumer_index_once_its_mark_is_set) {
    Placed<Sealed<16>, Preemptible> placed{8, Overflow::reject};
    Ledger ledger;
    for (int i = 0; i < 4; ++i) ledger.push(placed.ring);
    while (ledger.pop(placed.ring)) {
    }
    const auto push = [&] {
        return Preemption::here().run(~std::size_t{0}, [] {}, [&] { ledger.push(placed.ring); });
    };
    constexpr std::size_t stores_and_the_mark = 1 + 2 + 1 + 1 + 1;
    EXPECT_EQ(push(), stores_and_the_mark + 1) << "after four pushes the fill could be new";
    EXPECT_EQ(push(), stores_and_the_mark);
    EXPECT_EQ(push(), stores_and_the_mark);
}

// Samples every order in which two cores may make their accesses: both sides may be in the middle of a copy.
TEST(Ring, loses_no_value_uncounted_under_random_interleavings) {
    Random random{stress_seed()};
    Interleaving interleaving;
    for (int round = 0; round < 400; ++round) {
        const auto capacity = static_cast<std::size_t>(random.between(1, 4));
        const Overflow overflow = random.one_in(4) ? Overflow::reject : Overflow::drop_oldest;
        const std::uint64_t pushes = 5 + random.below(25);
        const std::uint64_t pops = 1 + random.below(20);
        const std::uint64_t seed = random.next();
        SCOPED_TRACE(testing::Message() << "capacity " << capacity << " seed " << seed);
        Placed<Sealed<16>, Preemptible> placed{capacity, overflow};
        Ledger ledger;
        std::uint64_t pushed = 0;
        interleaving.run(
            seed,
            [&] {
                for (; pushed < pushes; ++pushed)
                    static_cast<void>(placed.ring.push(Sealed<16>::of(pushed + 1)));
            },
            [&] {
                for (std::uint64_t i = 0; i < pops; ++i) ledger.pop(placed.ring);
            });
        ledger.pushed = pushed;
        ledger.settle(placed.ring);
        if (HasFailure()) break;
    }
}

class RingAcrossThreads : public testing::TestWithParam<std::size_t> {};
INSTANTIATE_TEST_SUITE_P(Capacities, RingAcrossThreads, testing::Values(1, 2, 7, 64));

TEST_P(RingAcrossThreads, keeps_every_value_in_order_when_the_producer_waits_for_room) {
    constexpr std::uint64_t last = 10'000;
    Placed<Sealed<160>> placed{GetParam(), Overflow::reject};
    std::uint64_t refused = 0;
    std::thread producer([&] {
        Random random{stress_seed()};
        for (std::uint64_t number = 1; number <= last;) {
            if (placed.ring.push(Sealed<160>::of(number)))
                ++number;
            else {
                ++refused;
                rest();
            }
            dither(random);
        }
    });
    Random random{stress_seed() + 1};
    bool whole = true;
    bool next = true;
    for (std::uint64_t expected = 1; expected <= last;) {
        Sealed<160> value;
        if (placed.ring.pop(value)) {
            whole = whole && value.whole();
            next = next && value.number() == expected;
            ++expected;
        } else {
            rest();
        }
        dither(random);
    }
    producer.join();
    EXPECT_TRUE(whole);
    EXPECT_TRUE(next);
    EXPECT_EQ(placed.ring.lost(), refused);
    EXPECT_LE(placed.ring.high_water(), GetParam());
}

TEST_P(RingAcrossThreads, counts_every_value_that_it_drops) {
    constexpr std::uint64_t last = 150'000;
    Placed<Sealed<160>> placed{GetParam(), Overflow::drop_oldest};
    std::atomic<bool> done{false};
    bool plausible = true;
    std::thread producer([&] {
        Random random{stress_seed()};
        for (std::uint64_t number = 1; number <= last; ++number) {
            static_cast<void>(placed.ring.push(Sealed<160>::of(number)));
            if (placed.ring.lost() > number) plausible = false;
            dither(random);
        }
        done = true;
    });
    Random random{stress_seed() + 1};
    std::uint64_t popped = 0;
    std::uint64_t before = 0;
    bool whole = true;
    bool ordered = true;
    bool more = true;
    while (more) {
        const bool finished = done;
        Sealed<160> value;
        more = placed.ring.pop(value);
        if (more) {
            ++popped;
            whole = whole && value.whole();
            ordered = ordered && value.number() > before;
            before = value.number();
        } else {
            more = !finished;
            rest();
        }
        dither(random);
    }
    producer.join();
    EXPECT_TRUE(whole);
    EXPECT_TRUE(ordered);
    EXPECT_EQ(before, last) << "the newest is never the one given up";
    EXPECT_EQ(popped + placed.ring.lost(), last);
    EXPECT_TRUE(plausible) << "the producer may ask at any time and nothing counts twice";
}

} // namespace
