// SPDX-License-Identifier: Apache-2.0
// The adversary in real time: seed after seed, a firmware in its two processes, whose user functions take
// their time while users restart its activities and something requests the stop. Rules judge from outside.
#include "kernel/base/random.hpp"
#include "kernel/machine/accept.hpp"
#include "kernel/os/arming.hpp"
#include "kernel/os/terminal.hpp"
#include "tests/adversary/stops/machine.hpp"
#include "toolchain/machine/swarm_options.hpp"

#include <new>

#include <sys/wait.h>

namespace tappet::stops {
namespace {

constexpr std::array options{
    Option{.name = "--working",
           .value = "N",
           .help = "N seconds of processor time (default 60)",
           .is_number = true,
           .least = 1},
    swarm_options::findings,
    swarm_options::from,
    swarm_options::step,
    Option{.name = "--seed", .value = "SEED", .help = "this one only", .is_number = true},
    swarm_options::help};
enum Ending : int { none_broken = 0, one_broken = 1, wrong_words = 2 };

constexpr std::array<std::string_view, functions> function_names{
    "initialise", "finalise", "start", "work", "stop", "loop", "break_loop"};
constexpr std::array<std::string_view, causes> cause_names{"SIGTERM",
                                                           "somebody asks",
                                                           "a contract breaks",
                                                           "a deadline is missed",
                                                           "a row grows stale",
                                                           "a real-time activity hangs",
                                                           "an activity that is restarted hangs",
                                                           "the drivers are stopped alone",
                                                           "somebody asks while its supervisor sleeps"};
constexpr auto supervisor_sleeps_for = 1700ms; // its life is missed after 2 s
static_assert(board.stop_within < supervisor_sleeps_for);

Draw draw_of(std::uint64_t seed) {
    Random random{seed};
    Draw draw;
    constexpr int longest_start = 350; // RealWorld::patience_ms, on a busy host
    const bool only_makers = random.one_in(2);
    for (auto& component : draw.takes)
        for (std::size_t f = 0; f < functions; ++f)
            if (random.one_in(5) && (!only_makers || f <= static_cast<std::size_t>(Function::finalise)))
                component[f] = static_cast<int>(random.between(
                    20, f == static_cast<std::size_t>(Function::start) ? longest_start : 2500));
    for (Draw::Ask& each : draw.asks)
        each = {static_cast<int>(random.between(0, 600)), random.one_in(2) ? look : receive,
                random.one_in(3)   ? LifeChange::stop
                : random.one_in(2) ? LifeChange::start
                                   : LifeChange::restart};
    draw.cause = static_cast<Cause>(seed % causes);
    draw.cause_at = static_cast<int>(random.between(150, 700));
    return draw;
}

Sentence described(const Draw& draw) {
    Sentence text{cause_names[static_cast<std::size_t>(draw.cause)], " after ", std::int64_t{draw.cause_at},
                  " ms"};
    for (std::size_t who = 0; who < 2; ++who)
        for (std::size_t f = 0; f < functions; ++f)
            if (draw.takes[who][f] != 0)
                text.add(who == camera ? "; camera " : "; receiver ")
                    .add(function_names[f])
                    .add(" takes ")
                    .add(std::int64_t{draw.takes[who][f]});
    return text;
}

/// Longest time from the cause until it is noticed.
Duration noticed_within(Cause cause) {
    switch (cause) {
    case Cause::contract: return 100ms; // a period of the drivers
    case Cause::deadline: return 250ms; // and the slow cycle
    case Cause::stale:
    case Cause::hang: return 110ms;         // the row's age
    case Cause::hang_alone: return 10100ms; // RealWorld::patience_beside_ms
    case Cause::termination:
    case Cause::somebody:
    case Cause::supervisor_sleeps:
    case Cause::valve_alone: break;
    }
    return {};
}

/// No thread was blocked: the machine executes its stop itself.
bool is_for_machine(const Draw& draw) {
    if (draw.cause == Cause::hang || draw.cause == Cause::hang_alone ||
        draw.cause == Cause::supervisor_sleeps)
        return false;
    for (const auto& component : draw.takes)
        for (const Function f :
             {Function::start, Function::work, Function::stop, Function::loop, Function::break_loop})
            if (component[static_cast<std::size_t>(f)] != 0) return false;
    return true;
}

template <class Condition> bool becomes(Condition condition, Duration within) {
    const Time end = os::Clock::monotonic() + within;
    bool is_so = condition();
    for (; !is_so && os::Clock::monotonic() < end; is_so = condition()) os::sleep_for(1ms);
    return is_so;
}

std::uint64_t not_started = 0; ///< seeds without an observed stop

/// Empty: all rules held.
Sentence judge(pid_t guardian, const Draw& draw) {
    constexpr Duration busy_host = 250ms, longest_makers = 20s;
    int status = 0;
    bool has_ended = false;
    if (!becomes(
            [&] {
                has_ended = ::waitpid(guardian, &status, WNOHANG) == guardian;
                return has_ended || page->asked != 0;
            },
            longest_makers))
        return Sentence{"its people do not come to their turn"};
    if (has_ended && page->asked == 0) { // the host was so busy that an activity came too late
        ++not_started;
        return page->wire == 0 ? Sentence{} : Sentence{"it did not start, and its outputs are not safe"};
    }
    const Duration bound = noticed_within(draw.cause) + board.stop_within + busy_host;
    const Time asked = at_ns(page->asked);
    Time unsafe_at = asked;
    bool may_end = draw.cause != Cause::valve_alone;
    const auto ends = [&] {
        const Time now = os::Clock::monotonic();
        if (page->wire != 0) unsafe_at = now;
        if (!may_end && now > asked + bound) {
            may_end = true;
            ::kill(guardian, SIGTERM);
        }
        return has_ended = has_ended || ::waitpid(guardian, &status, WNOHANG) == guardian;
    };
    static_cast<void>(becomes(ends, bound + longest_makers));
    if (unsafe_at > asked + bound)
        return Sentence{"its outputs were not safe ", (unsafe_at - asked) / 1ms,
                        " ms after the cause of the stop, and ", bound / 1ms, " ms are allowed"};
    if (!has_ended) return Sentence{"it does not end"};
    if (page->wire != 0) return Sentence{"its outputs did not stay safe"};
    if (const int ran = page->on_supervisor; ran >= 0)
        return Sentence{function_names[static_cast<std::size_t>(ran)],
                        "() of a component ran on the thread that executes stops"};
    if (!is_for_machine(draw)) return {};
    if (!page->has_stopped) return Sentence{"its valve left no safe values by itself"};
    if (page->by_guardian != 0 && draw.cause != Cause::contract) // a broken contract may have broken anything
        return Sentence{"its guardian had to act, though no thread was held up"};
    for (std::size_t who = 0; who < 2; ++who)
        if (page->initialised[who] != page->finalised[who])
            return Sentence{"what was initialised was not finalised"};
    return {};
}

Sentence run(std::uint64_t seed) {
    page = new (page) Page;
    page->draw = draw_of(seed);
    const pid_t guardian = ::fork();
    if (guardian == 0) {
        ::setpgid(0, 0);
        test::be_firmware(AtRunTime<table, test::board_of_host>::machine(), *page,
                          {.configured = [](MachineInstance& configured) {
                              instance = &configured;
                              ::signal(SIGRTMIN, [](int) { os::sleep_for(supervisor_sleeps_for); });
                          }});
    }
    ::setpgid(guardian, guardian);
    const Sentence broken = judge(guardian, page->draw);
    ::kill(-guardian, SIGKILL);
    int status = 0;
    ::waitpid(guardian, &status, 0); // nothing to wait for when the judge has seen its end
    return broken;
}

int hunt(int count, char** words) {
    const std::vector<std::string_view> all(words + 1, words + count);
    const auto given = read_command_line(options, all, Others::refused);
    if (!given) {
        static_cast<void>(os::write_all(2, Sentence{"stops swarm: ", given.error(), "\n"}.view()));
        return wrong_words;
    }
    if (given->has("--help")) {
        os::print("a machine whose makers' functions take their time while it is stopped, in real time\n");
        os::print(usage_of(options));
        return none_broken;
    }
    if (os::observe_process(board.highest_priority).fifo_error != 0) {
        static_cast<void>(os::write_all(2, "stops swarm: SCHED_FIFO is not granted here; run as root\n"));
        return wrong_words;
    }
    page = test::shared_page<Page>();
    const Time end = os::Clock::monotonic() + given->number("--working", 60) * Duration{1s};
    std::uint64_t seed = given->number(given->has("--seed") ? "--seed" : "--from", 1), seeds = 0, broken = 0;
    do {
        if (const Sentence what = run(seed); !what.empty()) {
            ++broken;
            os::print(Sentence{"stops: seed ", seed, " at ", to_ns(os::Clock::monotonic()) / 1000,
                               " us: ", what, " (", described(page->draw), "); replay it: ", words[0],
                               " --seed ", seed, "\n"}
                          .view());
        }
        ++seeds;
        seed += given->number("--step", 1);
    } while (!given->has("--seed") && os::Clock::monotonic() < end &&
             broken < given->number("--findings", swarm_options::usual_findings));
    os::print(
        Sentence{"stops: ", seeds, " seeds, ", not_started, " not started, ", broken, " broken\n"}.view());
    return broken == 0 && not_started < seeds ? none_broken : one_broken;
}

} // namespace
} // namespace tappet::stops

int main(int count, char** words) { return tappet::stops::hunt(count, words); }
