// The wait-freedom of object code: every cycle of a function, and of what it calls, must be a counted one.
//
// A cycle is a set of instructions each of which reaches every other. It is counted when
//   1. it is entered at one instruction only, its header;
//   2. one of its conditional jumps leaves it and lies on every path from the header back to the header; or
//   several do
//      that compare the same, one of them on each such path;
//   3. that jump compares a counter with a bound: the counter is a register or a slot of the frame that, on
//   every
//      path from the header back to it, grows (or shrinks) by a constant that is not zero, whatever else
//      happens; the bound is a constant, or a register or slot of the frame that no path through the cycle
//      changes;
//   4. the jump leaves on the side to which the counter moves;
//   5. without the header, the cycles that are left in it are counted too.
// So a cycle that goes on until memory says otherwise is never a counted one: that is what a retry is,
// whether it is written as a loop or made by the compiler of an atomic operation whose result is used. A jump
// backwards that closes no cycle is the compiler's layout. Instructions with a count of their own (rep movs)
// count themselves. Assumed: the compiler writes a slot that it spills to by the slot's own address only, and
// a called function leaves the caller's slots and the registers that the calling convention preserves.
#pragma once

#include "tests/waitfree/disassembly.hpp"

#include <cstdint>
#include <optional>
#include <set>
#include <string>
#include <vector>

namespace tappet::waitfree {

/// One cycle of one function.
struct Loop {
    std::string function;
    std::uint64_t address = 0;           ///< of its header
    std::string counter;                 ///< empty: it is not counted
    std::optional<std::uint64_t> passes; ///< at most, when counter and bound begin with known values
    std::string fault;                   ///< why it is not counted
};

/// The cycles of one function.
[[nodiscard]] std::vector<Loop> loops_of(const Function& function);

/// What may be called beside the functions whose code is seen.
struct Permission {
    std::set<std::string> outside; ///< functions of other libraries
    bool given_calls = false;      ///< the call of a function pointer: a handler's steps are the handler's
};

struct Verdict {
    std::vector<std::string> faults; ///< one sentence each; empty: wait-free
    std::vector<Loop> loops;
    std::set<std::string> functions; ///< whose code was seen
    std::set<std::string> outside;   ///< called with permission
    bool makes_given_calls = false;
};

/// The function `root` and all that it calls.
[[nodiscard]] Verdict check(const Program& program, const std::string& root, const Permission& permission);

} // namespace tappet::waitfree
