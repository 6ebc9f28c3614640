// One time for several machines: each keeps its own clock, and knows how far another clock is ahead, and with
// what error.
#pragma once

#include "drivers/udp/clock_exchange.hpp"
#include "drivers/udp/device.hpp"
#include "kernel/component/component.hpp"

namespace tappet::udp {

/// Answers every request for this machine's time: component<udp::ClockAnswers>("time", device("time-port")),
/// bound to the address where the box listens. Real-time.
struct ClockAnswers {
    static constexpr const DeviceKind& device_kind = udp::device_kind;
    static constexpr Longest device_map{.bytes = clock_packet::bytes};

    Output<std::int64_t> answers, invalid;

    Sentence configure(Setup& setup) {
        clock_ = setup.clock;
        datagrams_ = setup.device<Device>();
        return datagrams_ == nullptr ? setup.no_device() : Sentence{};
    }
    void start(const Cycle&) noexcept TAPPET_REALTIME {
        answers.write(0);
        invalid.write(0);
    }
    void step(const Cycle&) noexcept TAPPET_REALTIME {
        for (int i = 0; i < most_in_a_step; ++i) {
            std::array<std::byte, clock_packet::bytes + 1> packet;
            const std::size_t size = datagrams_->receive(packet);
            if (size == 0) return;
            clock_packet::Content asked;
            if (!clock_packet::read(std::span{packet}.first(std::min(size, packet.size())), asked) ||
                !asked.is_question()) {
                invalid.write(invalid.last() + 1);
                continue;
            }
            asked.received = clock_->now();
            asked.answered = clock_->now();
            if (datagrams_->send(clock_packet::write(asked))) answers.write(answers.last() + 1);
        }
    }

    static constexpr auto interface() {
        return facets(output<&ClockAnswers::answers>("answers", "", "questions that were answered"),
                      output<&ClockAnswers::invalid>("invalid", "", "datagrams that are not a question"));
    }

private:
    static constexpr int most_in_a_step = 4;
    os::Clock* clock_ = nullptr;
    Device* datagrams_ = nullptr;
};

/// Asks another machine for its time repeatedly: component<udp::PeerClock>("other_clock",
/// device("other-time")), bound to the address where that one listens. The other machine answers in its step,
/// and this one sees the answer in its own step, so `error` is about one period of the slower machine.
/// Real-time.
struct PeerClock {
    static constexpr const DeviceKind& device_kind = udp::device_kind;
    static constexpr Longest device_map{.bytes = clock_packet::bytes, .asks = true};

    Output<Duration> ahead, error;
    Output<std::int64_t> exchanges, lost, jumps;
    Property<Duration> period{100ms};
    Property<double> drift{200e-6};

    Sentence configure(Setup& setup) {
        clock_ = setup.clock;
        datagrams_ = setup.device<Device>();
        return datagrams_ == nullptr ? setup.no_device() : Sentence{};
    }
    void start(const Cycle& cycle) noexcept TAPPET_REALTIME {
        known_ = {};
        is_open_ = false;
        next_ = cycle.now;
        exchanges.write(0);
        lost.write(0);
        jumps.write(0);
    }
    void step(const Cycle& cycle) noexcept TAPPET_REALTIME {
        for (int i = 0; i < most_in_a_step; ++i) {
            std::array<std::byte, clock_packet::bytes + 1> packet;
            const std::size_t size = datagrams_->receive(packet);
            if (size == 0) break;
            take(std::span{packet}.first(std::min(size, packet.size())));
        }
        if (cycle.now < next_) return;
        next_ = std::max(next_ + period.get(), cycle.now);
        ask();
    }

    static constexpr auto interface() {
        return facets(output<&PeerClock::ahead>(
                          "ahead", "s", "how far the other clock is ahead of the own one, within the error"),
                      output<&PeerClock::error>("error", "s",
                                                "the most by which `ahead` may be wrong; it grows "
                                                "between exchanges"),
                      output<&PeerClock::exchanges>("exchanges", "", "questions that were answered"),
                      output<&PeerClock::lost>("lost", "", "questions without an answer before the next one"),
                      output<&PeerClock::jumps>("jumps", "", "times that the other clock jumped"),
                      property<&PeerClock::period>("period", "s", "between questions", range(0.01, 3600.0)),
                      property<&PeerClock::drift>(
                          "drift", "", "largest drift of the two clocks against each other, s per s",
                          range(0.0, 1e-2)));
    }

private:
    static constexpr int most_in_a_step = 4;

    void take(std::span<const std::byte> packet) noexcept TAPPET_REALTIME {
        clock_packet::Content content;
        if (!clock_packet::read(packet, content) || !is_open_ || content.number != number_ ||
            content.asked != asked_ || content.is_question() || content.answered < content.received)
            return; // a late answer; the next one is more exact
        is_open_ = false;
        known_.take({asked_, content.received, content.answered, clock_->now()}, drift.get());
        exchanges.write(exchanges.last() + 1);
        if (jumps.last() != known_.jumps()) jumps.write(known_.jumps());
        tell();
    }
    void ask() noexcept TAPPET_REALTIME {
        if (is_open_) lost.write(lost.last() + 1);
        asked_ = clock_->now();
        known_.age(asked_, drift.get());
        if (known_.known()) tell();
        is_open_ = datagrams_->send(clock_packet::write({.number = ++number_, .asked = asked_}));
        if (!is_open_) lost.write(lost.last() + 1);
    }
    void tell() noexcept TAPPET_REALTIME {
        ahead.write(known_.ahead());
        error.write(known_.error());
    }

    os::Clock* clock_ = nullptr;
    Device* datagrams_ = nullptr;
    ClockExchange known_{};
    std::uint32_t number_ = 0;
    Time asked_{}, next_{};
    bool is_open_ = false; ///< the question has no answer yet
};

} // namespace tappet::udp
