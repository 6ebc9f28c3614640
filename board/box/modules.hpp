// SPDX-License-Identifier: Apache-2.0
// The image's kernel modules: a table instead of udev says which drives what and needs which.
#pragma once

#include "board/box/facts.hpp"
#include "board/init/devices.hpp"

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace tappet::box {

/// Of lines that the image's writer made of the kernel's own tables:
///
///     module i6300esb heartbeat=10
///     needs watchdog
///     alias pci:v00008086d000025ABsv*sd*bc*sc*i*
///
/// "later-module" is of one without which a machine can arm. Files are /modules/NAME.ko. "alias always" is of
/// one that drives no device; one without an alias comes with those that need it.
class Modules {
public:
    explicit Modules(std::string_view table);

    enum class Which : std::uint8_t { to_arm, all };
    /// Loads what is always wanted and every module of which a device is there. Again when devices may have
    /// come: what is loaded stays. How many came, and of the first that the kernel refused the reason.
    std::expected<int, std::string> load_what_fits(Which which);

    [[nodiscard]] int loaded() const;
    /// Whether the kernel gets modules without their signature, see init::load_module().
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

/// The aliases of all devices that are there, as the kernel's bus drivers made them.
[[nodiscard]] std::vector<std::string> device_aliases(const std::string& folder = "/sys/devices");

} // namespace tappet::box
