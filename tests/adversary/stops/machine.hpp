// SPDX-License-Identifier: Apache-2.0
// A machine in real time whose user functions take as long as a seed says, with users who restart its
// activities; and the memory in which its judge sees it from another process.
#pragma once

#include "kernel/component/loop.hpp"
#include "kernel/machine/accept.hpp"
#include "kernel/machine/instance/instance.hpp"
#include "kernel/os/sleep.hpp"
#include "tests/toolchain/machine/firmware_on_host.hpp"

#include <array>
#include <atomic>
#include <csignal>

#include <sys/syscall.h>
#include <unistd.h>

namespace tappet::stops {

enum class Function : std::uint8_t { initialise, finalise, start, work, stop, loop, break_loop };
inline constexpr std::size_t functions = 7;
enum class Cause : std::uint8_t {
    termination,
    somebody,
    contract,
    deadline,
    stale,
    hang,
    hang_alone,
    valve_alone,
    supervisor_sleeps
};
inline constexpr std::size_t causes = 9;
enum Slow : std::uint8_t { camera, receiver };

/// The choices of a seed. Times are in ms. Those of users count from their first cycle.
struct Draw {
    std::array<std::array<int, functions>, 2> takes{}; ///< Slow, Function
    struct Ask {
        int at = 0;
        std::size_t activity = 0;
        LifeChange change{};
    };
    std::array<Ask, 4> asks{};
    Cause cause{};
    int cause_at = 0;
};

struct Page : test::WirePage {
    Draw draw{};
    std::atomic<int> on_supervisor{-1}; ///< the Function that ran there
    std::array<std::atomic<int>, 2> initialised{}, finalised{};
    std::atomic<bool> has_stopped{false}; ///< of the valve, by its own stop()
};
inline Page* page = nullptr;
inline MachineInstance* instance = nullptr;

constexpr std::size_t drivers = 0, lamps = 2, receive = 4, look = 5; // activities

struct Valve {
    Input<std::int64_t> beat;
    std::atomic<bool> breaks_contract{false}, takes_long{false};
    os::Clock* clock = nullptr;
    Sentence configure(Setup& setup) {
        clock = setup.clock;
        return {};
    }
    void start(const Cycle&) noexcept TAPPET_REALTIME {
        TAPPET_ESCAPE("a note for the judge", page->wire = 1; page->has_stopped = false);
    }
    void step(const Cycle&) noexcept TAPPET_REALTIME {
        TAPPET_CONTRACT(!breaks_contract.load(), Contract::precondition, 7);
        if (takes_long.exchange(false)) clock->consume(150ms);
    }
    void stop(const Cycle&) noexcept TAPPET_REALTIME {
        TAPPET_ESCAPE("a note for the judge", page->be_safe(); page->has_stopped = true);
    }
    static constexpr auto interface() { return facets(input<&Valve::beat>("beat", "", "of the pulse")); }
};

struct Pulse {
    Output<std::int64_t> beat;
    std::atomic<bool> silent{false}, hangs{false};
    void step(const Cycle&) noexcept TAPPET_REALTIME {
        if (!silent) beat.write(beat.last() + 1);
        while (hangs) TAPPET_ESCAPE("it shall hang, and others have its processor", os::sleep_for(1ms));
    }
    static constexpr auto interface() { return facets(output<&Pulse::beat>("beat", "", "counts")); }
};

/// No row waits for it and no life check watches it, so that only the time limit of its stop reveals that it
/// hangs. Until it is ended, it switches the wire on again and again.
struct Lamp {
    Property<std::int64_t> unused{0};
    std::atomic<bool> hangs_in_stop{false};
    void step(const Cycle&) noexcept TAPPET_REALTIME {}
    void stop(const Cycle&) noexcept TAPPET_REALTIME {
        while (hangs_in_stop) TAPPET_ESCAPE("it shall hang", page->wire = 1; os::sleep_for(1ms));
    }
    static constexpr auto interface() {
        return facets(property<&Lamp::unused>("unused", "", "a component has a facet", range(0, 0)));
    }
};

/// They restart slow activities, and in the end something stops the machine.
struct People {
    Property<std::int64_t> unused{0};
    Time began = never;
    std::array<bool, 4> has_asked{};
    bool is_over = false;
    void work(const Cycle& cycle) {
        if (began == never) began = cycle.now;
        const Draw& draw = page->draw;
        for (std::size_t i = 0; i < draw.asks.size(); ++i)
            if (!has_asked[i] && cycle.now >= began + draw.asks[i].at * 1ms) {
                has_asked[i] = true;
                static_cast<void>(instance->life().ask_activity(draw.asks[i].activity, draw.asks[i].change));
            }
        if (is_over || cycle.now < began + draw.cause_at * 1ms) return;
        is_over = true;
        cause(draw.cause);
        page->asked = to_ns(os::Clock::monotonic());
    }
    static void cause(Cause by) {
        auto& valve = *instance->find<Valve>("valve");
        auto& pulse = *instance->find<Pulse>("pulse");
        switch (by) {
        case Cause::termination: ::kill(::getppid(), SIGTERM); break; // the guardian, which forwards it
        case Cause::somebody: instance->ask_stop(StopReason::requested, 0, nullptr); break;
        case Cause::contract: valve.breaks_contract = true; break;
        case Cause::deadline: valve.takes_long = true; break;
        case Cause::stale: pulse.silent = true; break;
        case Cause::hang: pulse.hangs = true; break;
        case Cause::hang_alone:
            instance->find<Lamp>("lamp")->hangs_in_stop = true;
            static_cast<void>(instance->life().ask_activity(lamps, LifeChange::restart));
            break;
        case Cause::supervisor_sleeps:
            ::syscall(SYS_tgkill, ::getpid(), ::getpid(), SIGRTMIN);
            os::sleep_for(50ms);
            instance->ask_stop(StopReason::requested, 0, nullptr);
            break;
        case Cause::valve_alone:
            static_cast<void>(instance->life().ask_activity(drivers, LifeChange::stop));
            break;
        }
    }
    static constexpr auto interface() {
        return facets(property<&People::unused>("unused", "", "a component has a facet", range(0, 0)));
    }
};

/// Each of its functions takes the time that the seed chose, on any thread; a run on the supervisor's thread
/// is recorded.
template <Slow who>
struct Slowly {
    static void take(Function function) {
        if (::syscall(SYS_gettid) == ::getpid()) page->on_supervisor = static_cast<int>(function);
        const int time = page->draw.takes[who][static_cast<std::size_t>(function)];
        if (time != 0) os::sleep_for(time * 1ms);
    }
    Sentence initialise() {
        take(Function::initialise);
        ++page->initialised[who];
        return {};
    }
    void start(const Cycle&) noexcept TAPPET_REALTIME {
        TAPPET_ESCAPE("it shall block", take(Function::start));
    }
    void stop(const Cycle&) noexcept TAPPET_REALTIME {
        TAPPET_ESCAPE("it shall block", take(Function::stop));
    }
    void finalise() {
        take(Function::finalise);
        ++page->finalised[who];
    }
    static constexpr auto interface() { return std::array<Facet, 0>{}; }
};
struct Camera : Slowly<camera> {
    void work(const Cycle&) { take(Function::work); }
    static constexpr auto interface() { return std::array<Facet, 0>{}; }
};
struct Receiver : Slowly<receiver> {
    void loop(LoopControl& control) {
        take(Function::loop);
        while (control.wait(1h)) {
        }
    }
    void break_loop() { take(Function::break_loop); }
    static constexpr auto interface() { return std::array<Facet, 0>{}; }
};

// clang-format off
inline constexpr auto table = machine("stops",
    components(component<Valve>("valve"), component<Pulse>("pulse"), component<Lamp>("lamp"), component<People>("people"), component<Receiver>("receiver"), component<Camera>("camera")),
    activities(
        activity("drivers", every(100ms), runs("valve"), budget(50us), stop_when_late),
        activity("logic",   every(5ms),   runs("pulse"), budget(50us)),
        activity("lamps",   every(5ms),   not_real_time, runs("lamp")),
        activity("people",  every(5ms),   not_real_time, runs("people")),
        activity("receive", on_work(),    not_real_time, runs("receiver")),
        activity("look",    every(10ms),  not_real_time, runs("camera"))),
    connections(data("pulse.beat", "valve.beat", stale_after(100ms), stop_machine)),
    reactions(), behaviours());
// clang-format on
inline constexpr const Board& board = test::board_of_host;

} // namespace tappet::stops
