// The arm that holds the body, with an operator who starts its homing, moves it to the body's place, and
// starts breathing.
#pragma once

#include "apps/two_robots/arm_plant.hpp"
#include "apps/two_robots/joints_link.hpp"
#include "apps/two_robots/k160/machine.hpp"
#include "drivers/udp/far_end.hpp"

namespace two_robots::k160 {

class Plant final : public ArmPlant {
public:
    explicit Plant(std::uint64_t seed) : Plant{seed, Random{seed ^ 0x160}} {}

    Time move(Time now) override {
        move_arm(now);
        link_.put(joints());
        if (works_by_itself_) work(now);
        return now + 1ms;
    }
    [[nodiscard]] Duration usual_time() const override { return 60s; }
    [[nodiscard]] Sentence fault() const override {
        if (beyond() > 0.0) return Sentence{"a joint was turned beyond its end"};
        return {};
    }
    void report(JsonText& json) const override {
        const Joints& q = joints();
        json.field("j1_rad", q[0]).field("j2_rad", q[1]).field("j3_rad", q[2]);
        json.field("j4_rad", q[3]).field("j5_rad", q[4]).field("j6_rad", q[5]);
    }

    [[nodiscard]] std::string_view usage() const override {
        return "  --joints-to PORT        tells the other robot's plant on this box where the joints are\n";
    }
    bool take_option(std::string_view option, std::string_view value, Sentence& fault) override {
        if (option == "--joints-to") fault = link_.tell(value);
        return option == "--joints-to";
    }

    void leave_alone() { works_by_itself_ = false; }

    udp::FarEnd time_port{ends, "time-port"};

private:
    Plant(std::uint64_t seed, Random place)
        : ArmPlant{seed, ArmFacts{counts_per_rad, volts_per_rate, switch_angles, lowest, highest, false},
                   [&] { // wherever it was left
                       Joints at;
                       for (int i = 0; i < 6; ++i) at[i] = 1.6 * (place.unit() - 0.5);
                       return at;
                   }()} {}

    /// Works by the plan; presses an ignored button again.
    void work(Time now) {
        const Duration t = elapsed();
        if (t > 100ms && t < 200ms) press("start", now + 100ms);
        const bool rests = stands();
        if (!rests) stood_since_ = now;
        if (now - stood_since_ < 1s || t < 2s) return;
        stood_since_ = now;
        press(ready_pressed_ ? "work" : "ready", now + 100ms);
        ready_pressed_ = true;
    }

    JointsLink link_;
    bool works_by_itself_ = true, ready_pressed_ = false;
    Time stood_since_{};
};

} // namespace two_robots::k160
