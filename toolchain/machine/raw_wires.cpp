// Keeps the last frame of each identifier, and prints bytes and words.
#include "toolchain/machine/raw_wires.hpp"

#include "toolchain/machine/wires_text.hpp"

namespace tappet {

void RawWires::look_at(SimulatedDevices& devices) {
    devices_ = &devices;
    last_.clear();
    devices.look_at_frames([this](std::string_view bus, const can::Frame& frame) {
        last_[{std::string{bus}, can::arbitration(frame)}] = frame;
    });
}

std::string RawWires::frame_on(std::string_view bus, can::Identifier id) const {
    const auto found =
        last_.find({std::string{bus}, can::arbitration({.id = id.id, .extended = id.extended})});
    if (found == last_.end())
        return "no frame 0x" + in_hex(id.id, 3) + " came on \"" + std::string{bus} + "\"";
    std::string bytes;
    for (std::size_t i = 0; i < found->second.length; ++i)
        bytes += (i == 0 ? "" : " ") + in_hex(found->second.data[i], 2);
    return bytes;
}

std::string RawWires::words_at(std::string_view server, const modbus::Run& run) const {
    if (run.address + run.count > modbus::ServerTables::size) return "a simulated server has no such address";
    std::string words;
    for (std::size_t i = 0; i < run.count; ++i)
        words += (i == 0 ? "" : " ") + in_hex(devices_->server(server).get(run.table, run.address + i),
                                              modbus::holds_bits(run.table) ? 1 : 4);
    return words;
}

} // namespace tappet
