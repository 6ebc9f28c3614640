// Simulates the network between both robots' clocks: delayed or lost questions and answers, and the drifting
// clock of the robot that holds the body.
#pragma once

#include "drivers/udp/clock_exchange.hpp"
#include "drivers/udp/far_end.hpp"
#include "kernel/base/random.hpp"

#include <algorithm>
#include <vector>

namespace two_robots {

using namespace tappet;

/// In one process both machines share one clock. The answering machine's times are shifted to a clock that is
/// ahead and drifts. Not real-time.
class TimeLink {
public:
    struct Faults {
        std::uint64_t lost_one_in = 20;
        Duration most_delay = 3ms; ///< in each direction
        bool is_cut = false;
    };

    explicit TimeLink(std::uint64_t seed) : random_{seed ^ 0x7135} {
        ahead_ = Duration{static_cast<std::int64_t>(random_.below(2'000'000'000))} - 1s;
        drift_ = 100e-6 * (2.0 * random_.unit() - 1.0);
    }

    /// Returns the true lead of the other clock at `now`.
    [[nodiscard]] Duration ahead(Time now) const {
        return ahead_ + Duration{static_cast<std::int64_t>(drift_ * static_cast<double>(to_ns(now)))};
    }
    /// Records that the other clock was set.
    void set_by(Duration step) { ahead_ += step; }

    void carry(Time now, udp::FarEnd& asking, udp::FarEnd& answering) {
        while (take(asking)) send(now, true);
        while (take(answering)) {
            content_.received += ahead(content_.received);
            content_.answered += ahead(content_.answered);
            send(now, false);
        }
        const auto is_due = [now](const OnTheWay& each) { return each.arrives <= now; };
        for (const OnTheWay& each : on_the_way_)
            if (is_due(each))
                (each.is_question ? answering : asking).send(udp::clock_packet::write(each.content));
        std::erase_if(on_the_way_, is_due);
    }

    Faults faults{};

private:
    struct OnTheWay {
        Time arrives{};
        udp::clock_packet::Content content{};
        bool is_question = false;
    };
    [[nodiscard]] bool take(udp::FarEnd& from) {
        std::array<std::byte, udp::most_bytes> packet;
        const std::size_t size = from.receive(packet);
        return size != 0 && udp::clock_packet::read(std::span{packet}.first(size), content_);
    }
    void send(Time now, bool is_question) {
        const auto most = static_cast<std::uint64_t>(faults.most_delay.count()) + 1;
        const Time arrives = now + Duration{static_cast<std::int64_t>(random_.below(most))};
        const bool is_lost = random_.one_in(faults.lost_one_in);
        if (!is_lost && !faults.is_cut) on_the_way_.push_back({arrives, content_, is_question});
    }

    Random random_;
    Duration ahead_{};
    double drift_ = 0.0;
    udp::clock_packet::Content content_{};
    std::vector<OnTheWay> on_the_way_;
};

} // namespace two_robots
