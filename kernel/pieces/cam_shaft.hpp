// A shaft as a component: converts encoder codes to the events of a cam table.
//     component<CamShaft<cams>>("shaft")                                          // 4096 codes a turn
//     component<CamShaft<cams>>("web", set("codes_per_turn", 4000), set("counter_bits", 16))
//     when("shaft.eject.enters", tell("io.ejector.set")), when("shaft.eject.leaves",
//     tell("io.ejector.clear"))
#pragma once

#include "kernel/base/unwrapped_count.hpp"
#include "kernel/cam/estimator.hpp"
#include "kernel/cam/schedule.hpp"
#include "kernel/cam/trust.hpp"
#include "kernel/component/component.hpp"
#include "kernel/component/facet_name.hpp"
#include "kernel/pieces/changed.hpp"

#include <array>

namespace tappet {

/// Events: "row" for a point in the table, "row.enters" and "row.leaves" for a window; each needs a row that
/// handles it. A measuring wheel is a shaft, too: one length is one turn, which begins at the first position
/// seen, and again after each loss.
///
/// While the angle is unknown or `enabled` is false, nothing fires, and open windows are left. The angle is
/// lost when the code is stale, as its connection says, and when it jumps; it is known again
/// EncoderTrust::doubted later at the earliest, so that slow readers see the loss, too. When the component
/// starts and stops, each window sends its leave event. Use it in an activity that each code wakes, and the
/// absence of codes (`wakes, stale_after(..)`). Real-time.
template <const auto& cams> struct CamShaft {
    static constexpr std::size_t count = cams.size();
    /// The number of windows before each row, and before the end.
    static constexpr auto window_of = [] {
        std::array<std::size_t, count + 1> before{};
        for (std::size_t i = 0; i < count; ++i) before[i + 1] = before[i] + (cams.rows[i].is_window ? 1 : 0);
        return before;
    }();
    static constexpr std::size_t window_count = window_of[count];
    static constexpr Sentence cam_fault = check(cams.view());
    static constexpr std::string_view device_fault = cam_fault.view();

    Input<std::int64_t> code;
    Input<bool> enabled;
    Output<double> angle_deg, speed_rpm;
    Output<std::int64_t> fired, skipped;
    Output<bool> valid;
    std::array<Event<>, count> enters;
    std::array<Event<>, window_count> leaves;
    Event<> lost;
    Timer cam_timer;
    Property<std::int64_t> codes_per_turn{4096}, counter_bits{0};
    Property<Duration> stamp_latency{};

    Sentence configure(Setup&) {
        shaft_.codes_per_turn = static_cast<std::uint32_t>(codes_per_turn.get());
        shaft_.stamp_latency = stamp_latency.get();
        is_configured_ = true;
        return check(shaft_);
    }
    void start(const Cycle&) noexcept TAPPET_REALTIME {
        fired.write(0);
        skipped.write(0);
        trust_ = {};
        rest();
    }
    void stop(const Cycle&) noexcept TAPPET_REALTIME { rest(); }
    void step(const Cycle& cycle) noexcept TAPPET_REALTIME {
        std::int64_t now = 0;
        const Flow flow = code.read(now);
        if (flow == Flow::fresh) sample(now);
        trust_.watch(estimator_.counters().implausible, cycle.now);
        const bool believes = trust_.believes(cycle.now);
        // Never written: a forced value of an unwritten input has ended.
        const bool is_silent = flow == Flow::stale || flow == Flow::never_written;
        if (seen_ && (estimator_.epoch() != 0 || is_silent || (knows_ && !believes))) lose(cycle.now);
        if (!knows_ && believes && estimator_.valid(cycle.now)) knows_ = true;
        if (knows_) follow(cycle.now);
        valid_.write(valid, knows_);
    }
    void fire(const Cycle& cycle) noexcept TAPPET_REALTIME {
        schedule_.advance(cycle.now, [this](const CamEvent& event) noexcept TAPPET_REALTIME { tell(event); });
        cam_timer.arm(schedule_.next_due());
    }
    Sentence accepts(const Proposal& proposal) const noexcept TAPPET_REALTIME {
        if (!is_configured_ || !(proposal.changes(codes_per_turn) || proposal.changes(counter_bits) ||
                                 proposal.changes(stamp_latency)))
            return {};
        return Sentence{"the encoder is described at a start; write it into the table"};
    }

    static constexpr auto interface() {
        std::array<Facet, edge_count + 12> all{};
        std::size_t n = 0;
        for (std::size_t i = 0; i < count; ++i) {
            const bool is_window = cams.rows[i].is_window;
            all[n++] = edge<&CamShaft::enters>(is_window ? enters_names[i].view() : cams.rows[i].name, i,
                                               "to be driven now, to act at its angle");
            if (is_window)
                all[n++] = edge<&CamShaft::leaves>(leaves_names[i].view(), window_of[i],
                                                   "no longer; also when the shaft stands or is lost");
        }
        for (const Facet& each :
             facets(input<&CamShaft::code>("code", "", "of the encoder, within a turn or of a counter",
                                           grows_stale),
                    input<&CamShaft::enabled>("enabled", "", "cams may fire"),
                    output<&CamShaft::angle_deg>("angle_deg", "deg", "now"),
                    output<&CamShaft::speed_rpm>("speed_rpm", "rpm", "now; 0 while the angle is not known"),
                    output<&CamShaft::fired>("fired", "", "points and windows, since start"),
                    output<&CamShaft::skipped>("skipped", "", "passed by too slowly, or seen too late"),
                    output<&CamShaft::valid>("valid", "", "the angle is known; written on change"),
                    event<&CamShaft::lost>("lost", "the angle is not known any more"),
                    timer<&CamShaft::cam_timer, &CamShaft::fire>("cam_timer", "the next event"),
                    property<&CamShaft::codes_per_turn>("codes_per_turn", "", "of the encoder",
                                                        range(8, 1 << 24)),
                    property<&CamShaft::counter_bits>(
                        "counter_bits", "",
                        "width of a counter that runs on; 0: the code is a place in the turn", range(0, 32)),
                    property<&CamShaft::stamp_latency>("stamp_latency", "s",
                                                       "of the code, behind its instant", range(0, 0.01))))
            all[n++] = each;
        return all;
    }

private:
    static constexpr std::size_t edge_count = count + window_count;
    static constexpr auto names(std::string_view ending) {
        std::array<FacetName, count> all{};
        for (std::size_t i = 0; i < count; ++i) all[i] = {cams.rows[i].name, ending};
        return all;
    }
    static constexpr auto enters_names = names(".enters");
    static constexpr auto leaves_names = names(".leaves");

    template <auto Events>
    static constexpr Facet edge(std::string_view name, std::size_t index, std::string_view doc) {
        return {.name = name,
                .doc = doc,
                .kind = FacetKind::event,
                .type = type_id<Arguments<>>,
                .least_reactions = 1,
                .index = index,
                .at = [](void* c, std::size_t k) noexcept -> void* {
                    return &(static_cast<CamShaft*>(c)->*Events)[k];
                },
                .event = &PortAccess::event<>};
    }

    void sample(std::int64_t now) noexcept TAPPET_REALTIME {
        const std::int64_t turn = shaft_.codes_per_turn;
        if (const auto bits = static_cast<int>(counter_bits.get()); bits != 0) {
            const std::int64_t way = counted_.take(now, bits);
            if (!seen_) begun_at_ = way;
            now = ((way - begun_at_) % turn + turn) % turn;
        }
        seen_ = true;
        const bool is_place = now >= 0 && now < turn; // otherwise it is counted as a bad code
        estimator_.sample(is_place ? static_cast<std::uint32_t>(now) : ~std::uint32_t{0}, code.stamp());
    }
    void follow(Time now) noexcept TAPPET_REALTIME {
        schedule_.update(estimator_, now);
        const ShaftState state = estimator_.at(now);
        angle_deg.write(state.position.angle().in_degrees());
        speed_rpm.write(state.velocity_deg_s / 6.0);
        if (!enabled.get())
            schedule_.leave_all([this](const CamEvent& event) noexcept TAPPET_REALTIME { tell(event); });
        const CamCounters& counters = schedule_.counters();
        const auto missed = static_cast<std::int64_t>(counters.skipped_late + counters.skipped_slow);
        if (missed != missed_) skipped.write(skipped.last() + missed - missed_);
        missed_ = missed;
        cam_timer.arm(schedule_.next_due());
    }
    void tell(const CamEvent& event) noexcept TAPPET_REALTIME {
        if (event.kind == CamKind::leave) {
            leaves[window_of[event.row]].emit();
        } else if (enabled.get()) {
            fired.write(fired.last() + 1);
            enters[event.row].emit();
        }
    }
    void lose(Time now) noexcept TAPPET_REALTIME {
        trust_ = {};
        trust_.doubt_until(now + EncoderTrust::doubted);
        if (knows_) lost.emit();
        rest();
    }
    /// Resets as if no code had ever arrived.
    void rest() noexcept TAPPET_REALTIME {
        for (std::size_t i = 0; i < count; ++i)
            if (cams.rows[i].is_window) leaves[window_of[i]].emit();
        estimator_ = ShaftEstimator{shaft_};
        schedule_ = CamSchedule<count>{cams};
        cam_timer.cancel();
        missed_ = 0;
        seen_ = knows_ = false;
        angle_deg.write(0.0);
        speed_rpm.write(0.0);
        valid_.write(valid, false);
    }

    ShaftProperties shaft_{};
    ShaftEstimator estimator_{shaft_};
    CamSchedule<count> schedule_{cams};
    EncoderTrust trust_{};
    UnwrappedCount counted_{}; // of a counter, whose turns begin at its first value
    std::int64_t begun_at_ = 0;
    std::int64_t missed_ = 0; // by the schedule
    bool is_configured_ = false, seen_ = false, knows_ = false;
    Changed<bool> valid_;
};

} // namespace tappet
