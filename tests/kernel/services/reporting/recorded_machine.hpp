// A machine whose values are recorded in every mode of a row, and which knows the expected values.
#pragma once

#include "kernel/services/reporting/reporting.hpp"
#include "tests/kernel/machine/virtual_rig.hpp"

#include <array>
#include <cmath>
#include <vector>

namespace tappet::recorded_test {

enum class Mode : std::uint8_t { resting, moving };

struct Pose {
    double x = 0.0;
    std::int16_t turns = 0;
};

} // namespace tappet::recorded_test

template <>
inline constexpr auto tappet::names_of<tappet::recorded_test::Mode> =
    std::array<std::string_view, 2>{"resting", "moving"};
template <>
inline constexpr auto tappet::fields_of<tappet::recorded_test::Pose> =
    std::array{tappet::field<&tappet::recorded_test::Pose::x>("x", "mm"),
               tappet::field<&tappet::recorded_test::Pose::turns>("turns", "")};

namespace tappet::recorded_test {

/// Its position is the number of its step.
struct Axis {
    Output<double> position;
    Output<float> force;
    Output<Mode> mode;
    Output<Pose> pose;
    Output<double> pull;
    double pulls = 1.0;        ///< set by the test
    Output<std::int32_t> late; ///< written from its third step on
    Property<double> gain{1.0};
    Property<Text<12>> label{"axis"};
    Property<Duration> filter{4ms};
    Event<> missed;
    std::int64_t steps = 0;
    std::int64_t misses_at = 0; ///< the step that misses; 0: none
    void step(const Cycle&) noexcept TAPPET_REALTIME {
        ++steps;
        position.write(0.25 * static_cast<double>(steps));
        force.write(static_cast<float>(steps % 100) * 0.125f);
        pull.write(pulls);
        mode.write(steps / 10 % 2 == 0 ? Mode::resting : Mode::moving);
        pose.write({1.5 * static_cast<double>(steps), static_cast<std::int16_t>(-steps)});
        if (steps >= 3) late.write(static_cast<std::int32_t>(-steps));
        if (steps == misses_at) missed();
    }
    void stop(const Cycle&) noexcept TAPPET_REALTIME { mode.write(Mode::resting); }
    static constexpr auto interface() {
        return facets(
            output<&Axis::position>("position", "mm", "of the slide"),
            output<&Axis::force>("force", "N", "on it"), output<&Axis::pull>("pull", "N", "by the test"),
            output<&Axis::mode>("mode", "", "what it does"), output<&Axis::pose>("pose", "", "where it is"),
            output<&Axis::late>("late", "", "after a while"),
            property<&Axis::gain>("gain", "1/s", "of its loop", range(0, 1e9)),
            property<&Axis::label>("label", "", "on its plate"),
            property<&Axis::filter>("filter", "s", "of what is measured", range(0, 1)),
            event<&Axis::missed>("missed", "it did not get there"));
    }
};

struct Press {
    Output<std::int64_t> strokes;
    Output<bool> closed;
    void step(const Cycle&) noexcept TAPPET_REALTIME {
        strokes.write(strokes.last() + 1);
        closed.write(strokes.last() % 2 == 1);
    }
    static constexpr auto interface() {
        return facets(output<&Press::strokes>("strokes", "", "so far"),
                      output<&Press::closed>("closed", "", "it is"));
    }
};

template <class... Extra>
constexpr auto machine_with(const Extra&... extra) {
    return machine(
        "shop", components(component<Axis>("axis"), component<Press>("press"), component<Onlooker>("window")),
        activities(activity("motion", every(1ms), budget(100us), runs("axis")),
                   activity("slow", every(5ms), budget(100us), runs("press")),
                   activity("background", every(20ms), not_real_time, runs("window"))),
        connections(), reactions(), behaviours(), extra...);
}

template <const auto& table>
struct Rig : ConfiguredRig<table> {
    Axis* axis = &this->template the<Axis>("axis");

    [[nodiscard]] bool start() { return this->world.start().empty(); }
};

} // namespace tappet::recorded_test
