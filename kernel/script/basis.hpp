// The parts of the compiler below the grammar.
#pragma once

#include "kernel/script/behaviours.hpp"
#include "kernel/script/flow.hpp"
#include "kernel/script/peers.hpp"

namespace tappet::script_detail {

/// Each part refers to those that it works on.
struct Basis {
    constexpr Basis(std::string_view script, std::string_view file, const Reach& in_reach,
                    const ScriptRoom& room, ScriptOutcome& outcome)
        : reach{in_reach}, text{script, file, outcome}, out{text, room} {}

    const Reach& reach;
    Reader text;
    Emitter out;
    Values values{text, out};
    Scope scope{text};
    Peers peers{text, out, reach};
    Behaviours behaviours{text, out};
    Flow flow{text, out, values, scope, reach};
};

} // namespace tappet::script_detail
