// The check of a whole table, bound to a board. Returns an empty sentence, or one that names the row, the
// fault and the cure. The same function runs in the compiler and in tests.
#pragma once

#include "kernel/machine/check/board.hpp"
#include "kernel/machine/check/components.hpp"
#include "kernel/machine/check/controls.hpp"
#include "kernel/machine/check/flow.hpp"
#include "kernel/machine/check/operations.hpp"
#include "kernel/machine/check/reach.hpp"
#include "kernel/machine/check/reactions.hpp"
#include "kernel/machine/check/stop.hpp"
#include "kernel/machine/check/time.hpp"
#include "kernel/machine/check/traffic.hpp"
#include "kernel/machine/check/wakes.hpp"
#include "kernel/machine/check/watches.hpp"

namespace tappet {

/// Checks in the order in which a reader would look, and fills `r`, which is valid only as far as the checks
/// went.
constexpr Sentence check(const MachineView& m, const Board& board, const Binding& binding, TableIndexView r) {
    const auto first_fault = [&]() -> Sentence {
        if (Sentence fault = checks::check_components(m, r); !fault.empty()) return fault;
        if (Sentence fault = checks::check_activities(m, r); !fault.empty()) return fault;
        if (Sentence fault = checks::check_observers(m, r); !fault.empty()) return fault;
        if (Sentence fault = checks::check_interpreter(m, r); !fault.empty()) return fault;
        if (Sentence fault = checks::check_connections(m, r); !fault.empty()) return fault;
        if (Sentence fault = checks::check_watches(m, r); !fault.empty()) return fault;
        if (Sentence fault = checks::order_components(m, r); !fault.empty()) return fault;
        if (Sentence fault = checks::check_reactions(m, r); !fault.empty()) return fault;
        if (Sentence fault = checks::check_uses(m, r); !fault.empty()) return fault;
        if (Sentence fault = checks::check_reach(m, r); !fault.empty()) return fault;
        if (Sentence fault = checks::check_behaviours(m, r); !fault.empty()) return fault;
        if (Sentence fault = checks::check_controls(m, r); !fault.empty()) return fault;
        if (Sentence fault = checks::check_wakes(m, r); !fault.empty()) return fault;
        if (Sentence fault = checks::check_devices(m, board, binding); !fault.empty()) return fault;
        if (Sentence fault = checks::check_schedulability(m, board, binding, r); !fault.empty()) return fault;
        if (Sentence fault = checks::check_stop(m, board, r); !fault.empty()) return fault;
        if (Sentence fault = checks::check_traffic(m, board, binding, r); !fault.empty()) return fault;
        for (std::size_t e = 0; e < m.extras->size(); ++e) {
            const std::string_view once = m.extras->at(e)->stands_once();
            for (std::size_t other = 0; other < e && !once.empty(); ++other)
                if (same_text(m.extras->at(other)->stands_once(), once))
                    return Sentence{once, "(...) appears twice; write all of its rows into one"};
            if (Sentence fault = m.extras->at(e)->check(m, r); !fault.empty()) return fault;
        }
        return {};
    };
    const Sentence fault = first_fault();
    return fault.empty() ? fault : Sentence{m.name, ": ", fault};
}

} // namespace tappet
