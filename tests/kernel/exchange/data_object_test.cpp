// DataObject: the last value of one writer for many readers, undisturbed and under chosen interleavings.
#include "kernel/exchange/data_object.hpp"

#include "tests/kernel/exchange/preemption.hpp"
#include "tests/kernel/exchange/stress.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <cstdint>
#include <memory>
#include <thread>
#include <vector>

namespace {

using namespace tappet;

TEST(DataObject, holds_nothing_before_the_first_write) {
    DataObject<double> object;
    double value = 7.5;
    std::uint64_t generation = 0;
    EXPECT_FALSE(object.read(value, generation));
    EXPECT_EQ(value, 7.5);
    EXPECT_EQ(generation, 0u);
    EXPECT_EQ(object.generation(), 0u);
}

TEST(DataObject, returns_the_last_value_and_its_number) {
    DataObject<double> object;
    for (int i = 1; i <= 9; ++i) object.write(i);
    double value = 0;
    std::uint64_t generation = 0;
    ASSERT_TRUE(object.read(value, generation));
    EXPECT_EQ(value, 9.0);
    EXPECT_EQ(generation, 9u);
    EXPECT_EQ(object.generation(), 9u);
}

TEST(DataObject, returns_a_value_once_to_a_reader_that_keeps_its_number) {
    DataObject<int> object;
    object.write(5);
    int value = 0;
    std::uint64_t generation = 0;
    ASSERT_TRUE(object.read(value, generation));
    value = -1;
    EXPECT_FALSE(object.read(value, generation));
    EXPECT_EQ(value, -1);
    object.write(5);
    EXPECT_TRUE(object.read(value, generation));
    EXPECT_EQ(generation, 2u);
}

TEST(DataObject, serves_readers_independently) {
    DataObject<int> object;
    object.write(3);
    int a = 0;
    int b = 0;
    std::uint64_t generation_a = 0;
    std::uint64_t generation_b = 0;
    EXPECT_TRUE(object.read(a, generation_a));
    EXPECT_TRUE(object.read(b, generation_b));
    EXPECT_EQ(a, b);
}

TEST(DataObject, separates_private_and_published_data_by_cache_lines) {
    EXPECT_GE(sizeof(DataObject<int>), 2 * line_pair_bytes);
    EXPECT_GE(alignof(DataObject<int>), line_pair_bytes);
}

/// Values of a few words, of pairs that stay in registers, and of more pairs.
template <class T, template <class> class A> struct Carried {
    using Value = T;
    template <std::size_t slots, std::size_t attempts> using Object = DataObject<T, slots, attempts, A>;
};
template <class> class InterruptedDataObject : public testing::Test {};
using Carriages =
    testing::Types<Carried<Sealed<24>, Preemptible>, Carried<Sealed<160>, Preemptible>,
                   Carried<Sealed<160>, PreemptiblePair>, Carried<Sealed<320>, PreemptiblePair>>;
TYPED_TEST_SUITE(InterruptedDataObject, Carriages);

// One reader's call, interrupted at each of its accesses by each number of whole writes.
TYPED_TEST(InterruptedDataObject, withstands_any_burst_of_writes_at_any_point_of_a_read) {
    using Value = typename TypeParam::Value;
    constexpr std::size_t slots = 4;
    std::size_t accesses = 1;
    for (std::size_t at = 0; at < accesses; ++at) {
        for (std::uint64_t burst = 0; burst <= 2 * slots + 1; ++burst) {
            typename TypeParam::template Object<slots, 3> object;
            std::uint64_t written = 0;
            for (int i = 0; i < 5; ++i) object.write(Value::of(++written));
            Value value{};
            std::uint64_t generation = 4;
            bool fresh = false;
            const auto intruder = [&] {
                for (std::uint64_t i = 0; i < burst; ++i) object.write(Value::of(++written));
            };
            const std::size_t made =
                Preemption::here().run(at, intruder, [&] { fresh = object.read(value, generation); });
            if (burst == 0) accesses = made;
            ASSERT_TRUE(fresh) << "one burst costs one attempt; access " << at << ", burst " << burst;
            ASSERT_TRUE(value.whole()) << "access " << at << ", burst " << burst;
            ASSERT_EQ(value.number(), generation);
            ASSERT_GE(generation, 5u);
        }
    }
    EXPECT_GE(accesses, 5u) << "index, some of the value, number";
}

TEST(DataObject, completes_a_read_at_once_while_fewer_than_slots_values_are_written) {
    using Object = DataObject<Sealed<24>, 4, 1, Preemptible>;
    for (std::size_t at = 1; at < 5; ++at) {
        for (std::uint64_t burst : {3u, 4u}) {
            Object object;
            object.write(Sealed<24>::of(1));
            Sealed<24> value{};
            std::uint64_t generation = 0;
            bool fresh = false;
            const auto intruder = [&] {
                for (std::uint64_t i = 0; i < burst; ++i) object.write(Sealed<24>::of(2 + i));
            };
            Preemption::here().run(at, intruder, [&] { fresh = object.read(value, generation); });
            EXPECT_EQ(fresh, burst < 4) << "access " << at << ", burst " << burst;
        }
    }
}

TEST(DataObject, gives_up_after_its_attempts_and_keeps_the_last_good_value) {
    DataObject<Sealed<24>, 4, 3, Preemptible> object;
    std::uint64_t written = 0;
    object.write(Sealed<24>::of(++written));
    Sealed<24> value = Sealed<24>::of(77);
    std::uint64_t generation = 0;
    bool fresh = true;
    const std::size_t accesses = Preemption::here().run_always(
        [&](std::size_t) {
            for (int i = 0; i < 4; ++i) object.write(Sealed<24>::of(++written));
        },
        [&] { fresh = object.read(value, generation); });
    EXPECT_FALSE(fresh);
    EXPECT_EQ(value.number(), 77u);
    EXPECT_TRUE(value.whole());
    EXPECT_EQ(generation, 0u);
    EXPECT_GT(object.generation(), 0u) << "how a caller tells being overtaken from nothing new";
    EXPECT_EQ(accesses, 3u * (1 + 3 + 1))
        << "the worst case is counted: index, three words and number, three times";
}

TEST(DataObject, allows_reads_at_any_point_of_a_write) {
    using Object = DataObject<Sealed<24>, 2, 1, Preemptible>;
    std::size_t accesses = 1;
    for (std::size_t at = 0; at < accesses; ++at) {
        Object object;
        object.write(Sealed<24>::of(1));
        object.write(Sealed<24>::of(2));
        object.write(Sealed<24>::of(3));
        Sealed<24> value{};
        std::uint64_t generation = 0;
        bool fresh = false;
        accesses = Preemption::here().run(
            at, [&] { fresh = object.read(value, generation); }, [&] { object.write(Sealed<24>::of(4)); });
        EXPECT_TRUE(fresh);
        EXPECT_TRUE(value.whole());
        EXPECT_EQ(value.number(), 3u);
        EXPECT_EQ(generation, 3u);
    }
    EXPECT_EQ(accesses, 3u + 3u) << "a write is its words and three stores, and no load";
}

// Samples every order in which two cores may make their accesses: both sides may be in the middle of a copy.
TYPED_TEST(InterruptedDataObject, never_tears_and_never_goes_backwards_under_random_interleavings) {
    using Value = typename TypeParam::Value;
    Random random{stress_seed()};
    Interleaving interleaving;
    for (int round = 0; round < 400; ++round) {
        typename TypeParam::template Object<2, 2> object;
        const std::uint64_t seed = random.next();
        bool whole = true;
        bool forwards = true;
        interleaving.run(
            seed,
            [&] {
                for (std::uint64_t number = 1; number <= 20; ++number) object.write(Value::of(number));
            },
            [&] {
                std::uint64_t generation = 0;
                for (int i = 0; i < 15; ++i) {
                    Value value;
                    const std::uint64_t before = generation;
                    if (!object.read(value, generation)) continue;
                    whole = whole && value.whole();
                    forwards = forwards && generation > before && value.number() == generation;
                }
            });
        ASSERT_TRUE(whole) << "seed " << seed;
        ASSERT_TRUE(forwards) << "seed " << seed;
    }
}

template <class T> class DataObjectAcrossThreads : public testing::Test {};
using Sizes = testing::Types<Sealed<8>, Sealed<160>, Sealed<4096>>;
TYPED_TEST_SUITE(DataObjectAcrossThreads, Sizes);

// The writer continues until every reader has seen enough values, so that both sides met.
TYPED_TEST(DataObjectAcrossThreads, never_tears_and_never_goes_backwards) {
    constexpr std::size_t reader_count = 3;
    constexpr std::uint64_t enough = sizeof(TypeParam) > 1000 ? 500 : 3'000;
    auto object = std::make_unique<DataObject<TypeParam>>();
    std::atomic<std::size_t> satisfied{0};
    std::atomic<bool> over{false};
    std::atomic<bool> torn{false};
    std::atomic<bool> backwards{false};
    std::atomic<bool> mismatched{false};

    const auto reader = [&](std::uint64_t seed) {
        Random random{seed};
        TypeParam value{};
        std::uint64_t generation = 0;
        for (std::uint64_t seen = 0; !over;) {
            const std::uint64_t before = generation;
            if (object->read(value, generation)) {
                if (!value.whole()) torn = true;
                if (generation <= before) backwards = true;
                if (value.number() != generation) mismatched = true;
                if (++seen == enough) ++satisfied;
            }
            dither(random);
        }
    };
    std::vector<std::thread> readers;
    for (std::uint64_t i = 0; i < reader_count; ++i) readers.emplace_back(reader, stress_seed() * 10 + i);
    Random random{stress_seed()};
    std::uint64_t number = 0;
    for (; satisfied < reader_count && number < 100'000'000; ++number) {
        object->write(TypeParam::of(number + 1));
        dither(random);
    }
    over = true;
    for (auto& thread : readers) thread.join();
    EXPECT_EQ(satisfied, reader_count) << "after " << number << " writes";
    EXPECT_FALSE(torn);
    EXPECT_FALSE(backwards);
    EXPECT_FALSE(mismatched);
}

} // namespace
