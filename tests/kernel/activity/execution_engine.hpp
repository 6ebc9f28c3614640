// The execution engine in virtual time, for tests: two workers that note their calls.
#pragma once

#include "kernel/activity/engine.hpp"
#include "tests/kernel/exchange/placed.hpp"

#include <gtest/gtest.h>

#include <array>
#include <string>
#include <vector>

namespace tappet {

/// The common log of all notes, in order.
struct Log {
    std::vector<std::string> lines;
    void add(std::string_view line) noexcept TAPPET_REALTIME {
        TAPPET_ESCAPE("a test remembers", lines.emplace_back(line));
    }
};

/// A component that takes a given time for each of its functions.
struct Worker {
    Log* log = nullptr;
    os::Clock* clock = nullptr;
    std::string_view name;
    Duration load{};
    Duration reaction_load{};
    Timer timer;
    Duration rings_every{}; ///< period of the timer; none: one shot
    Cycle last{};
    const Engine* observed = nullptr;
    std::vector<std::string> unguarded; ///< its calls under an even generation
    void note(std::string_view what) noexcept TAPPET_REALTIME {
        if (observed != nullptr && observed->generation() % 2 == 0)
            TAPPET_ESCAPE("a test remembers", unguarded.emplace_back(what));
        TAPPET_ESCAPE("a test remembers", log->lines.push_back(std::string{name} + " " + std::string{what}));
        clock->consume(load);
    }
    void start(const Cycle&) noexcept TAPPET_REALTIME { note("starts"); }
    void step(const Cycle& cycle) noexcept TAPPET_REALTIME {
        last = cycle;
        note("steps");
    }
    void stop(const Cycle&) noexcept TAPPET_REALTIME { note("stops"); }
    void ring(const Cycle& cycle) noexcept TAPPET_REALTIME {
        last = cycle;
        note("rings");
        if (rings_every > Duration{}) timer.arm(cycle.after(rings_every));
    }
    void hear() noexcept TAPPET_REALTIME {
        note("hears");
        clock->consume(reaction_load);
    }
    static constexpr auto interface() {
        return facets(tappet::timer<&Worker::timer, &Worker::ring>("timer", "rings"),
                      operation<&Worker::hear>("hear", "hears"));
    }
};

struct ExecutionEngine : testing::Test {
    static constexpr Duration period = 1ms;

    ExecutionEngine() {
        for (std::size_t i = 0; i < workers.size(); ++i) {
            workers[i].log = &log;
            workers[i].clock = &clock;
            workers[i].name = names[i];
            parts[i].name = names[i];
            parts[i].place(&workers[i]);
            parts[i].type = &component_type<Worker>;
            timers[i] = {&workers[i].timer, detail::TimerCall<&Worker::ring>::operations.fire,
                         static_cast<std::uint32_t>(i)};
        }
        plan.name = "motion";
        plan.periodic = true;
        plan.period = period;
        plan.deadline = period;
        plan.parts = parts;
        plan.functions = functions;
        plan.timers = timers;
        engine.inbox().place(placed.mailboxes);
    }
    /// Begins a sporadic activity with a budget of 100 us, which promises at most so many wakes in 1 ms.
    void begin_sporadic(std::uint32_t at_most) {
        plan.budget = std::chrono::microseconds{100};
        plan.periodic = false;
        plan.at_most_n = at_most;
        plan.at_most_per = std::chrono::milliseconds{1};
        begin();
    }
    void begin() {
        engine.place(plan, clock);
        engine.on_stop(
            [](void* self, StopReason reason, std::uint64_t detail, const Engine&) noexcept TAPPET_REALTIME {
                auto& test = *static_cast<ExecutionEngine*>(self);
                TAPPET_ESCAPE("a test remembers", test.stops.emplace_back(reason, detail));
            },
            this);
        engine.start(clock.now());
        log.lines.clear();
    }
    /// Advances to the next cycle and runs it.
    void next_cycle() {
        clock.advance_to(engine.next_wake());
        engine.run(false);
    }
    void tell(std::uint32_t part) {
        Message message;
        message.run = [](void* gate, const std::byte* packed) noexcept TAPPET_REALTIME {
            static_cast<void>(OperationCall<&Worker::hear>::run(*static_cast<GatedComponent*>(gate),
                                                                Entry::at_once, packed));
        };
        message.object = &engine.plan().parts[part];
        message.id = part;
        ASSERT_TRUE(engine.inbox().post(0, message));
    }
    static constexpr std::uint32_t index(std::uint32_t part, FunctionKind kind) {
        return part * functions_per_part + static_cast<std::uint32_t>(kind);
    }
    const EngineStatistics& statistics() const { return engine.statistics(); }
    const Miss& last_miss() const {
        return statistics().recent_misses[(statistics().misses - 1) % statistics().recent_misses.size()];
    }

    Log log;
    os::Clock clock{os::Clock::Kind::virtual_time};
    std::array<std::string_view, 2> names{"a", "b"};
    std::array<Worker, 2> workers{};
    std::array<EnginePart, 2> parts{};
    std::array<EngineTimer, 2> timers{};
    std::array<FunctionTiming, 2 * functions_per_part> functions{};
    PlacedMailboxes<Mailbox> placed{4};
    EnginePlan plan;
    Engine engine;
    using Stops = std::vector<std::pair<StopReason, std::uint64_t>>;
    Stops stops;
};

using Lines = std::vector<std::string>;

} // namespace tappet
