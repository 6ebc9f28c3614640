// The context of a faulty script: one component with a method and an event.
#pragma once

// Included first, since it is precompiled.
#include "tests/diagnostics/small_machine.hpp"

#include "kernel/script/compiled.hpp"

struct ScriptedAxis {
    tappet::Event<> mark;
    void home(std::int32_t) noexcept TAPPET_REALTIME {}
    void survey() noexcept {}
    static constexpr auto interface() {
        return tappet::facets(
            tappet::event<&ScriptedAxis::mark>("mark", "the index mark passed"),
            tappet::method<&ScriptedAxis::home>("home", "to the reference"),
            tappet::method<&ScriptedAxis::survey>("survey", "all of it", tappet::may_block));
    }
};

inline constexpr auto axis_reach = tappet::script_reach(tappet::reachable<ScriptedAxis>("axis"));
