// Properties changed by another thread while their component runs (thesis 4.7.1): its steps see all of a
// transaction or none, and every transaction ends once.
#include "kernel/component/property_transaction.hpp"

#include "tests/kernel/exchange/placed.hpp"
#include "tests/kernel/exchange/stress.hpp"

#include <gtest/gtest.h>

#include <array>
#include <atomic>
#include <thread>

namespace tappet {
namespace {

/// Its values are consecutive; it rejects a first value divisible by seven.
struct Row {
    Property<std::int64_t> first{1}, second{2}, third{3};
    std::uint64_t steps = 0, mixed = 0, changes = 0;
    Sentence accepts(const Proposal& proposal) const noexcept TAPPET_REALTIME {
        return proposal.of(first) % 7 != 0 ? Sentence{} : Sentence{"seven divides it"};
    }
    void changed() noexcept TAPPET_REALTIME { ++changes; }
    void step() noexcept TAPPET_REALTIME {
        ++steps;
        mixed += second.get() == first.get() + 1 && third.get() == first.get() + 2 ? 0u : 1u;
    }
    static constexpr auto interface() {
        return facets(property<&Row::first>("first", "", "n"), property<&Row::second>("second", "", "n + 1"),
                      property<&Row::third>("third", "", "n + 2"));
    }
};

TEST(PropertyStress, shows_a_step_all_of_a_transaction_or_none) {
    constexpr std::int64_t transactions = 5000;
    PlacedInbox placed{16};
    Inbox& inbox = placed.inbox;
    static Row row;
    std::atomic<bool> ends{false};

    std::thread engine{[&] {
        Random random{stress_seed()};
        while (!ends.load(std::memory_order_acquire)) {
            row.step();
            inbox.run_all();
            dither(random);
        }
    }};
    Random random{stress_seed() + 1};
    static PropertyTransaction transaction;
    std::uint64_t done = 0, refused = 0, captured_mixed = 0;
    const auto wait = [&] {
        while (!transaction.finished()) dither(random);
    };
    for (std::int64_t n = 1; n <= transactions; ++n) {
        const auto first = random.between(-1'000'000, 1'000'000);
        transaction.begin("row", component_type<Row>, &row);
        for (std::int64_t i = 0; i < 3; ++i) {
            const std::int64_t value = first + i;
            std::memcpy(transaction.change(static_cast<std::size_t>(i)), &value, sizeof value);
        }
        ASSERT_TRUE(inbox.post(0, transaction.commit_message(0)));
        wait();
        const bool refusable = first % 7 == 0;
        ASSERT_EQ(transaction.state(),
                  refusable ? PropertyTransaction::State::refused : PropertyTransaction::State::done);
        ASSERT_EQ(transaction.refusal().view(), refusable ? "seven divides it" : "");
        ++(refusable ? refused : done);
        transaction.begin("row", component_type<Row>, &row);
        transaction.change_all();
        ASSERT_TRUE(inbox.post(0, transaction.capture_message(0)));
        wait();
        std::array<std::int64_t, 3> seen{};
        for (std::size_t i = 0; i < 3; ++i) std::memcpy(&seen[i], transaction.values()[i].value, 8);
        captured_mixed += seen[1] == seen[0] + 1 && seen[2] == seen[0] + 2 ? 0u : 1u;
        if (!refusable) {
            ASSERT_EQ(seen[0], first);
        }
    }
    ends.store(true, std::memory_order_release);
    engine.join();
    EXPECT_EQ(row.mixed, 0u) << "of " << row.steps << " steps";
    EXPECT_EQ(captured_mixed, 0u);
    EXPECT_EQ(row.changes, done);
    EXPECT_GT(refused, 0u) << "the refusing path was taken";
}

} // namespace
} // namespace tappet
