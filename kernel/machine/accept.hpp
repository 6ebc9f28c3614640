// Accepts a table at run time: the check, the plan and the map of Firmware are compiled once, instead of
// being interpreted by the compiler in each file that has a table. For tests and tools: programs whose tables
// are not known before, or that read refusals. The compiler accepts a machine that is flashed.
#pragma once

#include "kernel/machine/plan/places.hpp"
#include "kernel/machine/table/machine.hpp"

#include <memory>

namespace tappet {

/// Not real-time; allocates from the heap, and frees it.
class Accepted {
public:
    /// `board`, `binding` and the objects that the table's rows name must outlive it.
    explicit Accepted(const MachineView& table, const Board& board, const Binding& binding = unbound);
    Accepted(Accepted&&) noexcept;
    Accepted& operator=(Accepted&&) noexcept;
    ~Accepted();

    /// Says why the table is refused, in the words of the compiler; empty: it is accepted.
    [[nodiscard]] const Sentence& refusal() const noexcept;
    /// Returns the machine for a MachineInstance, which must not outlive this object. For a refused table it
    /// ends the program with the refusal.
    [[nodiscard]] AcceptedMachine machine();

private:
    struct Tables;
    std::unique_ptr<Tables> tables_;
};

/// Replaces Firmware where the table is a constant nevertheless. Like there, all instances made of it share
/// one memory: one at a time.
template <const auto& table, const Board& board, const Binding& binding = unbound>
struct AtRunTime {
    static AcceptedMachine machine() {
        static Accepted accepted{table.view(), board, binding};
        return accepted.machine();
    }
};

} // namespace tappet
