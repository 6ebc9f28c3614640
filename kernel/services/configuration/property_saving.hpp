// Saves the properties of a machine that runs: each component is copied in its own engine between two steps,
// and written by whoever asked.
#pragma once

#include "kernel/machine/instance/instance.hpp"
#include "kernel/services/engine_call.hpp"

namespace tappet {

/// Of a component that sees the machine: begin(), then step() in each of its cycles until it says that
/// nothing is left. May block on the file; takes no heap. Large: in static memory.
class PropertySaving {
public:
    /// An engine that does not come to be copied for so long is left out, and told of.
    static constexpr Duration patience = 1s;

    /// `activity`: the one that calls; components in it stand still meanwhile. Of one component, or of all.
    void begin(MachineInstance& machine, std::size_t activity, std::size_t component = nowhere) noexcept;
    /// False when every file is written or has its fault.
    bool step() noexcept;
    [[nodiscard]] bool busy() const noexcept { return busy_; }
    [[nodiscard]] std::size_t saved() const noexcept { return saved_; }
    /// The first fault; empty: none.
    [[nodiscard]] const Sentence& fault() const noexcept { return fault_; }
    /// An engine did not come: what is at fault is the moment.
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
    EngineCall call_{}; ///< that copies
    Time asked_at_{};   ///< or when its turn came
};

} // namespace tappet
