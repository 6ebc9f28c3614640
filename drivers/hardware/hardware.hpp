// Storage for the real devices of one machine. Device kinds that its table does not use cost neither memory
// nor their library.
#pragma once

#include "drivers/hardware/kinds.hpp"
#include "drivers/hardware/opened.hpp"

#include <array>

namespace tappet {

constexpr std::size_t count_devices(const MachineView& m, std::string_view kind) noexcept {
    std::size_t count = 0;
    for (const ComponentRow& row : m.components) count += drives(row, kind) ? 1u : 0u;
    return count;
}

/// Refuses a device of a kind that is not in the list.
template <const auto& table>
class Hardware final : public OpenedDevices {
public:
    Hardware() noexcept : OpenedDevices{room_, provided_room_} {}

private:
    template <class Real>
    struct OfKind {
        static constexpr std::size_t count = count_devices(table.view(), Real::kind.name);
        std::array<Real, count> devices{};
        std::size_t taken = 0;

        void take(const DeviceKind& kind, RealDevice*& found) noexcept {
            if constexpr (count > 0)
                if (kind.name == Real::kind.name) found = &devices[taken++];
        }
    };
    template <class... Real>
    struct Kinds : OfKind<Real>... {
        static constexpr std::size_t count = (OfKind<Real>::count + ...);
        RealDevice* take(const DeviceKind& kind) noexcept {
            RealDevice* found = nullptr;
            (OfKind<Real>::take(kind, found), ...);
            return found;
        }
        void give_back_all() noexcept { ((OfKind<Real>::taken = 0), ...); }
    };

    RealDevice* take(const DeviceKind& kind) noexcept override { return kinds_.take(kind); }
    void give_back_all() noexcept override { kinds_.give_back_all(); }

    RealKinds<Kinds> kinds_{};
    std::array<OpenedDevice, RealKinds<Kinds>::count> room_{};
    std::array<ProvidedDevice, RealKinds<Kinds>::count> provided_room_{};
};

} // namespace tappet
