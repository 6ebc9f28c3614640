// A table, accepted while the program runs: the check, the plan and the map of Firmware, compiled once
// instead of interpreted by the compiler in each file that has a table. For programs whose tables are not
// known before, or whose refusals are read: tests and tools. A machine that is flashed is accepted by the
// compiler.
#pragma once

#include "kernel/machine/plan/places.hpp"
#include "kernel/machine/table/machine.hpp"

#include <memory>

namespace tappet {

/// Not real-time; takes memory from the heap, and gives it back.
class Accepted {
public:
    /// `board`, `binding` and what the table's rows name outlive it.
    explicit Accepted(const MachineView& table, const Board& board, const Binding& binding = unbound);
    Accepted(Accepted&&) noexcept;
    Accepted& operator=(Accepted&&) noexcept;
    ~Accepted();

    /// Why the table cannot work, in the words of the compiler; empty: it is accepted.
    [[nodiscard]] const Sentence& refusal() const noexcept;
    /// For a MachineInstance, which this outlives. Of a table that is refused it ends the program with the
    /// refusal.
    [[nodiscard]] AcceptedMachine machine();

private:
    struct Tables;
    std::unique_ptr<Tables> tables_;
};

/// In place of Firmware where the table is a constant all the same. As there, all that is made of it share
/// one memory: one at a time.
template <const auto& table, const Board& board, const Binding& binding = unbound>
struct AtRunTime {
    static AcceptedMachine machine() {
        static Accepted accepted{table.view(), board, binding};
        return accepted.machine();
    }
};

} // namespace tappet
