// The other end of digital lines: the switches, valves and lamps in a machine's line map.
#pragma once

#include "drivers/gpio/line_map.hpp"
#include "drivers/twin/far_end.hpp"
#include "kernel/base/array_of.hpp"

#include <array>

namespace tappet::gpio {

/// Lines as seen from outside the chip. Levels are logical; lines are numbered as in the machine's map.
class Wires {
public:
    Wires() = default;
    Wires(const Wires&) = delete;
    Wires& operator=(const Wires&) = delete;
    virtual ~Wires() = default;

    /// Changes an input of the machine at `at`. Returns false when it is no input or the wire refuses.
    virtual bool drive(std::size_t line, bool active, Time at) noexcept = 0;
    /// Returns the outputs as the machine drives them, one bit per line.
    [[nodiscard]] virtual Mask outputs() const noexcept = 0;
    /// Returns when the outputs shown at `now` changed, as exactly as this wire can tell.
    [[nodiscard]] virtual Time changed_at(Time now) const noexcept { return now; }
};

/// Access by the names of the map, which the compiler checks:
///     io.get("valve")                     as the machine drives it
///     io.set("bottle_present", true)      in this move(), or at a given time not before it
template <const auto& map>
class FarEnd final : public FarEndOf<Wires> {
    TAPPET_ACCEPTED(map.fault);

    template <Role role>
    static constexpr auto names = array_of<map.rows.size()>([](std::size_t i) {
        return map.rows[i].line.role == role ? MapName{{}, map.rows[i].line.name} : MapName{};
    });

public:
    using Input = FarEndName<names<Role::input>>; ///< of the machine
    using Output = FarEndName<names<Role::output>>;

    FarEnd(FarEnds& of, std::string_view device) : FarEndOf{of, device, "gpio"} {}

    [[nodiscard]] bool get(Output line) const noexcept { return (outputs_ >> line.index & 1u) != 0; }
    /// Returns true when the machine changed it since the plant's last move().
    [[nodiscard]] bool changed(Output line) const noexcept {
        return ((outputs_ ^ before_) >> line.index & 1u) != 0;
    }
    /// Returns the time of the change that changed() reports.
    [[nodiscard]] Time changed_at() const noexcept { return changed_at_; }
    void set(Input line, bool active) noexcept { set(line, active, now_); }
    void set(Input line, bool active, Time at) noexcept {
        const Mask bit = Mask{1} << line.index;
        if (((inputs_ & bit) != 0) == active) return;
        inputs_ ^= bit;
        if (wire_ == nullptr) return; // applied once the wires exist
        refused_ += wire_->drive(line.index, active, at) ? 0u : 1u;
    }

    void take(Time now) override {
        now_ = now;
        before_ = outputs_;
        outputs_ = wire_->outputs();
        changed_at_ = wire_->changed_at(now);
    }

protected:
    bool take_wire(const ProvidedDevice& provided) noexcept override {
        if (!FarEndOf::take_wire(provided)) return false;
        outputs_ = before_ = 0;
        for (std::size_t i = 0; i < map.rows.size(); ++i)
            if ((inputs_ >> i & 1u) != 0) refused_ += wire_->drive(i, true, now_) ? 0u : 1u;
        return true;
    }

private:
    Mask inputs_ = 0;
    Mask outputs_ = 0;
    Mask before_ = 0;
    Time now_{};
    Time changed_at_{};
};

} // namespace tappet::gpio
