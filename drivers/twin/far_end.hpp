// The other end of one device's wires, as a plant holds it: what the machine sends comes in here, what the
// plant sets goes out to it. The same plant stands behind twins and behind the real drivers.
#pragma once

#include "kernel/base/bounded.hpp"
#include "kernel/base/contract.hpp"
#include "kernel/base/text.hpp"
#include "kernel/base/time.hpp"
#include "kernel/component/setup.hpp"

#include <span>
#include <string_view>

namespace tappet {

class FarEnd;
/// Those of one plant, in the order in which it declares them.
using FarEnds = Bounded<FarEnd*, 16>;

/// Not real-time; one thread, the plant's.
class FarEnd {
public:
    /// `device` as the machine's table names it; the characters outlive the end.
    FarEnd(FarEnds& of, std::string_view device, std::string_view kind) : device_{device}, kind_{kind} {
        const bool has_room = of.push(this);
        TAPPET_CONTRACT(has_room, Contract::index_out_of_range, 16, 16);
    }
    FarEnd(const FarEnd&) = delete;
    FarEnd& operator=(const FarEnd&) = delete;
    virtual ~FarEnd() = default;

    /// Takes the wire of its device out of those that a world has. The error names the device.
    Sentence connect(std::span<const ProvidedDevice> wires) {
        for (const ProvidedDevice& wire : wires)
            if (wire.name == device_ && take_wire(wire)) return {};
        return Sentence{"the plant stands at the other end of ", kind_, " device \"", device_,
                        "\", which the machine does not have; correct the name in the plant"};
    }
    /// Takes in what the machine put on the wires by `now`.
    virtual void take(Time now) = 0;
    /// Puts on the wires what the plant set.
    virtual void give(Time now) = 0;
    /// When give() has something to do that nobody asks for: the next frame that goes out by itself.
    [[nodiscard]] virtual Time next() const noexcept { return never; }

protected:
    virtual bool take_wire(const ProvidedDevice& wire) noexcept = 0;

    /// Not defined and not a constant: the compiler's message names it when a plant names what its map has
    /// not.
    static void this_name_is_not_in_the_map_or_goes_the_other_way();

private:
    std::string_view device_;
    std::string_view kind_;
};

} // namespace tappet
