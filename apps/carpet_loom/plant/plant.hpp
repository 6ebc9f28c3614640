// The carpet loom at the other end of the wires: frames, lines and registers outside, physics and an operator
// inside.
#pragma once

#include "apps/carpet_loom/plant/climate.hpp"
#include "apps/carpet_loom/plant/contact.hpp"
#include "apps/carpet_loom/plant/dobby.hpp"
#include "apps/carpet_loom/plant/feeder.hpp"
#include "apps/carpet_loom/plant/insertion.hpp"
#include "apps/carpet_loom/plant/loom_operator.hpp"
#include "apps/carpet_loom/plant/report.hpp"
#include "apps/carpet_loom/plant/settings.hpp"
#include "apps/carpet_loom/plant/shaft.hpp"
#include "apps/carpet_loom/plant/warp.hpp"

namespace tappet::loom {

enum class Button : std::uint8_t { start, stop, acknowledge, emergency_stop };

/// Time begins at Time{0} and never runs backwards: every call that carries a time first advances to it. The
/// physics runs on its own grid, so a run does not depend on how often it is advanced. One thread at a time.
/// Real-time: a call costs a bounded time per microsecond of plant time advanced.
class Plant {
public:
    static constexpr Duration step = 100us;
    static constexpr Duration resting_step = 1ms; // while nothing moves

    Plant(const Settings& settings, std::uint64_t seed) noexcept TAPPET_REALTIME;

    void advance(Time now) noexcept TAPPET_REALTIME;
    /// Advances towards `until`, stays before it, and stops where something leaves the plant. Returns when to
    /// advance it next.
    Time leap(Time until) noexcept TAPPET_REALTIME;
    /// Nothing leaves the plant before this time unless somebody acts on it: a world in virtual time may leap
    /// to it.
    [[nodiscard]] Time next_event() const noexcept TAPPET_REALTIME {
        return std::min(next_timer_, step_end_);
    }
    /// Returns when a contact next closes, opens or bounces.
    [[nodiscard]] Time next_contact() const noexcept TAPPET_REALTIME {
        Time next = never;
        for (const Contact& contact : contacts_) next = std::min(next, contact.next());
        return next;
    }
    [[nodiscard]] Time now() const noexcept TAPPET_REALTIME { return now_; }

    // CAN: a frame from the machine; the plant's own frames, in the order and with the time stamp at which
    // they were due. The plant ignores unknown identifiers and wrong lengths (a drive answers with an
    // emergency message).
    void receive(const can::Frame& frame, Time now) noexcept TAPPET_REALTIME;
    [[nodiscard]] bool transmit(can::Frame& frame) noexcept TAPPET_REALTIME { return wire_.pop(frame); }

    /// Returns the encoder's sample as of now: a real-time world that is late sends the present angle, not
    /// the past one.
    [[nodiscard]] can::Frame encoder_sample() noexcept TAPPET_REALTIME {
        encoder_.set(0x2100, encoder_code_at(now_));
        return encoder_.pdo(0);
    }

    // GPIO: offsets of wires::line. A line that is no output of the machine is ignored.
    void set_line(unsigned output, bool level, Time now) noexcept TAPPET_REALTIME;
    [[nodiscard]] bool line(unsigned input) const noexcept TAPPET_REALTIME;
    [[nodiscard]] bool next_edge(Edge& edge) noexcept TAPPET_REALTIME { return edges_.pop(edge); }

    // Modbus: the server's registers; a wrong request gets its exception.
    [[nodiscard]] const Climate& climate() const noexcept TAPPET_REALTIME { return climate_; }
    [[nodiscard]] Climate& climate() noexcept TAPPET_REALTIME { return climate_; }

    // People. A pressed emergency stop stays pressed for `lasts`; 0: until the operator releases it.
    void press(Button button, Duration lasts) noexcept TAPPET_REALTIME;
    void inject(const ScriptedFault& fault) noexcept TAPPET_REALTIME;
    /// Repairs all faults, as the operator does.
    void repair() noexcept TAPPET_REALTIME;

    // The truth, for reports and tests; the machine does not see it.
    [[nodiscard]] Report report() const noexcept TAPPET_REALTIME;
    /// The operator stops once `picks` are woven, and does not start again.
    void end_at(std::uint64_t picks) noexcept TAPPET_REALTIME { settings_.last_pick = picks; }
    [[nodiscard]] const Damage& damage() const noexcept TAPPET_REALTIME { return report_.damage; }
    /// Returns an output's level as the machine drives it; offsets of wires::line.
    [[nodiscard]] bool output(unsigned offset) const noexcept TAPPET_REALTIME {
        return outputs_[offset - wires::line::first_output];
    }
    [[nodiscard]] std::uint64_t picks() const noexcept TAPPET_REALTIME { return report_.picks; }
    [[nodiscard]] double position_deg() const noexcept TAPPET_REALTIME { return position_deg_at(now_); }
    [[nodiscard]] double speed_rpm() const noexcept TAPPET_REALTIME {
        return shaft_.speed_rad_s_at(into_step_s(now_)) / rad_s_per_rpm;
    }
    [[nodiscard]] double tension_n() const noexcept TAPPET_REALTIME {
        return warp_.tension_n(position_deg());
    }
    [[nodiscard]] const Drive& main_drive() const noexcept TAPPET_REALTIME { return main_; }
    [[nodiscard]] const Drive& let_off_drive() const noexcept TAPPET_REALTIME { return let_off_; }
    [[nodiscard]] const Dobby& dobby() const noexcept TAPPET_REALTIME { return dobby_; }
    [[nodiscard]] const Feeder& feeder() const noexcept TAPPET_REALTIME { return feeder_; }

private:
    struct ActiveFault {
        Fault fault = Fault::weft_break;
        std::uint8_t node = 0;
        Time until; // never: until repaired
        bool operator==(const ActiveFault&) const = default;
    };

    // plant.cpp: time
    void pass(Time next) noexcept TAPPET_REALTIME;
    void begin_step() noexcept TAPPET_REALTIME;
    void end_step() noexcept TAPPET_REALTIME;
    void run_timers(Time now) noexcept TAPPET_REALTIME;
    void tick_nodes(Time now) noexcept TAPPET_REALTIME;
    void find_next_timer() noexcept TAPPET_REALTIME;
    void shorten_rest() noexcept TAPPET_REALTIME;
    [[nodiscard]] double into_step_s(Time at) const noexcept TAPPET_REALTIME {
        return to_seconds(at - step_begin_);
    }
    [[nodiscard]] double position_deg_at(Time at) const noexcept TAPPET_REALTIME {
        return shaft_.position_deg_at(into_step_s(at));
    }
    [[nodiscard]] std::uint16_t encoder_code_at(Time at) const noexcept TAPPET_REALTIME {
        const double codes = position_deg_at(at) * (wires::encoder_codes_per_turn / 360.0);
        return static_cast<std::uint16_t>(floor_to_int(codes) & (wires::encoder_codes_per_turn - 1));
    }
    void hear(std::uint8_t node, canopen::SimulatedNode::Heard what) noexcept TAPPET_REALTIME;

    // weaving.cpp: the events at the angles of a turn, and their measurements
    void pass_marks(double position_deg) noexcept TAPPET_REALTIME;
    void beat_up() noexcept TAPPET_REALTIME;
    void note_pattern() noexcept TAPPET_REALTIME;
    void open_valve(Time at) noexcept TAPPET_REALTIME;
    void measure_motion(double turned_deg, Duration dt) noexcept TAPPET_REALTIME;
    void record_standstill(Time at) noexcept TAPPET_REALTIME;
    void blame(StopCause cause) noexcept TAPPET_REALTIME;

    // troubles.cpp: faults and the operator
    void start_fault(const ScriptedFault& fault) noexcept TAPPET_REALTIME;
    void end_fault(const ActiveFault& fault) noexcept TAPPET_REALTIME;
    void end_faults(Time now, bool repaired) noexcept TAPPET_REALTIME;
    void run_script() noexcept TAPPET_REALTIME;
    void draw_troubles() noexcept TAPPET_REALTIME;
    void work(Time now) noexcept TAPPET_REALTIME;
    [[nodiscard]] bool broken() const noexcept TAPPET_REALTIME;
    [[nodiscard]] canopen::SimulatedNode* node_of(std::uint8_t id) noexcept TAPPET_REALTIME;
    void restart_application(std::uint8_t id) noexcept TAPPET_REALTIME;

    Settings settings_;
    std::uint64_t seed_;
    Random random_;
    Wire wire_;
    EdgeOutbox edges_;
    Digest log_;

    Drive main_;
    Drive let_off_;
    Node<canopen::dictionary<files::encoder_eds>> encoder_;
    Node<canopen::dictionary<files::load_cell_eds>> load_cell_;
    Feeder feeder_;
    Dobby dobby_;
    MainShaft shaft_;
    Brake brake_;
    Warp warp_;
    Insertion insertion_;
    Climate climate_;
    Operator operator_;
    std::array<Contact, wires::line::input_count> contacts_;
    std::array<bool, wires::line::output_count> outputs_{};

    Time now_{};
    Time step_begin_{};
    Time step_end_{};
    Time next_timer_{};
    bool resting_ = false;
    Time climate_at_{};
    Time operator_at_{};
    Time valve_check_at_ = never;
    Time faults_end_at_ = never;
    Time blocked_since_ = never;
    std::uint16_t encoder_samples_ = 0;

    // The turn.
    double turn_deg_ = 0.0; // position at which the present turn began
    double next_mark_deg_;  // first the beat-up (parked near level); passed once even when jogged
    std::size_t next_mark_ = 0;
    double brake_edge_deg_ = 0.0;
    bool braked_ = false; // since the shaft last began to move
    bool moving_ = false;
    double fastest_rad_s_ = 0.0; // since then
    unsigned causes_ = 0;        // bit per StopCause, since then
    Time emergency_at_ = never;
    double warp_breaks_at_deg_;
    bool next_weft_breaks_ = false;
    bool weft_missing_ = false;
    Duration unpowered_{};
    Duration dry_{};
    Duration at_speed_{};
    bool tension_was_hard_ = false;
    bool stop_pressed_at_end_ = false;

    Bounded<ActiveFault, 16> active_{};
    std::uint32_t script_done_ = 0; // bit per row

    ErrorHistogram cam_errors_;
    Report report_{};
    Duration running_{};
    Duration weaving_{};
    Duration out_of_band_{};
};

} // namespace tappet::loom
