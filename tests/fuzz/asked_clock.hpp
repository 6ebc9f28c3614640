// A machine that asks another machine for its time, and that other machine, whose clock differs.
#pragma once

#include "drivers/udp/peer_clock.hpp"
#include "tests/fuzz/datagram_rig.hpp"

namespace tappet::fuzz {

struct AskedClock : Rig {
    udp::Twin asking, answering;
    udp::PeerClock peer;
    udp::ClockAnswers answers;
    Duration ahead{};                                 ///< of the other clock
    udp::clock_packet::Content question{};            ///< the last question
    std::array<udp::clock_packet::Packet, 8> given{}; ///< answers, for repetition
    std::int64_t asked = 0;
    bool is_true = true; ///< no answer lied, although some may have been late or repeated

    AskedClock() {
        wait(1s);
        set_up(peer, asking);
        set_up(answers, answering);
    }
    [[nodiscard]] bool is_within(Duration error) const {
        return peer.ahead.last() - ahead <= error && ahead - peer.ahead.last() <= error;
    }
    void step(Duration time = 1ms) {
        wait(time);
        peer.step(cycle);
        for (;; ++asked) {
            const std::size_t size = asking.hear(room);
            if (size == 0) break;
            demand(udp::clock_packet::read(Bytes{room}.first(size), question) && question.is_question());
        }
        demand(peer.error.last() >= 0ns && peer.exchanges.last() + peer.lost.last() <= asked);
        if (is_true && peer.exchanges.last() > 0) demand(is_within(peer.error.last() + 1ns));
    }
    /// The other machine answers; its clock is ahead.
    void answer() {
        tell(answering, udp::clock_packet::write(question));
        answers.step(cycle);
        udp::clock_packet::Content content;
        const std::size_t size = answering.hear(room);
        if (size == 0 || !udp::clock_packet::read(Bytes{room}.first(size), content)) return;
        content.received += ahead, content.answered += ahead;
        tell(asking, given[content.number % given.size()] = udp::clock_packet::write(content));
    }
    void lie(Time received, Time answered) {
        is_true = false;
        tell(asking, udp::clock_packet::write({question.number, question.asked, received, answered}));
    }
    void ask(Bytes datagram) {
        const std::int64_t before = answers.answers.last() + answers.invalid.last();
        tell(answering, datagram);
        answers.step(cycle);
        while (answering.hear(room) != 0) {
        }
        demand(datagram.empty() || answers.answers.last() + answers.invalid.last() == before + 1);
    }
    void take(std::uint8_t what, Script& script) {
        switch (what >> 4 & 7) {
        case 0: answer(); break;
        case 1: // the clock was set, or restarted
            ahead = Duration{number_of(script) / 4};
            is_true = false;
            break;
        case 2: tell(asking, given[what & 7U]); break;
        case 3: tell(asking, bytes_of(script, what & 0xFU)); break;
        case 4: lie(at_ns(number_of(script)), at_ns(number_of(script))); break;
        case 5:
            ask((what & 1) != 0 ? Bytes{given[what >> 1 & 7U]}
                                : bytes_of(script, udp::clock_packet::bytes + (what & 2U)));
            break;
        default: step(Duration{1ms} * (1 << (what & 0xF)));
        }
        if ((what & 0x80) != 0) step();
    }
    void come_back() {
        ahead = 50s, is_true = false;
        const std::int64_t before = peer.exchanges.last();
        for (int steps = 0; steps < 400; ++steps) {
            const std::int64_t questions = asked;
            step();
            if (asked != questions) answer();
        }
        demand(peer.exchanges.last() >= before + 3 && is_within(2ms) && peer.error.last() <= 2ms);
    }
};

} // namespace tappet::fuzz
