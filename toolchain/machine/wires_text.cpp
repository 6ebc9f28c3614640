// Encodes one value for each signal and each register by the encoders of the drivers.
#include "toolchain/machine/wires_text.hpp"

#include "drivers/can/signal_store.hpp"
#include "drivers/hardware/devices.hpp"
#include "drivers/modbus/register_map.hpp"

#include <algorithm>
#include <iomanip>
#include <sstream>

namespace tappet {

namespace {

constexpr double usual_example = 1.5;

template <class... Parts>
std::string joined(const Parts&... parts) {
    std::ostringstream out;
    out << std::setprecision(10);
    (out << ... << parts);
    return out.str();
}
std::string padded(std::string words, std::size_t width) {
    words.resize(std::max(words.size() + 1, width), ' ');
    return words;
}
std::string in_ms(Duration time) { return joined(static_cast<double>(time.count()) * 1e-6, " ms"); }

/// A line of one value: its name, the value in its unit, and its form on the wire.
std::string line_of(const MapValue& value, double physical, std::string wire) {
    wire.erase(wire.find_last_not_of(' ') + 1);
    return "    " + padded(std::string{value.name}, 24) + padded(joined(physical, " ", value.unit), 16) +
           wire + "\n";
}

// ---- CAN

/// A frame of one signal and the multiplexors that select it, as its bus encodes them.
class OneSignal {
public:
    OneSignal(const can::FrameRow& row, std::span<const can::Signal> of_row, const can::Signal& signal) {
        add(of_row, signal);
        map_.frames[0] = row;
        map_.frames[0].first = 0;
        map_.frames[0].values = count_;
        static_cast<void>(can::detail::complete(map_, 1)); // its bus's map has no faults
        for (std::size_t s = 0; s + 1 < count_; ++s) select(s, map_.signals[s + 1].selections[0].from);
        set(!signal.has_range  ? (can::is_integer(signal) ? 1.0 : usual_example)
            : signal.most != 0 ? signal.most // zero would show no byte
                               : signal.least);
        if (!signal.has_range && store_.physical(count_ - 1) == signal.offset)
            set(signal.offset + signal.factor);
    }

    [[nodiscard]] std::string describe() const {
        const can::Frame frame = store_.encode(0, {});
        std::array<bool, sizeof(can::Payload)> is_covered{};
        for (std::size_t s = 0; s < count_; ++s)
            for (unsigned i = 0; i < map_.signals[s].bits; ++i)
                is_covered[can::bit_place(map_.signals[s], i) / 8] = true;
        std::string bytes;
        for (std::size_t i = 0; i < frame.length; ++i)
            bytes += is_covered[i] ? in_hex(frame.data[i], 2) + " " : "-- ";
        for (std::size_t s = 0; s + 1 < count_; ++s)
            bytes += joined(s == 0 ? " while " : " and ", map_.signals[s].name, " is ",
                            map_.signals[s + 1].selections[0].from);
        return line_of(map_.signals[count_ - 1], store_.physical(count_ - 1), std::move(bytes));
    }

private:
    /// Adds the signal behind its multiplexors, the outermost first.
    void add(std::span<const can::Signal> of_row, const can::Signal& signal) {
        for (const can::Signal& each : of_row)
            if (!signal.multiplexor.empty() && each.name == signal.multiplexor) add(of_row, each);
        TAPPET_CONTRACT(count_ < most, Contract::index_out_of_range, static_cast<std::int64_t>(count_), most);
        map_.signals[count_++] = signal;
    }
    /// Sets a multiplexor as the driver sets it; no range limits what another node sends.
    void select(std::size_t s, std::uint32_t page) {
        if (map_.frames[0].direction == can::Direction::transmit)
            store_.set_integer(s, can::to_integer(map_.signals[s], page));
        else
            store_.set_bits(s, page);
    }
    void set(double value) {
        const std::size_t last = count_ - 1;
        if (can::is_integer(map_.signals[last]))
            store_.set_integer(last, static_cast<std::int64_t>(std::clamp(value, -exact, exact)));
        else
            store_.set_physical(last, value);
    }

    static constexpr double exact = 0x1p53; ///< integers up to it are doubles
    static constexpr std::size_t most = 16; ///< the signal, and the multiplexors that select each other
    can::SignalMap<1, most> map_{};
    can::SignalStore<1, most> store_{map_};
    std::size_t count_ = 0;
};

std::string describe_bus(const can::Identifiers& map) {
    std::string all;
    for (const can::FrameRow& row : map.frames) {
        constexpr std::array way{"received", "sent", "between other nodes"};
        const auto [id, is_extended] = row.identifier;
        all += joined(
            "  0x", in_hex(id, is_extended ? 8 : 3), is_extended ? " extended, " : " standard, ",
            unsigned{row.length}, row.format == can::Format::classical ? " bytes, " : " bytes CAN FD, ",
            way[static_cast<std::size_t>(row.direction)],
            row.every > Duration::zero() ? " every " + in_ms(row.every) : " on demand", ": ", row.name, "\n");
        const auto of_row = map.signals.subspan(row.first, row.values);
        for (const can::Signal& signal : of_row) all += OneSignal{row, of_row, signal}.describe();
    }
    return all;
}

// ---- Modbus

std::string describe_register(const modbus::Row& row, const modbus::Register& one) {
    modbus::Encoded encoded = modbus::to_words(one, usual_example);
    if (encoded.words == modbus::Words{}) encoded = modbus::to_words(one, one.offset + one.factor);
    std::string wire = joined(row.run.address + one.at, ": ");
    for (unsigned w = 0; w < one.width(); ++w)
        wire +=
            modbus::holds_bits(row.run.table) ? joined(encoded.words[w]) : in_hex(encoded.words[w], 4) + " ";
    return line_of(one, modbus::to_physical(one, encoded.words), std::move(wire));
}

std::string describe_server(const modbus::SafeWrites& map) {
    std::string all;
    for (const modbus::Row& row : map.rows) {
        all +=
            joined("  function ", modbus::function_code(row.run.table, row.write),
                   row.write ? ", writes " : ", reads ", row.run.count, " ", modbus::name_of(row.run.table),
                   " from address ", row.run.address, ", every ", in_ms(row.every), ": ", row.name, "\n");
        for (const modbus::Register& one : map.registers.subspan(row.first, row.values))
            all += describe_register(row, one);
    }
    return all;
}

} // namespace

std::string in_hex(std::uint64_t number, int digits) {
    std::ostringstream out;
    out << std::hex << std::uppercase << std::setw(digits) << std::setfill('0') << number;
    return out.str();
}

std::string describe_wires(const MachineView& table) {
    std::string all;
    for (const ComponentRow& row : table.components) {
        if (drives(row, "can"))
            all += joined(row.name, ": CAN bus \"", row.device, "\"\n",
                          describe_bus(*static_cast<const can::Identifiers*>(row.type->device_map)));
        if (drives(row, "modbus"))
            all += joined(row.name, ": Modbus server \"", row.device, "\"\n",
                          describe_server(*static_cast<const modbus::SafeWrites*>(row.type->device_map)));
    }
    if (all.empty()) return "the machine has neither a CAN bus nor a Modbus server\n";
    return "One value of each signal and register, and its form on the wire: compare it with the device's "
           "manual.\n"
           "CAN: the data bytes, the first one first; the signal has no bits in --.\n"
           "Modbus: the address, counted from 0, and its words; manuals may call address 0 30001, 40001 or "
           "1.\n" +
           all;
}

} // namespace tappet
