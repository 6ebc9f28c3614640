// The other end of one device's wires, as a plant holds it: what the machine sends comes in here, what the
// plant sets goes out to it. The same plant stands behind twins and behind the real drivers.
#pragma once

#include "kernel/base/bounded.hpp"
#include "kernel/base/contract.hpp"
#include "kernel/base/nearest.hpp"
#include "kernel/base/text.hpp"
#include "kernel/base/time.hpp"
#include "kernel/component/setup.hpp"

#include <algorithm>
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

    // ---- for what takes names

    /// Not defined and not a constant: the compiler's message names it when a plant names what its map has
    /// not.
    static void this_name_is_not_in_the_map_or_goes_the_other_way();
    /// Its arguments stand in clang's message: the name that is nearest, of a signal its frame's before it.
    template <class Character>
    static constexpr void did_you_mean(const Character* of, const Character* name) {
        if (of != name || name == nullptr) // always: g++ says less of what may be a constant
            this_name_is_not_in_the_map_or_goes_the_other_way();
    }
    struct Meant {
        std::string_view of{}, name{};
    };
    /// The nearest of those that `names(i)` gives; those without a name are left out.
    template <class Names>
    static constexpr Meant nearest_to(std::string_view written, std::size_t count, const Names& names) {
        Meant meant;
        std::size_t least = std::max<std::size_t>(2, written.size() / 3) + 1;
        for (std::size_t i = 0; i < count; ++i) {
            const Meant each = names(i);
            if (each.name.empty()) continue;
            const Sentence whole{each.of, each.of.empty() ? "" : ".", each.name};
            const std::size_t far = edit_distance(written, whole.view(), least);
            if (far >= least) continue;
            least = far;
            meant = each;
        }
        return meant;
    }

protected:
    virtual bool take_wire(const ProvidedDevice& wire) noexcept = 0;

private:
    std::string_view device_;
    std::string_view kind_;
};

} // namespace tappet
