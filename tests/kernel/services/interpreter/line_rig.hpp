// The press with an interpreter in virtual time, and a client that types lines.
#pragma once

#include "tests/kernel/services/browsing/press_rig.hpp"
#include "tests/kernel/services/interpreter/line_machine.hpp"

#include <gmock/gmock.h>

namespace tappet::press {

class Lines : public Browsed<line_table> {
protected:
    /// The end of a line, or its refusal.
    std::string execute(std::string_view line) {
        std::string first = ask(request(line));
        return first.find(R"("state": "sent")") == std::string::npos ? first : next(talker());
    }
    static std::string request(std::string_view line) {
        std::string words{"7 execute \""};
        for (const char character : line)
            words +=
                character == '"' || character == '\\' ? std::string{'\\', character} : std::string{character};
        return words + "\"";
    }
    Ram& ram() { return the<Ram>("ram"); }
    void look(Talker& who) { static_cast<void>(who.send(request("1 + 1"))); }
    /// Runs beside an observer that answers each reply with its next request.
    void run_beside(Talker& observer, Duration time) {
        run(time);
        while (!observer.receive().empty()) look(observer);
    }
    /// A peer lets the gauge be zeroed; its line is aborted if it waits. Returns whether it was aborted.
    template <class Then> bool breaks_off(Panel& peer, Talker& observer, const Then& then) {
        const std::int64_t zeroed = gauge().zeroed;
        peer.wanted = peer.line.assign("do gauge.zero()");
        bool is_broken_off = false;
        for (int k = 0; k < 60; ++k) {
            run_beside(observer, 5ms);
            if (is_broken_off || peer.execute.state() != CommandState::executing || gauge().zeroed != zeroed)
                continue;
            interpreter().break_off();
            is_broken_off = true;
            then();
        }
        return is_broken_off;
    }
    Gauge& gauge() { return the<Gauge>("gauge"); }
    Panel& panel(std::string_view name = "panel") { return the<Panel>(name); }
    CommandInterpreter& interpreter() { return the<CommandInterpreter>("interpreter"); }
};

} // namespace tappet::press
