// SPDX-License-Identifier: Apache-2.0
// The image's kernel modules: in place of udev, a table states their devices and dependencies.
#pragma once

#include "board/box/facts.hpp"
#include "board/init/devices.hpp"

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace tappet::box {

/// The table has lines that the image's writer made from the kernel's own tables:
///
///     module i6300esb heartbeat=10
///     needs watchdog
///     alias pci:v00008086d000025ABsv*sd*bc*sc*i*
///
/// "later-module" is a module that a machine does not need to arm. Files are /modules/NAME.ko. "alias always"
/// is for a module without a device; one without an alias is loaded as a dependency.
class Modules {
public:
    explicit Modules(std::string_view table);

    enum class Which : std::uint8_t { to_arm, all };
    /// Loads the modules that are always needed, and those of the present devices. Call again when devices
    /// may have appeared: loaded modules stay. Returns the number loaded, or the reason of the first refusal.
    std::expected<int, std::string> load_what_fits(Which which);

    [[nodiscard]] int loaded() const;
    /// Selects whether the kernel gets modules without their signature, see init::load_module().
    void take_signatures_off(bool off) { signature_ = off ? init::Signature::off : init::Signature::on; }

private:
    struct Module {
        std::string name;
        std::string parameters;
        std::vector<std::string> needs;
        std::vector<std::string> aliases;
        bool is_later = false;
        bool is_loaded = false;
        bool was_refused = false;
    };

    init::Done load(Module& module);
    Module* find(std::string_view name);

    std::vector<Module> modules_;
    init::Signature signature_ = init::Signature::on;
};

/// Returns the aliases of all present devices, as reported by the kernel's bus drivers.
[[nodiscard]] std::vector<std::string> device_aliases(const std::string& folder = "/sys/devices");

} // namespace tappet::box
