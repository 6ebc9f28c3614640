// Frames and registers as they are on the wires, for tests that compare them with a device's manual: a map
// that machine and plant share has its faults on both sides.
#pragma once

#include "drivers/modbus/register_map.hpp"
#include "drivers/plant/simulation.hpp"

#include <map>
#include <string>
#include <utility>

namespace tappet {

/// Not real-time.
class RawWires {
public:
    /// After the devices were opened: keeps the last frame of each identifier from now on.
    void look_at(SimulatedDevices& devices);

    /// Returns the data bytes of the last frame, whoever sent it, as `tappet wires` prints them, "98 3A"; a
    /// sentence when there was none.
    [[nodiscard]] std::string frame_on(std::string_view bus, can::Identifier id) const;
    /// Returns the words or bits of a server as they are now, "01A4 0000" or "1 0"; a sentence when an
    /// address is beyond those of a simulated server.
    [[nodiscard]] std::string words_at(std::string_view server, const modbus::Run& run) const;

private:
    SimulatedDevices* devices_ = nullptr;
    std::map<std::pair<std::string, std::uint32_t>, can::Frame> last_{}; ///< by bus and place in arbitration
};

} // namespace tappet
