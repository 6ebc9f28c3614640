// A CAN bus in the rows of a board, and the checks of the board's table.
#pragma once

#include "kernel/base/time.hpp"
#include "kernel/component/device_kind.hpp"

#include <cstdint>

namespace tappet {

namespace can {

inline constexpr Word bit_rate_word{.name = "bit_rate", .kind = "can", .is_for_box = true};
inline constexpr Word bus_errors_word{.name = "bus_errors", .kind = "can"};

/// A board's facts about a bus. Rates in bit/s; 0: not stated.
struct BusFacts {
    std::uint32_t bit_rate = 0;
    std::uint32_t data_bit_rate = 0; ///< of CAN FD frames that switch bit rate; 0: classical CAN only
    unsigned errors = 1;             ///< errors on the wire: this many at once ..
    Duration errors_every = 100ms;   ///< .. and one more after each such time
};
constexpr BusFacts bus_facts(std::span<const Fact> of_board) noexcept {
    BusFacts bus;
    if (const Fact* rate = said(of_board, bit_rate_word); rate != nullptr) {
        bus.bit_rate = static_cast<std::uint32_t>(rate->numbers[0]);
        bus.data_bit_rate = static_cast<std::uint32_t>(rate->numbers[1]);
    }
    if (const Fact* errors = said(of_board, bus_errors_word); errors != nullptr) {
        bus.errors = static_cast<unsigned>(errors->numbers[0]);
        bus.errors_every = Duration{errors->numbers[1]};
    }
    return bus;
}

constexpr Sentence check_bus(const DeviceAsked& asked) {
    const BusFacts bus = bus_facts(asked.of_board);
    if (bus.bit_rate == 0)
        return Sentence{"device \"", asked.device,
                        "\" states no bit rate; add bit_rate(500'000), or what its bus runs at, to the "
                        "board's row"};
    if (bus.data_bit_rate != 0 && bus.data_bit_rate < bus.bit_rate)
        return Sentence{"device \"", asked.device, "\" has a data phase of ", bus.data_bit_rate,
                        " bit/s, slower than its arbitration; write the faster one as the second, "
                        "bit_rate(500'000, 2'000'000)"};
    return {};
}

inline constexpr DeviceKind device_kind{.name = "can", .check = &check_bus};

} // namespace can

/// States the bit rate in bit/s that the bus is wired and terminated for; the second is that of CAN FD's data
/// phase.
constexpr Fact bit_rate(std::uint32_t bits_per_second, std::uint32_t in_data_phase = 0) noexcept {
    return {&can::bit_rate_word, {}, {bits_per_second, in_data_phase}};
}
/// States how many errors on the wire the response times allow for: `at_once`, and one more after each
/// `every`. Each error costs an error frame and the frame it destroyed. Without this row: one in 100 ms.
constexpr Fact bus_errors(unsigned at_once, Duration every) noexcept {
    return {&can::bus_errors_word, {}, {at_once, every.count()}};
}

} // namespace tappet
