// Fixture of script tests: a component with a facet of every kind, two peers of its type, and a script that
// is compiled at run time and executed in its loaded form.
#pragma once

#include "kernel/activity/command_processor.hpp"
#include "kernel/component/operation_interface.hpp"
#include "kernel/program/execution.hpp"
#include "kernel/script/room.hpp"
#include "kernel/statechart/execution.hpp"

#include <array>
#include <cstring>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace script_test {

using namespace tappet;

enum class Mode : std::uint8_t { idle, slow, fast };

struct Position {
    double x = 0;
    double y = 0;
    std::int32_t turns = 0;
};

} // namespace script_test

template <>
inline constexpr auto tappet::names_of<script_test::Mode> =
    std::array<std::string_view, 3>{"idle", "slow", "fast"};
template <>
inline constexpr auto tappet::fields_of<script_test::Position> =
    tappet::fields(tappet::field<&script_test::Position::x>("x"),
                   tappet::field<&script_test::Position::y>("y"),
                   tappet::field<&script_test::Position::turns>("turns"));

namespace script_test {

using Name = Text<12>;

/// Keeps a trace of its calls, so that a test reads like the executed script.
struct Cell {
    Property<double> gain{1.0};
    Property<Mode> mode{Mode::idle};
    Property<std::int16_t> narrow{7};
    Output<double> speed;
    Output<std::uint8_t> small;
    Output<Position> aim;
    Event<> startMovement, startCalibration, startLocalisation, halt, lineRises;
    Event<double> moveCamera;
    Event<std::int32_t, Position> seen;
    std::string trace;
    std::int64_t axes = 3;
    bool rejects = false;
    bool fails = false;
    int steps_to_go = 0;
    int calibrations = 0;
    bool located = true;

    // Only tests call these, and they may allocate.
    void say(const auto&... parts) noexcept TAPPET_REALTIME {
        TAPPET_ESCAPE("a trace of the test", trace += trace.empty() ? "" : " "; (add(parts), ...));
    }
    void add(std::string_view word) { trace += word; }
    void add(std::int64_t number) { trace += std::to_string(number); }
    bool setParameter(const Name& name, double value) noexcept TAPPET_REALTIME {
        say(name.view(), "=", static_cast<std::int64_t>(value));
        return true;
    }
    void note(std::int64_t value) noexcept TAPPET_REALTIME { say(value); }
    std::int32_t totalAxes() noexcept TAPPET_REALTIME { return static_cast<std::int32_t>(axes); }
    bool isTrue(bool value) noexcept TAPPET_REALTIME {
        say(value ? "yes" : "no");
        return value;
    }
    bool refuse() noexcept TAPPET_REALTIME { return false; }
    bool isCalibrated() noexcept TAPPET_REALTIME { return calibrations > 0; }
    bool carLocated() noexcept TAPPET_REALTIME { return located; }
    double carLocation() noexcept TAPPET_REALTIME { return 0.5; }
    double getPosition() noexcept TAPPET_REALTIME { return 10; }
    Position whereabouts() noexcept TAPPET_REALTIME { return {1, 2, 3}; }
    void disableAxis(std::int32_t axis) noexcept TAPPET_REALTIME { say("disable", axis); }
    void beep(std::int32_t times) noexcept TAPPET_REALTIME { say("beep", times); }

    bool begin_move(double axis, double velocity, double position) noexcept TAPPET_REALTIME {
        if (rejects) return false;
        say("move", static_cast<std::int64_t>(axis * 100 + velocity * 10 + position));
        return true;
    }
    bool begin_simple() noexcept TAPPET_REALTIME {
        if (rejects) return false;
        say("begin");
        return true;
    }
    bool begin_to(double to) noexcept TAPPET_REALTIME {
        if (rejects) return false;
        say("to", static_cast<std::int64_t>(to * 10));
        return true;
    }
    CommandProgress progress() noexcept TAPPET_REALTIME {
        if (fails) return CommandProgress::failed;
        if (steps_to_go == 0) {
            say("end");
            return CommandProgress::done;
        }
        --steps_to_go;
        return CommandProgress::executing;
    }
    CommandProgress calibrated() noexcept TAPPET_REALTIME {
        ++calibrations;
        return CommandProgress::done;
    }
    bool begin_measure(std::int32_t samples, std::int32_t& taken, double&) noexcept TAPPET_REALTIME {
        taken = samples;
        return !rejects;
    }
    CommandProgress measured(std::int32_t, std::int32_t&, double& mean) noexcept TAPPET_REALTIME {
        if (steps_to_go-- > 0) return CommandProgress::executing;
        mean = 2.5;
        return CommandProgress::done;
    }

    static constexpr auto interface() {
        return facets(
            property<&Cell::gain>("gain", "", "within bounds", range(0, 10)),
            property<&Cell::mode>("mode", "", "an enumeration"),
            property<&Cell::narrow>("narrow", "", "16 bits"), output<&Cell::speed>("speed", "", "a real"),
            output<&Cell::small>("small", "", "8 bits"), output<&Cell::aim>("aim", "", "a record"),
            event<&Cell::startMovement>("startMovement", "to a position"),
            event<&Cell::startCalibration>("startCalibration", "the panel asks for it"),
            event<&Cell::startLocalisation>("startLocalisation", "the panel asks for it"),
            event<&Cell::lineRises>("line.rises", "as a driver names it"),
            event<&Cell::halt>("halt", "nothing goes on"),
            event<&Cell::moveCamera>("moveCamera", "with a target"),
            event<&Cell::seen>("seen", "with a number and a place"),
            method<&Cell::setParameter>("setParameter", "takes a number"),
            method<&Cell::note>("note", "writes a number down"),
            method<&Cell::totalAxes>("totalAxes", "how many there are"),
            method<&Cell::isTrue>("isTrue", "answers what it is asked"),
            method<&Cell::refuse>("refuse", "says no"),
            method<&Cell::isCalibrated>("isCalibrated", "every axis is", any_thread),
            method<&Cell::carLocated>("carLocated", "the car is seen", any_thread),
            method<&Cell::carLocation>("carLocation", "where the car is seen", any_thread),
            method<&Cell::getPosition>("getPosition", "of the camera", any_thread),
            method<&Cell::whereabouts>("whereabouts", "a record"),
            method<&Cell::disableAxis>("disableAxis", "one of them"), operation<&Cell::beep>("beep", "once"),
            operation<&Cell::beep>("line.beep", "as a driver names it"),
            command<&Cell::begin_move, &Cell::progress>("moveAxis", "one of them, so far"),
            command<&Cell::begin_to, &Cell::progress>("moveTo", "a position"),
            command<&Cell::begin_simple, &Cell::progress>("fetchImage", "the next one"),
            command<&Cell::begin_simple, &Cell::progress>("processImage", "the last one"),
            command<&Cell::begin_simple, &Cell::progress>("go", "moves on"),
            command<&Cell::begin_simple, &Cell::calibrated>("calibrate", "every axis"),
            command<&Cell::begin_measure, &Cell::measured>("measure", "gives a result"));
    }
};

/// Large enough for every script of these tests; in the firmware a slot has its own sizes.
inline constexpr ScriptSizes buffer_sizes = script_sizes_for(512, 16384, 8);

/// Calls compile_into() in a single translation unit.
ScriptOutcome compile(std::string_view text, std::string_view name, const Reach& reach,
                      const ScriptRoom& room);

/// "own" drives; "robot" runs in its activity; "far" runs in another one.
std::span<const Reachable> components();

/// The fault of a refused script; empty: it is accepted.
std::string fault_of(std::string_view text, std::uint32_t statements_per_step = 0);

/// A script with its components, its links bound, and an engine of its own for every command slot.
class Played {
public:
    explicit Played(std::string_view text, std::uint32_t statements_per_step = 0);
    ~Played();
    Played(const Played&) = delete;
    Played& operator=(const Played&) = delete;

    Cell own, robot, far;
    ScriptOutcome outcome;

    /// One step of everything: programs, then started machines; time advances by 10 ms.
    void step();
    void steps(int n) {
        for (int i = 0; i < n; ++i) step();
    }
    /// Simulates a stop of that component.
    void stop_far();
    /// The first program.
    ProgramExecution& program();
    /// A machine by its instance's name.
    StateMachineExecution& machine(std::string_view name);
    std::string state(std::string_view name);
    /// An event by the name used in transitions, with its arguments packed.
    template <class... A>
    StateOutcome event(std::string_view machine_name, std::string_view event_name, const A&... arguments) {
        std::vector<std::byte> packed;
        (append(packed, &arguments, sizeof arguments), ...);
        packed.resize(packed.size() + 1);
        return dispatch(machine_name, event_name, packed.data());
    }
    /// A variable in the data of an instance.
    template <class T>
    T get(std::string_view instance, std::string_view variable) {
        T value{};
        std::memcpy(static_cast<void*>(&value), variable_at(instance, variable), sizeof value);
        return value;
    }
    template <class T>
    void set(std::string_view instance, std::string_view variable, const T& value) {
        std::memcpy(variable_at(instance, variable), static_cast<const void*>(&value), sizeof value);
    }
    [[nodiscard]] Time now() const { return now_; }

private:
    static void append(std::vector<std::byte>& to, const void* from, std::size_t bytes) {
        const auto* begin = static_cast<const std::byte*>(from);
        to.insert(to.end(), begin, begin + bytes);
    }
    StateOutcome dispatch(std::string_view machine_name, std::string_view event_name,
                          const std::byte* packed);
    std::byte* variable_at(std::string_view instance, std::string_view variable);

    struct Parts;
    std::unique_ptr<Parts> parts_;
    Time now_ = at_ns(0);
};

/// The same, with one machine started.
class Started : public Played {
public:
    explicit Started(std::string_view text, std::string_view name = "M") : Played{text} {
        static_cast<void>(machine(name).start(now()));
    }
};

} // namespace script_test
