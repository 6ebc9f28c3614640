// A binding: the board devices and lines that one machine uses, and the processors that run its activities.
// The machine's table names its devices, the board lists those of the box: the binding connects the two.
#pragma once

#include "kernel/base/bounded.hpp"
#include "kernel/component/device_kind.hpp"

#include <array>
#include <concepts>
#include <cstdint>
#include <span>
#include <string_view>

namespace tappet {

struct BoundDevice {
    std::string_view name{};          ///< logical, as in the machine's table
    std::string_view at{};            ///< the board's device, or an address: "192.168.7.2:502"
    std::size_t first = 0, count = 0; ///< of the binding's facts; see Binding::facts_of
};

/// A row of a binding before it is added.
template <std::size_t words>
struct Wired {
    std::string_view name{}, at{};
    std::array<Fact, words> facts{};
};

/// The processor that an activity is bound to.
struct Placement {
    std::string_view activity{};
    int processor = 0;
};

/// The evidence that a new version works on its box: this output has reached `count`, and no deadline was
/// missed.
struct Proof {
    std::string_view output{}; ///< of whole numbers: "weft.picks_woven"; "": one minute of running is enough
    std::int64_t count = 0;
};

struct Binding {
    Bounded<BoundDevice, 16> devices{};
    Bounded<Fact, 256> facts{}; ///< of all devices, in the order of the devices
    Bounded<Placement, 64> placement{};
    Proof proof{};
    bool too_many = false; ///< more rows than the binding can hold: the check refuses it

    [[nodiscard]] constexpr std::span<const Fact> facts_of(const BoundDevice& device) const noexcept {
        return std::span{facts.items}.subspan(device.first, device.count);
    }
    template <std::size_t words> constexpr void add(const Wired<words>& row) {
        too_many |= !devices.push({row.name, row.at, facts.size(), words});
        for (const Fact& each : row.facts) too_many |= !facts.push(each);
    }
    constexpr void add(const Binding& other) {
        const std::size_t before = facts.size();
        for (const Fact& each : other.facts) too_many |= !facts.push(each);
        for (BoundDevice each : other.devices) {
            each.first += before;
            too_many |= !devices.push(each);
        }
        for (const Placement& each : other.placement) add(each);
        if (!other.proof.output.empty()) proof = other.proof;
        too_many |= other.too_many;
    }
    constexpr void add(const Placement& row) { too_many |= !placement.push(row); }
    constexpr void add(const Proof& row) { proof = row; }
};

/// The binding of a machine without devices whose activities all run on the board's default processor, and of
/// any machine on a simulated board.
inline constexpr Binding unbound{};

/// Binds an activity to a processor. Default: the board's default processor.
constexpr Placement place(std::string_view activity, int processor) noexcept { return {activity, processor}; }

/// proven_by("weft.picks_woven", 100): the box keeps a new version once the output has reached 100.
constexpr Proof proven_by(std::string_view output, std::int64_t count) noexcept { return {output, count}; }

/// wired("loom-can", "can0")
/// wired("loom-io", "io", line("brake", 9), ...)
/// wired("loom-utility", "192.168.7.2:502", unit(1), answer_within(300ms))
/// wired("loom-utility", "serial1", unit(1), serial_line(19'200, 'E', 1))
/// The driver's kind.hpp declares the words, for example drivers/gpio/kind.hpp.
template <std::same_as<Fact>... Facts>
constexpr Wired<sizeof...(Facts)> wired(std::string_view name, std::string_view at, const Facts&... facts) {
    return {name, at, {facts...}};
}

/// binding(wired(...), ..., place("can", 3), ..., proven_by("weft.picks_woven", 100))
/// binding(bench, place("can", 1)): all rows of another binding, and more.
template <class... Rows>
constexpr Binding binding(const Rows&... rows) {
    Binding binding;
    (binding.add(rows), ...);
    return binding;
}

} // namespace tappet
