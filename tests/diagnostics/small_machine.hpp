// A small machine that compiles. Each case of tests/diagnostics/cases replaces one section of it by a faulty
// one, each row of tests/diagnostics/rows a row.
#pragma once

#include "drivers/can/kind.hpp"
#include "drivers/gpio/kind.hpp"
#include "drivers/modbus/kind.hpp"
#include "kernel/machine/firmware.hpp"

namespace small {

using namespace tappet;

struct Encoder {
    static constexpr const DeviceKind& device_kind = can::device_kind;
    static constexpr bool woken_by_device = true;
    static constexpr int device_map = 0;
    Output<double> angle;
    Output<int> turns;
    BufferOutput<int> samples;
    Event<double> index;
    void step(const Cycle&) noexcept TAPPET_REALTIME { angle.write(1.0); }
    static constexpr auto interface() {
        return facets(output<&Encoder::angle>("angle", "deg", "of the shaft"),
                      output<&Encoder::turns>("turns", "", "since the start"),
                      output<&Encoder::samples>("samples", "", "raw"),
                      event<&Encoder::index>("index", "the index mark passed, at this angle"));
    }
};

enum class Turn { left, right };

struct Axis {
    Property<double> low{0.0};
    Property<double> high{1.0};
    static constexpr auto interface() {
        return facets(property<&Axis::low>("low", "deg", "from here", range(0, 360)),
                      property<&Axis::high>("high", "deg", "to there", range(0, 360)));
    }
};

struct Shaft {
    Input<double> measured;
    Input<double> reference;
    BufferInput<int> samples;
    Output<double> speed;
    Event<> window;
    Event<> wrapped;
    Property<double> gain{1.0};
    Property<bool> reversed{false};
    Property<Duration> filter{1ms};
    Property<std::int8_t> teeth{60};
    Property<Text<8>> label{"main"};
    Property<Turn> turn{Turn::left};
    Property<Sequence<double, 3>> offsets;
    Axis window_axis;
    void on_index(double) noexcept TAPPET_REALTIME {}
    void clear() noexcept TAPPET_REALTIME {}
    static constexpr auto interface() {
        return facets(input<&Shaft::measured>("measured", "", "by the encoder"),
                      input<&Shaft::reference>("reference", "", "where it shall be", optional),
                      input<&Shaft::samples>("samples", "", "raw", optional),
                      output<&Shaft::speed>("speed", "rpm", "filtered"),
                      event<&Shaft::window>("window", "the weft may be released"),
                      event<&Shaft::wrapped>("wrapped", "at zero"),
                      operation<&Shaft::on_index>("on_index", "corrects the angle", required),
                      operation<&Shaft::clear>("clear", "forgets the turns"),
                      property<&Shaft::gain>("gain", "", "of the estimator", range(0, 10)),
                      property<&Shaft::reversed>("reversed", "", "mounted the other way round"),
                      property<&Shaft::filter>("filter", "s", "time constant", range(0, 0.5)),
                      property<&Shaft::teeth>("teeth", "", "of its wheel"),
                      property<&Shaft::label>("label", "", "on its plate"),
                      property<&Shaft::turn>("turn", "", "it turns this way"),
                      property<&Shaft::offsets>("offsets", "deg", "of the sensors", range(-1, 1)),
                      bag("angles", "where it acts", bag<&Shaft::window_axis>("window", "of the weft")));
    }
};

struct Tension {
    Input<double> speed, rate;
    Output<double> torque;
    Property<double> wanted_n{80.0};
    void pre_tension() noexcept TAPPET_REALTIME {}
    void relax() noexcept TAPPET_REALTIME {}
    static constexpr auto interface() {
        return facets(input<&Tension::speed>("speed", "rpm", "of the shaft"),
                      input<&Tension::rate>("rate", "deg/s", "of the shaft", optional),
                      output<&Tension::torque>("torque", "N m", "of the let-off"),
                      operation<&Tension::pre_tension>("pre_tension", "tightens before the beat-up"),
                      operation<&Tension::relax>("relax", "lets go", any_thread),
                      property<&Tension::wanted_n>("wanted_n", "N", "of the warp", range(0, 500)));
    }
};

struct Weft {
    static constexpr bool behaviour_required = true;
    Output<double> reference;
    Event<> inserted;
    Event<> broken;
    bool may_start() noexcept TAPPET_REALTIME { return true; }
    void release() noexcept TAPPET_REALTIME {}
    void insert() noexcept TAPPET_REALTIME { inserted(); }
    void all_off() noexcept TAPPET_REALTIME {}
    static constexpr auto interface() {
        return facets(output<&Weft::reference>("reference", "deg", "the next pick"),
                      event<&Weft::inserted>("inserted", "the weft arrived"),
                      event<&Weft::broken>("broken", "it did not"),
                      operation<&Weft::release>("release", "opens the feeder"),
                      operation<&Weft::insert>("insert", "blows"));
    }
};

struct Climate {
    static constexpr const DeviceKind& device_kind = modbus::device_kind;
    static constexpr int device_map = 0;
    Output<double> humidity;
    void work(const Cycle&) {}
    void log() noexcept TAPPET_REALTIME {}
    static constexpr auto interface() {
        return facets(output<&Climate::humidity>("humidity", "%", "of the hall"),
                      operation<&Climate::log>("log", "writes it down", any_thread));
    }
};

struct Lamps {
    static constexpr const DeviceKind& device_kind = gpio::device_kind;
    static constexpr int device_map = 0;
    static constexpr std::array<std::string_view, 2> lines{"red", "green"};
    static constexpr std::span<const std::string_view> device_lines() { return lines; }
    void red() noexcept TAPPET_REALTIME {}
    void green() noexcept TAPPET_REALTIME {}
    static constexpr auto interface() {
        return facets(operation<&Lamps::red>("red", "a stop"), operation<&Lamps::green>("green", "running"));
    }
};

inline constexpr auto weft_cycle = state_machine<Weft>(
    "weft_cycle",
    states(state("idle", initial), state("weaving", run<&Weft::insert>),
           state("safe", final, entry<&Weft::all_off>)),
    transitions(transition("idle", "weaving", on("shaft.window"), guard<&Weft::may_start>),
                transition("weaving", "safe", on("broken")), transition("weaving", "idle", after(2s))));

inline constexpr auto good_components =
    components(component<Encoder>("encoder", device("main_encoder")),
               component<Shaft>("shaft", set("gain", 2.0), set("filter", 2ms)),
               component<Tension>("tension", set("wanted_n", 120)), component<Weft>("weft"),
               component<Climate>("climate", device("hall")), component<Lamps>("lamps", device("panel")));

inline constexpr auto good_activities = activities(
    activity("field", on_device("encoder"), at_most(1, 1ms), deadline(300us), budget(30us), runs("encoder")),
    activity("motion", every(1ms), budget(120us), runs("shaft", "tension")),
    activity("logic", on_work(), at_most(4, 10ms), deadline(2ms), budget(80us), runs("weft", "lamps")),
    activity("hall", every(250ms), not_real_time, runs("climate")));

inline constexpr auto good_connections =
    connections(data("encoder.angle", "shaft.measured", stale_after(4ms), hold),
                data("shaft.speed", "tension.speed"), data("weft.reference", "shaft.reference"));

inline constexpr auto good_reactions =
    reactions(when("encoder.index", tell("shaft.on_index")),
              when("shaft.window", call("tension.pre_tension")), when("weft.inserted", call("lamps.green")),
              when("weft.broken", tell("shaft.clear")), when("weft.broken", call("tension.relax")));

inline constexpr auto good_behaviours = behaviours(behaviour("weft", weft_cycle));

inline constexpr Board good_board{
    .name = "bench",
    .world = "bench",
    .memory_budget_bytes = 1'000'000,
    .heap_bytes = 100'000,
    .processors = 2,
    .default_processor = 1,
    .devices = board_devices(board_device("can0", "can", "can0", bit_rate(500'000)),
                             board_device("io", "gpio", "/dev/gpiochip0", lines(8)),
                             board_device("serial1", "serial", "/dev/ttyS0")),
};

inline constexpr Binding good_binding =
    binding(wired("main_encoder", "can0"), wired("hall", "192.168.7.2:502"),
            wired("panel", "io", line("red", 4), line("green", 5)), place("hall", 0));

template <std::size_t C, std::size_t A, std::size_t X, std::size_t R, std::size_t B>
constexpr Machine<C, A, X, R, B> loom(const Section<ComponentRow, C>& c, const Section<ActivityRow, A>& a,
                                      const Section<ConnectionRow, X>& x, const Section<ReactionRow, R>& r,
                                      const Section<BehaviourRow, B>& b) {
    return machine("loom", c, a, x, r, b);
}
inline constexpr auto good_loom =
    loom(good_components, good_activities, good_connections, good_reactions, good_behaviours);

/// Adds a component, in an activity of its own.
constexpr auto loom_with(const ComponentRow& component, const ActivityRow& activity) {
    const auto& c = good_components.rows;
    const auto& a = good_activities.rows;
    return loom(components(c[0], c[1], c[2], c[3], c[4], c[5], component),
                activities(a[0], a[1], a[2], a[3], activity), good_connections, good_reactions,
                good_behaviours);
}

} // namespace small
