// A component whose state programs write down that they ran: "+a"
// entry, "-a" exit, "!a" run, "*a" transition program.
#pragma once

#include "kernel/base/bounded.hpp"
#include "kernel/base/text.hpp"
#include "kernel/statechart/execution.hpp"
#include "kernel/statechart/rows.hpp"

#include <string>
#include <string_view>

namespace tappet {

struct Recorder {
    Bounded<char, 4096> characters;
    StateMachineExecution* machine = nullptr;
    StateOutcome last_outcome = StateOutcome::ignored;
    Time now{};
    bool yes = false;
    int asked = 0;

    template <text what> void say() noexcept TAPPET_REALTIME {
        if (!characters.empty()) static_cast<void>(characters.push(' '));
        for (char character : what.view()) static_cast<void>(characters.push(character));
    }
    template <text what, std::size_t trigger> void raise() noexcept TAPPET_REALTIME {
        say<what>();
        last_outcome = machine->dispatch(trigger, now);
    }
    void give_up() noexcept TAPPET_REALTIME {
        say<"give_up">();
        last_outcome = machine->request_final(now, "gave up");
    }
    bool if_yes() const noexcept TAPPET_REALTIME { return yes; }
    bool if_asked() noexcept TAPPET_REALTIME {
        ++asked;
        return yes;
    }

    /// What was written since the last call.
    std::string heard() {
        const std::string text{characters.begin(), characters.end()};
        characters.clear();
        return text;
    }
};

} // namespace tappet
