// The command processor (thesis 4.5.2) without a machine: access rights to a slot, commands that end while
// others start, receivers that stop during a command, and waiting senders.
#include "kernel/activity/command_processor.hpp"

#include "tests/kernel/exchange/placed.hpp"
#include "tests/kernel/exchange/stress.hpp"

#include <gtest/gtest.h>

#include <array>
#include <memory>
#include <thread>
#include <vector>

namespace tappet {
namespace {

using Value = Sealed<64>;

/// Triples numbers, some only after a delay; rejects every seventh and fails every eleventh.
struct Tripler {
    Random random{1};
    std::array<std::uint64_t, 4> newest{}; ///< newest goal of each sender, whose number is in the lowest bits
    std::uint64_t torn = 0, out_of_order = 0, taken_up = 0;

    bool begin(Value in, Value&) noexcept TAPPET_REALTIME {
        ++taken_up;
        TAPPET_ESCAPE("a test's check", torn += in.whole() ? 0u : 1u);
        const std::uint64_t count = in.number() >> 2;
        std::uint64_t& last = newest[in.number() & 3];
        if (count <= last) ++out_of_order;
        last = count;
        return count % 7 != 0;
    }
    CommandProgress follow(Value in, Value& out) noexcept TAPPET_REALTIME {
        TAPPET_ESCAPE("a test's check", torn += in.whole() ? 0u : 1u);
        if (!random.one_in(3)) return CommandProgress::executing;
        if ((in.number() >> 2) % 11 == 0) return CommandProgress::failed;
        TAPPET_ESCAPE("a test's value", out = Value::of(in.number() * 3));
        return CommandProgress::done;
    }
    static constexpr auto& command = detail::CommandOf<&Tripler::begin, &Tripler::follow>::operations;
};

/// A processor with room for `senders` of `slots` commands each, and the component behind it.
class Receiver {
public:
    Receiver(std::size_t senders, std::size_t slots) : placed_{slots, senders}, followed_(senders * slots) {
        processor.place(placed_.mailboxes, followed_, 0);
    }
    [[nodiscard]] CommandSlot::Route route(std::size_t sender, const os::Clock& clock) {
        return {.command = &Tripler::command,
                .receiver = &gate,
                .part = 0,
                .inbox = &processor.inbox(),
                .sender = sender,
                .clock = &clock};
    }
    /// One cycle of an engine.
    void cycle() noexcept TAPPET_REALTIME {
        processor.serve([this](std::uint32_t, CommandSlot& slot) noexcept
                        TAPPET_REALTIME { static_cast<void>(processor.take_up(slot)); });
        static_cast<void>(processor.follow([](std::uint32_t, CommandSlot& slot) noexcept
                                           TAPPET_REALTIME { return !in_flight(slot.follow()); }));
    }
    void stop() noexcept {
        gate.state.store(ComponentState::stopping);
        processor.fail(0);
        gate.state.store(ComponentState::stopped);
        processor.reject_sent();
    }
    void start() noexcept {
        processor.reject_sent();
        gate.state.store(ComponentState::running);
    }

    Tripler tripler;
    GatedComponent gate{&tripler, ComponentState::running};
    CommandProcessor processor;

private:
    PlacedMailboxes<CommandMailbox> placed_;
    std::vector<CommandSlot*> followed_;
};

using Call = CommandCall<Value, Value&>;

/// A sender's view of one command; counts each impossible change of state.
struct Watched {
    Call call;
    std::uint64_t number = 0;
    CommandState last = CommandState::ready;

    [[nodiscard]] static int rank(CommandState state) {
        switch (state) {
        case CommandState::ready: return 0;
        case CommandState::sent: return 1;
        case CommandState::accepted: return 2;
        case CommandState::executing: return 3;
        default: return 4;
        }
    }
    [[nodiscard]] bool look() {
        const CommandState now = call.state();
        const bool follows = rank(now) >= rank(last) && !(now == CommandState::rejected && rank(last) > 1);
        last = now;
        return follows;
    }
};

struct Seen {
    std::uint64_t done = 0, rejected = 0, failed = 0, wrong_results = 0, wrong_states = 0, not_sent = 0;
};

/// Resends every ended command, `rounds` times, to receivers that occasionally stop.
Seen send_many(std::size_t sender, std::span<const std::unique_ptr<Watched>> calls, std::uint64_t rounds,
               std::uint64_t seed) {
    Seen seen;
    Random random{seed};
    std::uint64_t count = 0;
    const auto settle = [&](Watched& each) {
        switch (each.last) {
        case CommandState::done: {
            ++seen.done;
            const Value out = each.call.result();
            if (!out.whole() || out.number() != each.number * 3) ++seen.wrong_results;
            break;
        }
        case CommandState::rejected: ++seen.rejected; break;
        case CommandState::failed: ++seen.failed; break;
        default: break;
        }
    };
    for (std::uint64_t round = 0; round < rounds; ++round) {
        Watched& each = *calls[random.below(calls.size())];
        if (!each.look()) ++seen.wrong_states;
        if (!in_flight(each.last)) {
            settle(each);
            each.number = ++count << 2 | sender;
            each.last = CommandState::ready;
            if (!each.call.send(Value::of(each.number))) ++seen.not_sent;
        }
        dither(random);
    }
    for (const auto& each : calls) {
        while (in_flight(each->call.state())) std::this_thread::yield();
        if (!each->look()) ++seen.wrong_states;
        settle(*each);
    }
    return seen;
}

TEST(CommandProcessor, completes_every_command_with_its_own_results_in_sender_order) {
    constexpr std::size_t senders = 3, slots = 4;
    const os::Clock clock{os::Clock::Kind::real};
    Seen all; // a schedule may show only one end for one sender
    for (std::uint64_t seed = stress_seed(); seed < stress_seed() + 4; ++seed) {
        std::array<Receiver, 2> receivers{Receiver{senders, slots}, Receiver{senders, slots}};
        std::array<std::vector<std::unique_ptr<Watched>>, senders> calls;
        for (std::size_t s = 0; s < senders; ++s)
            for (std::size_t i = 0; i < 2 * slots; ++i) {
                calls[s].push_back(std::make_unique<Watched>());
                Call& call = calls[s].back()->call;
                call.slot().place(receivers[i % 2].route(s, clock), call.values());
            }
        std::atomic<bool> over{false};
        std::vector<std::thread> threads;
        for (std::size_t r = 0; r < receivers.size(); ++r)
            threads.emplace_back([&, r, seed] {
                Random random{seed * 7 + r};
                while (!over.load(std::memory_order_acquire)) {
                    receivers[r].cycle();
                    if (random.one_in(200)) {
                        receivers[r].stop();
                        dither(random);
                        receivers[r].start();
                    }
                    dither(random);
                }
            });
        std::array<Seen, senders> seen{};
        std::vector<std::thread> sending;
        for (std::size_t s = 0; s < senders; ++s)
            sending.emplace_back([&, s, seed] { seen[s] = send_many(s, calls[s], 60'000, seed * 31 + s); });
        for (std::thread& each : sending) each.join();
        over.store(true, std::memory_order_release);
        for (std::thread& each : threads) each.join();
        for (const Seen& each : seen) {
            EXPECT_EQ(each.wrong_results, 0u) << "seed " << seed;
            EXPECT_EQ(each.wrong_states, 0u) << "seed " << seed;
            EXPECT_EQ(each.not_sent, 0u) << "seed " << seed;
            all.done += each.done;
            all.rejected += each.rejected;
            all.failed += each.failed;
        }
        for (const Receiver& each : receivers) {
            EXPECT_EQ(each.tripler.torn, 0u) << "seed " << seed;
            EXPECT_EQ(each.tripler.out_of_order, 0u) << "seed " << seed;
            EXPECT_EQ(each.processor.at_work(), 0u) << "seed " << seed;
        }
    }
    EXPECT_GT(all.done, 0u);
    EXPECT_GT(all.rejected, 0u);
    EXPECT_GT(all.failed, 0u);
}

/// A receiver of one command and its only sender.
struct OneCommand : testing::Test {
    const os::Clock clock{os::Clock::Kind::real};
    Receiver receiver{1, 1};
    Call call;
    CommandSlot::Route route = receiver.route(0, clock);

    OneCommand() { call.slot().place(route, call.values()); }
};

TEST_F(OneCommand, wakes_its_waiting_sender_however_it_ends) {
    std::atomic<bool> over{false};
    std::thread serving([&] {
        Random random{stress_seed()};
        while (!over.load(std::memory_order_acquire)) {
            receiver.cycle();
            dither(random);
        }
    });
    Random random{stress_seed() + 1};
    std::uint64_t missed = 0;
    for (std::uint64_t i = 1; i <= 3000; ++i) {
        ASSERT_TRUE(call.send(Value::of(i << 2)));
        dither(random);
        if (!call.wait(10s)) ++missed;
        const CommandState expected = i % 7 == 0    ? CommandState::rejected
                                      : i % 11 == 0 ? CommandState::failed
                                                    : CommandState::done;
        ASSERT_EQ(call.state(), expected);
    }
    over.store(true, std::memory_order_release);
    serving.join();
    EXPECT_EQ(missed, 0u);
}

TEST_F(OneCommand, limits_a_wait_to_the_given_time) {
    EXPECT_TRUE(call.wait(10s)); // nothing was sent
    ASSERT_TRUE(call.send(Value::of(4)));
    const Time before = clock.now();
    EXPECT_FALSE(call.wait(20ms)); // no engine serves
    EXPECT_GE(clock.now() - before, 20ms);
    EXPECT_EQ(call.state(), CommandState::sent);
    receiver.cycle();
    while (in_flight(call.state())) receiver.cycle();
    EXPECT_TRUE(call.wait(0ms));
}

TEST_F(OneCommand, wakes_its_senders_activity_when_it_ends) {
    int wakes = 0;
    route.wake_sender = {[](void* count) noexcept TAPPET_REALTIME { ++*static_cast<int*>(count); }, &wakes};
    call.slot().place(route, call.values());
    ASSERT_TRUE(call.send(Value::of(4)));
    EXPECT_EQ(wakes, 0);
    while (in_flight(call.state())) receiver.cycle();
    EXPECT_EQ(wakes, 1); // not for each intermediate state
}

TEST_F(OneCommand, is_rejected_by_a_stopped_component_but_queued_for_an_inactive_one) {
    for (const ComponentState state : {ComponentState::stopped, ComponentState::failed}) {
        receiver.gate.state.store(state);
        ASSERT_TRUE(call.send(Value::of(4)));
        EXPECT_EQ(call.state(), CommandState::rejected);
    }
    receiver.gate.state.store(ComponentState::inactive);
    ASSERT_TRUE(call.send(Value::of(8)));
    EXPECT_EQ(call.state(), CommandState::sent);
    receiver.gate.state.store(ComponentState::running);
    receiver.cycle();
    EXPECT_NE(call.state(), CommandState::rejected);
}

} // namespace
} // namespace tappet
