// The plant's end of one device's wires: receives what the machine sends, and sends what the plant sets. The
// same plant works with twins and with the real drivers.
#pragma once

#include "drivers/map/rows.hpp"
#include "kernel/base/bounded.hpp"
#include "kernel/base/contract.hpp"
#include "kernel/base/nearest.hpp"
#include "kernel/base/text.hpp"
#include "kernel/base/time.hpp"
#include "kernel/component/setup.hpp"

#include <algorithm>
#include <cstdint>
#include <span>
#include <string_view>

namespace tappet {

class FarEnd;
/// The far ends of one plant, in the order of their declaration.
using FarEnds = Bounded<FarEnd*, 16>;

/// Not real-time; only the plant's thread.
class FarEnd {
public:
    /// `device`: its name in the machine's table; the characters must outlive the far end.
    FarEnd(FarEnds& of, std::string_view device, std::string_view kind) : device_{device}, kind_{kind} {
        const bool has_room = of.push(this);
        TAPPET_CONTRACT(has_room, Contract::index_out_of_range, 16, 16);
    }
    FarEnd(const FarEnd&) = delete;
    FarEnd& operator=(const FarEnd&) = delete;
    virtual ~FarEnd() = default;

    /// Selects its device's wire from those of a world. The error names the device.
    Sentence connect(std::span<const ProvidedDevice> wires) {
        for (const ProvidedDevice& wire : wires)
            if (wire.name == device_ && take_wire(wire)) return {};
        return Sentence{"the plant stands at the other end of ", kind_, " device \"", device_,
                        "\", which the machine does not have; correct the name in the plant"};
    }
    /// Receives what the machine put on the wires by `now`.
    virtual void take(Time /*now*/) {}
    /// Sends what the plant set.
    virtual void give(Time /*now*/) {}
    /// Returns when give() has something to send by itself: the next periodic frame.
    [[nodiscard]] virtual Time next() const noexcept { return never; }

protected:
    virtual bool take_wire(const ProvidedDevice& wire) noexcept = 0;

private:
    std::string_view device_;
    std::string_view kind_;
};

/// Neither defined nor constexpr: the compiler's message names it when a plant's name is not in the map. Not
/// a member, which would have the linkage of a map in an unnamed namespace and then must be defined.
void this_name_is_not_in_the_map_or_goes_the_other_way();

/// A name that a plant writes, checked at compile time: one of `names`, of which empty ones do not count.
template <const auto& names>
struct FarEndName {
    std::size_t index = 0; ///< in `names`

    consteval FarEndName(const char* written) {
        MapName meant;
        std::size_t least = std::max<std::size_t>(2, std::string_view{written}.size() / 3) + 1;
        for (; index < names.size(); ++index) {
            const MapName& each = names[index];
            if (each.name.empty()) continue;
            if (each.is(written)) return;
            const Sentence whole{each.of, each.of.empty() ? "" : ".", each.name};
            const std::size_t far = edit_distance(written, whole.view(), least);
            if (far >= least) continue;
            least = far;
            meant = each;
        }
        did_you_mean(meant.of.data(), meant.name.data());
    }

private:
    /// Puts the nearest name into clang's message, by its arguments; for a signal, its frame's before it.
    template <class Character>
    static constexpr void did_you_mean(const Character* of, const Character* name) {
        if (of != name || name == nullptr) // always true: g++ reports less about a constant expression
            this_name_is_not_in_the_map_or_goes_the_other_way();
    }
};

/// A far end whose wire a world provides as a `Wire`.
template <class Wire>
class FarEndOf : public FarEnd {
public:
    using FarEnd::FarEnd;

    /// Once it is connected.
    [[nodiscard]] Wire& wire() noexcept { return *wire_; }
    /// Returns how often the wire refused what the plant sent.
    [[nodiscard]] std::uint64_t refused() const noexcept { return refused_; }

protected:
    bool take_wire(const ProvidedDevice& provided) noexcept override {
        wire_ = provided.as<Wire>();
        return wire_ != nullptr;
    }

    Wire* wire_ = nullptr; ///< null before it is connected
    std::uint64_t refused_ = 0;
};

} // namespace tappet
