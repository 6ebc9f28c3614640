// The functions of a component's life: the spelling of each, and the names that were probably meant as one. A
// member that is spelled otherwise would never run, so the table's check refuses it.
#pragma once

#include "kernel/component/cycle.hpp"
#include "kernel/component/interface.hpp"
#include "kernel/component/loop.hpp"
#include "kernel/component/proposal.hpp"
#include "kernel/component/setup.hpp"

#include <concepts>
#include <span>
#include <string_view>
#include <type_traits>

namespace tappet {

/// A member that looks like a function of its component's life and would never run.
struct NeverRun {
    std::string_view member{};   ///< empty: there is none
    std::string_view spelling{}; ///< spelling of the function that was probably meant
};

// clang-format off
/// Name, parameters, requirement on a call, spelling.
#define TAPPET_LIFE_FUNCTIONS(X) \
    X(configure,  (T & t, Setup& s),               { t.configure(s) } -> std::same_as<Sentence>,        "Sentence configure(Setup&)") \
    X(initialise, (T & t),                         { t.initialise() } -> std::same_as<Sentence>,        "Sentence initialise()") \
    X(start,      (T & t, const Cycle& c),         { t.start(c) } noexcept -> std::same_as<void>,       "void start(const Cycle&) noexcept TAPPET_REALTIME") \
    X(step,       (T & t, const Cycle& c),         { t.step(c) } noexcept -> std::same_as<void>,        "void step(const Cycle&) noexcept TAPPET_REALTIME") \
    X(work,       (T & t, const Cycle& c),         { t.work(c) } -> std::same_as<void>,                 "void work(const Cycle&)") \
    X(accepts,    (const T& t, const Proposal& p), { t.accepts(p) } noexcept -> std::same_as<Sentence>, "Sentence accepts(const Proposal&) const noexcept TAPPET_REALTIME") \
    X(changed,    (T & t),                         { t.changed() } noexcept -> std::same_as<void>,      "void changed() noexcept TAPPET_REALTIME") \
    X(loop,       (T & t, LoopControl& l),         { t.loop(l) } -> std::same_as<void>,                 "void loop(LoopControl&)") \
    X(break_loop, (T & t),                         { t.break_loop() } -> std::same_as<void>,            "void break_loop()") \
    X(stop,       (T & t, const Cycle& c),         { t.stop(c) } noexcept -> std::same_as<void>,        "void stop(const Cycle&) noexcept TAPPET_REALTIME") \
    X(stopped_safely, (const T& t),                { t.stopped_safely() } noexcept -> std::same_as<bool>, "bool stopped_safely() const noexcept TAPPET_REALTIME") \
    X(finalise,   (T & t),                         { t.finalise() } -> std::same_as<void>,              "void finalise()")

/// Names that mean nothing else: two characters exchanged, one omitted or doubled, or the same word in
/// another spelling.
#define TAPPET_MISSPELT_LIFE_FUNCTIONS(X) \
    X(confgiure, configure) X(configrue, configure) X(configuer, configure) X(confiugre, configure) \
    X(cofnigure, configure) X(conifgure, configure) X(ocnfigure, configure) X(confgure, configure) \
    X(configre, configure) X(cofigure, configure) X(conigure, configure) X(confiure, configure) \
    X(initialize, initialise) X(intialise, initialise) X(initalise, initialise) X(initilaise, initialise) \
    X(initialsie, initialise) X(initialies, initialise) X(initiailse, initialise) \
    X(intiialise, initialise) X(initiaise, initialise) X(intialize, initialise) X(initalize, initialise) \
    X(satrt, start) X(strat, start) X(statr, start) X(tsart, start) X(sart, start) X(strt, start) \
    X(startt, start) X(sttart, start) X(staart, start) \
    X(setp, step) X(stpe, step) X(tsep, step) X(stp, step) X(stepp, step) X(sttep, step) \
    X(wrok, work) X(wokr, work) X(owrk, work) X(wrk, work) X(workk, work) \
    X(acepts, accepts) X(accpets, accepts) X(accetps, accepts) X(accepst, accepts) X(acceps, accepts) \
    X(acecpts, accepts) X(acccepts, accepts) \
    X(chnaged, changed) X(chagned, changed) X(chanegd, changed) X(changde, changed) X(hcanged, changed) \
    X(cahnged, changed) X(chaged, changed) X(chaned, changed) X(changd, changed) \
    X(lopo, loop) X(olop, loop) X(looop, loop) X(lloop, loop) \
    X(breakLoop, break_loop) X(breakloop, break_loop) X(brake_loop, break_loop) X(braek_loop, break_loop) \
    X(berak_loop, break_loop) X(breka_loop, break_loop) X(rbeak_loop, break_loop) \
    X(break_lopo, break_loop) X(break_olop, break_loop) X(break_lop, break_loop) X(brek_loop, break_loop) \
    X(sotp, stop) X(stpo, stop) X(tsop, stop) X(sttop, stop) X(stopp, stop) X(stoop, stop) \
    X(finalize, finalise) X(fianlise, finalise) X(finlaise, finalise) X(finailse, finalise) \
    X(finalsie, finalise) X(finalies, finalise) X(ifnalise, finalise) X(finalse, finalise) \
    X(fnalise, finalise) X(finalyse, finalise) X(finnalise, finalise)

/// Names that may mean anything: a member counts as misspelt only if anybody could call it as that function.
#define TAPPET_OTHERWISE_NAMED_LIFE_FUNCTIONS(X) \
    X(on_start,      (T & t, const Cycle& c),         { t.on_start(c) } -> std::same_as<void>,         start) \
    X(starts,        (T & t, const Cycle& c),         { t.starts(c) } -> std::same_as<void>,           start) \
    X(started,       (T & t, const Cycle& c),         { t.started(c) } -> std::same_as<void>,          start) \
    X(Start,         (T & t, const Cycle& c),         { t.Start(c) } -> std::same_as<void>,            start) \
    X(start_up,      (T & t, const Cycle& c),         { t.start_up(c) } -> std::same_as<void>,         start) \
    X(begin,         (T & t, const Cycle& c),         { t.begin(c) } -> std::same_as<void>,            start) \
    X(on_step,       (T & t, const Cycle& c),         { t.on_step(c) } -> std::same_as<void>,          step) \
    X(steps,         (T & t, const Cycle& c),         { t.steps(c) } -> std::same_as<void>,            step) \
    X(Step,          (T & t, const Cycle& c),         { t.Step(c) } -> std::same_as<void>,             step) \
    X(do_step,       (T & t, const Cycle& c),         { t.do_step(c) } -> std::same_as<void>,          step) \
    X(run,           (T & t, const Cycle& c),         { t.run(c) } -> std::same_as<void>,              step) \
    X(update,        (T & t, const Cycle& c),         { t.update(c) } -> std::same_as<void>,           step) \
    X(tick,          (T & t, const Cycle& c),         { t.tick(c) } -> std::same_as<void>,             step) \
    X(cycle,         (T & t, const Cycle& c),         { t.cycle(c) } -> std::same_as<void>,            step) \
    X(execute,       (T & t, const Cycle& c),         { t.execute(c) } -> std::same_as<void>,          step) \
    X(do_work,       (T & t, const Cycle& c),         { t.do_work(c) } -> std::same_as<void>,          step) \
    X(on_stop,       (T & t, const Cycle& c),         { t.on_stop(c) } -> std::same_as<void>,          stop) \
    X(stops,         (T & t, const Cycle& c),         { t.stops(c) } -> std::same_as<void>,            stop) \
    X(stopped,       (T & t, const Cycle& c),         { t.stopped(c) } -> std::same_as<void>,          stop) \
    X(Stop,          (T & t, const Cycle& c),         { t.Stop(c) } -> std::same_as<void>,             stop) \
    X(halt,          (T & t, const Cycle& c),         { t.halt(c) } -> std::same_as<void>,             stop) \
    X(shutdown,      (T & t, const Cycle& c),         { t.shutdown(c) } -> std::same_as<void>,         stop) \
    X(shut_down,     (T & t, const Cycle& c),         { t.shut_down(c) } -> std::same_as<void>,        stop) \
    X(config,        (T & t, Setup& s),               { t.config(s) } -> std::same_as<Sentence>,       configure) \
    X(Configure,     (T & t, Setup& s),               { t.Configure(s) } -> std::same_as<Sentence>,    configure) \
    X(on_configure,  (T & t, Setup& s),               { t.on_configure(s) } -> std::same_as<Sentence>, configure) \
    X(setup,         (T & t, Setup& s),               { t.setup(s) } -> std::same_as<Sentence>,        configure) \
    X(set_up,        (T & t, Setup& s),               { t.set_up(s) } -> std::same_as<Sentence>,       configure) \
    X(init,          (T & t),                         { t.init() } -> std::same_as<Sentence>,          initialise) \
    X(on_init,       (T & t),                         { t.on_init() } -> std::same_as<Sentence>,       initialise) \
    X(Initialise,    (T & t),                         { t.Initialise() } -> std::same_as<Sentence>,    initialise) \
    X(on_initialise, (T & t),                         { t.on_initialise() } -> std::same_as<Sentence>, initialise) \
    X(accept,        (const T& t, const Proposal& p), { t.accept(p) } -> std::same_as<Sentence>,       accepts) \
    X(check,         (const T& t, const Proposal& p), { t.check(p) } -> std::same_as<Sentence>,        accepts) \
    X(validate,      (const T& t, const Proposal& p), { t.validate(p) } -> std::same_as<Sentence>,     accepts) \
    X(Accepts,       (const T& t, const Proposal& p), { t.Accepts(p) } -> std::same_as<Sentence>,      accepts) \
    X(Loop,          (T & t, LoopControl& l),         { t.Loop(l) } -> std::same_as<void>,             loop) \
    X(run_loop,      (T & t, LoopControl& l),         { t.run_loop(l) } -> std::same_as<void>,         loop) \
    X(main_loop,     (T & t, LoopControl& l),         { t.main_loop(l) } -> std::same_as<void>,        loop)
// clang-format on

namespace detail {

// The items of a requires-expression cannot be put in parentheses.
// NOLINTBEGIN(bugprone-macro-parentheses)
#define TAPPET_X(name, parameters, call, spelling)                                                           \
    template <class T>                                                                                       \
    concept life_##name =                                                                                    \
        requires parameters                                                                                  \
    {                                                                                                        \
        call;                                                                                                \
    };                                                                                                       \
    inline constexpr std::string_view spelling_of_##name = spelling;
TAPPET_LIFE_FUNCTIONS(TAPPET_X)
#undef TAPPET_X

struct LifeNames {
#define TAPPET_X(name, ...) char name;
    TAPPET_LIFE_FUNCTIONS(TAPPET_X)
    TAPPET_MISSPELT_LIFE_FUNCTIONS(TAPPET_X)
    TAPPET_OTHERWISE_NAMED_LIFE_FUNCTIONS(TAPPET_X)
#undef TAPPET_X
};

/// A name of LifeNames is ambiguous in it when T has a member of that name, of any kind, overloaded or
/// private.
template <class T>
struct WithLifeNames : T, LifeNames {};

template <class T>
concept runs_each_cycle = life_step<T> || life_work<T> || life_loop<T>;

template <class T>
constexpr NeverRun first_never_run(std::span<const Facet> facets) {
    static_assert(!std::is_final_v<T>,
                  "a component is not final: its functions are looked for in a type derived from it");
    using Probe = WithLifeNames<T>;
#define TAPPET_X(name, ...)                                                                                  \
    if constexpr (!requires { &Probe::name; } && !life_##name<T>) return {#name, spelling_of_##name};
    TAPPET_LIFE_FUNCTIONS(TAPPET_X)
#undef TAPPET_X
#define TAPPET_X(name, ...) &Probe::name;
    // First all at once, because hardly any component has one of them.
    constexpr bool none_is_misspelt = requires { TAPPET_MISSPELT_LIFE_FUNCTIONS(TAPPET_X) };
    constexpr bool none_is_otherwise_named = requires { TAPPET_OTHERWISE_NAMED_LIFE_FUNCTIONS(TAPPET_X) };
#undef TAPPET_X
    if constexpr (!none_is_misspelt) {
#define TAPPET_X(name, life)                                                                                 \
    if constexpr (!requires { &Probe::name; }) return {#name, spelling_of_##life};
        TAPPET_MISSPELT_LIFE_FUNCTIONS(TAPPET_X)
#undef TAPPET_X
    }
    if constexpr (!none_is_otherwise_named) {
        const auto has_timer = [facets](const TimerOperations* of) {
            for (const Facet& each : facets)
                if (each.timer == of) return true;
            return false;
        };
#define TAPPET_X(name, parameters, call, life)                                                               \
    if constexpr (!life_##life<T> && !(std::string_view{#life} == "step" && runs_each_cycle<T>) &&           \
                  requires parameters { call; }) {                                                           \
        bool is_named = false;                                                                               \
        if constexpr (requires { TimerCall<&T::name>::operations; })                                         \
            is_named = has_timer(&TimerCall<&T::name>::operations);                                          \
        if (!is_named) return {#name, spelling_of_##life};                                                   \
    }
        TAPPET_OTHERWISE_NAMED_LIFE_FUNCTIONS(TAPPET_X)
#undef TAPPET_X
        // NOLINTEND(bugprone-macro-parentheses)
    }
    return {};
}

} // namespace detail

} // namespace tappet
