// Opening the real devices: each is looked up by its name in the board, and a wrong board is a sentence.
#include "apps/carpet_loom/firmware/devices.hpp"

#include <charconv>

namespace tappet::carpet {

namespace {

const BoardDevice* find(const Board& board, std::string_view name) {
    for (const BoardDevice& device : board.devices)
        if (device.name == name) return &device;
    return nullptr;
}

} // namespace

std::expected<void, Sentence> Devices::open(const Board& board) {
    struct Opening {
        std::string_view name;
        std::expected<void, Sentence> (Devices::*open)(const BoardDevice&);
    };
    constexpr Opening openings[] = {{"loom-can", &Devices::open_can},
                                    {"loom-io", &Devices::open_lines},
                                    {"loom-utility", &Devices::open_utility}};
    for (const Opening& each : openings) {
        const BoardDevice* device = find(board, each.name); // the table's check has found it in the board
        if (device == nullptr)
            return std::unexpected(Sentence{"board \"", board.name, "\" has no device \"", each.name, "\""});
        if (auto opened = (this->*each.open)(*device); !opened)
            return std::unexpected(Sentence{"board \"", board.name, "\", device \"", each.name, "\" at \"",
                                            device->address, "\": ", opened.error()});
    }
    provided_ = {{{type_id<can::Device>, "loom-can", static_cast<can::Device*>(&can_)},
                  {type_id<gpio::Device>, "loom-io", static_cast<gpio::Device*>(&lines_)},
                  {type_id<modbus::Transport>, "loom-utility", static_cast<modbus::Transport*>(&utility_)}}};
    return {};
}

std::expected<void, Sentence> Devices::open_can(const BoardDevice& device) {
    can::Settings settings;
    settings.interface = device.address;
    settings.bit_rate = device.bit_rate.bits_per_second;
    settings.receive = can_signals.receives();
    settings.transmit = can_signals.transmits();
    return can_.open(settings);
}

std::expected<void, Sentence> Devices::open_lines(const BoardDevice& device) {
    const auto placed = gpio::placed(io_lines, [&device](std::string_view name) {
        for (const BoardLine& line : device.lines)
            if (line.name == name) return static_cast<int>(line.offset);
        return -1;
    });
    if (!placed) return std::unexpected(placed.error());
    placed_lines_ = *placed;
    return lines_.open({device.address, placed_lines_});
}

std::expected<void, Sentence> Devices::open_utility(const BoardDevice& device) {
    const std::size_t colon = device.address.find(':');
    std::uint16_t port = 0;
    const std::string_view digits =
        colon == std::string_view::npos ? std::string_view{} : device.address.substr(colon + 1);
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), port);
    if (error != std::errc{} || end != digits.data() + digits.size())
        return std::unexpected(Sentence{"the address has no port; write it as 192.168.7.2:502"});
    return utility_.open(
        {modbus::Tcp{device.address.substr(0, colon), port}, loom::wires::modbus::unit, 300ms});
}

} // namespace tappet::carpet
