// Simulates the web, its drive and its knife at the other end of the wires, and measures each cut piece.
#pragma once

#include "apps/cut_to_length/maps.hpp"
#include "drivers/can/far_end.hpp"
#include "drivers/canopen/simulated_drive.hpp"
#include "drivers/gpio/far_end.hpp"
#include "drivers/instruments/simulated.hpp"
#include "drivers/plant/plant.hpp"
#include "kernel/base/random.hpp"
#include "kernel/base/value_text.hpp"

#include <cmath>

namespace cut_to_length {

/// An operator unlocks and starts the line, and stops it when enough pieces are cut.
class Plant final : public tappet::Plant {
public:
    explicit Plant(std::uint64_t seed) : random_{seed} {
        can.send_every("wheel", 1ms);
        can.send_every("feed", 5ms);
    }

    Time move(Time now) override {
        const double dt = to_seconds(step());
        const double wanted = drive_.is_enabled() ? can.get("feed_command.speed") : 0.0;
        const double before = speed_;
        const double change = acceleration * dt;
        speed_ += std::clamp(wanted - speed_, -change, change);
        web_mm_ += (before + speed_) / 2 * dt * 1000.0;
        can.set_integer("feed.statusword", drive_.follow(can.integer("feed_command.controlword")));
        operate(now);
        if (io.changed("knife") && io.get("knife"))
            blade_at_ = io.changed_at() + knife_dead_time +
                        Duration{static_cast<std::int64_t>((random_.unit() - 0.5) * 100'000.0)};
        if (blade_at_ <= now) cut(web_mm_ - speed_ * 1000.0 * to_seconds(now - blade_at_));
        can.set_integer("wheel.position", wheel_.count(web_mm_));
        return std::min(now + 1ms, blade_at_);
    }

    [[nodiscard]] std::string_view usage() const override {
        return "  --pieces N          stops the line after N pieces (default 60)\n";
    }
    bool take_option(std::string_view option, std::string_view value, Sentence& fault) override {
        if (option != "--pieces") return false;
        if (!parse_value(*type_id<std::int64_t>, value, std::as_writable_bytes(std::span{&wanted_, 1}).data())
                 .empty() ||
            wanted_ < 1)
            fault = Sentence{"\"", value, "\" is not a number of pieces; write for example --pieces 60"};
        return true;
    }
    [[nodiscard]] bool is_done() const override { return pieces_ >= wanted_ && web_stands(); }
    [[nodiscard]] Duration usual_time() const override { return 30s; }
    [[nodiscard]] Sentence fault() const override {
        if (pieces_ < wanted_) return Sentence{"only ", pieces_, " pieces were cut"};
        if (worst_mm_ > tolerance_mm) return Sentence{"a piece is wrong by more than 1 mm"};
        return {};
    }
    [[nodiscard]] std::uint64_t digest() const override { return std::bit_cast<std::uint64_t>(web_mm_); }
    void report(JsonText& json) const override {
        json.field("pieces", pieces_).field("worst_error_mm", worst_mm_).field("web_m", web_mm_ / 1000.0);
    }

    // For tests: actions of people, and faults.
    void press_emergency_stop(bool pressed) {
        emergency_ = pressed;
        cut_before_ = false; // the piece being fed is scrap
    }
    void press_start(Time at) { start_at_ = at; }
    void silence_drive() { can.send_every("feed", Duration::zero()); }
    void silence_wheel() { can.send_every("wheel", Duration::zero()); }
    void pull_web(double mm) { web_mm_ += mm; }
    [[nodiscard]] bool web_stands() const { return speed_ == 0.0; }
    [[nodiscard]] bool knife_is_driven() { return io.get("knife"); }
    [[nodiscard]] std::int64_t cuts() const { return cuts_; }
    [[nodiscard]] std::int64_t pieces() const { return pieces_; }
    [[nodiscard]] double worst_mm() const { return worst_mm_; }

    static constexpr double tolerance_mm = 1.0; // the web moves this far in half a millisecond at 2 m/s

private:
    can::FarEnd<can_signals> can{ends, "feed-can"};
    gpio::FarEnd<io_lines> io{ends, "line-io"};

    static constexpr double acceleration = 2.0; // m/s2
    static constexpr double length_mm = 500.0;

    /// Presses start until the line runs, once; presses stop when enough is cut.
    void operate(Time now) {
        started_ |= io.get("lamp");
        const Duration t = elapsed() % 500ms;
        const bool again = now >= start_at_ && now < start_at_ + 100ms;
        io.set("start", again || (!started_ && t > 300ms && t < 400ms));
        io.set("emergency_stop", emergency_);
        io.set("stop", pieces_ >= wanted_ && speed_ > 0.0);
    }
    void cut(double at_mm) {
        blade_at_ = never;
        ++cuts_;
        if (cut_before_) {
            ++pieces_;
            worst_mm_ = std::max(worst_mm_, std::abs(at_mm - last_cut_mm_ - length_mm));
        }
        cut_before_ = true;
        last_cut_mm_ = at_mm;
    }

    Random random_;
    canopen::SimulatedDrive drive_;
    instruments::SimulatedEncoder<wheel_bits> wheel_{codes_per_mm};
    Time blade_at_ = never;
    double web_mm_ = 0.0, speed_ = 0.0;
    bool cut_before_ = false, emergency_ = false, started_ = false;
    Time start_at_ = never - 1s;
    double last_cut_mm_ = 0.0, worst_mm_ = 0.0;
    std::int64_t cuts_ = 0, pieces_ = 0, wanted_ = 60;
};

} // namespace cut_to_length
