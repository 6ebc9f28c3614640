// Saves the properties of a running machine: the engine of each component copies it between two steps, and
// the caller writes the copy.
#pragma once

#include "kernel/machine/instance/instance.hpp"
#include "kernel/services/engine_call.hpp"

namespace tappet {

/// For a component that sees the machine: call begin(), then step() in each of its cycles until it returns
/// false. May block on the file; allocates no heap. Large: place it in static memory.
class PropertySaving {
public:
    /// An engine that does not copy within this time is skipped and reported.
    static constexpr Duration patience = 1s;

    /// Begins to save one component, or all. `activity`: the caller's; components in it do not step
    /// meanwhile.
    void begin(MachineInstance& machine, std::size_t activity, std::size_t component = nowhere) noexcept;
    /// Continues. False when every file is written or has its fault.
    bool step() noexcept;
    [[nodiscard]] bool busy() const noexcept { return busy_; }
    [[nodiscard]] std::size_t saved() const noexcept { return saved_; }
    /// Returns the first fault; empty: none.
    [[nodiscard]] const Sentence& fault() const noexcept { return fault_; }
    /// Whether an engine did not answer: try again later.
    [[nodiscard]] bool gave_up() const noexcept { return gave_up_; }

private:
    void ask(std::size_t component) noexcept;
    void give_up() noexcept;
    [[nodiscard]] bool is_reached() noexcept;
    void write() noexcept;

    MachineInstance* machine_ = nullptr;
    std::size_t activity_ = 0;
    std::size_t next_ = 0; ///< component
    std::size_t end_ = 0;
    std::size_t saved_ = 0;
    bool busy_ = false;
    bool asked_ = false, gave_up_ = false;
    Sentence fault_{};
    PropertyTransaction copy_{};
    EngineCall call_{}; ///< the call that copies
    Time asked_at_{};   ///< or when its turn came
};

} // namespace tappet
