// The requests of a component while it is configured: the devices of this world, and the waiter of its
// activity.
#pragma once

#include "kernel/base/text.hpp"
#include "kernel/base/type_tag.hpp"
#include "kernel/component/life_sign.hpp"
#include "kernel/os/clock.hpp"
#include "kernel/os/waiter.hpp"

#include <span>
#include <string_view>

namespace tappet {

class MachineInstance;
namespace scope {
struct Directory;
} // namespace scope

/// A device of this world: the real one, or its twin. `type` is the abstract device class.
struct ProvidedDevice {
    TypeId type = nullptr;
    std::string_view name{}; ///< the logical name, as in the board and in the machine table
    void* device = nullptr;

    /// Returns it when it is of that class, or null.
    template <class Device>
    [[nodiscard]] Device* as() const noexcept {
        return type == type_id<Device> ? static_cast<Device*>(device) : nullptr;
    }
};
/// Provides the device under its abstract class.
template <class Device>
constexpr ProvidedDevice provide(std::string_view name, Device& device) noexcept {
    return {type_id<Device>, name, &device};
}

struct Setup {
    std::string_view component{};
    std::string_view device_name{};
    std::span<const ProvidedDevice> devices;
    os::Clock* clock = nullptr;
    os::Waiter* waiter = nullptr;
    LifeSign watched{};                 ///< only for a type that says `watches_life = true`
    MachineInstance* machine = nullptr; ///< only for a type that says `sees_machine = true`
    scope::Directory* scope = nullptr;  ///< only for a type that says `records_cycles = true`
    bool is_woken = false;              ///< woken_by() was called

    /// Returns the row's device, or null when this world has none of that name and class.
    template <class Device>
    [[nodiscard]] Device* device() const {
        for (const auto& each : devices)
            if (each.name == device_name && each.as<Device>() != nullptr) return each.as<Device>();
        return nullptr;
    }
    /// Returns the answer for configure() when device() found nothing.
    [[nodiscard]] Sentence no_device() const {
        return Sentence{
            "component \"", component, "\": this world provides no device \"", device_name,
            "\" of the class it drives: give it to the start-up, or name another device in its row"};
    }
    /// Returns the answer for configure() when the waiter takes no further device.
    [[nodiscard]] Sentence too_many_devices() const {
        return Sentence{"component \"", component,
                        "\": its activity watches too many devices; give it fewer drivers"};
    }
    /// Lets a device wake the activity by its descriptor. Only for a type that says `woken_by_device = true`,
    /// which must call it or the one below. Returns the answer for configure().
    [[nodiscard]] Sentence woken_by(int descriptor) {
        is_woken = true;
        return waiter->watch(descriptor) ? Sentence{} : too_many_devices();
    }
    /// Lets the device wake the activity: itself, by its descriptor, or a twin by its listener.
    template <class Device>
    [[nodiscard]] Sentence woken_by(Device& found) {
        is_woken = true;
        if constexpr (requires { found.wakes(*waiter); }) {
            return found.wakes(*waiter) ? Sentence{} : too_many_devices();
        } else {
            if (const int handle = found.wait_handle(); handle >= 0) return woken_by(handle);
            found.set_listener(&os::Waiter::wake_thunk, waiter);
            return {};
        }
    }
};

} // namespace tappet
