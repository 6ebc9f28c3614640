// The state of the box that a machine runs on, as outputs that any machine can name.
#pragma once

#include "kernel/component/component.hpp"
#include "kernel/os/health.hpp"

namespace tappet {

/// Runs in an activity that is not_real_time, once in each of its cycles: component<Box>("box"), then
/// data("box.temperature", "loom.box_temperature"). An output whose value cannot be read is not written: its
/// readers then see that nothing arrived.
struct Box {
    Output<double> temperature, disk_free;
    Output<bool> watchdog;
    /// A folder on the disk to measure.
    Property<Text<64>> disk{Text<64>{"/var/lib/tappet"}};

    void work(const Cycle&) {
        if (const auto celsius = os::hottest_celsius()) temperature.write(*celsius);
        const Text<64> folder = disk.get();
        std::array<char, 65> path{};
        folder.view().copy(path.data(), 64);
        if (const auto megabytes = os::free_megabytes(path.data())) disk_free.write(*megabytes);
        watchdog.write(os::watchdog_counts());
    }

    static constexpr auto interface() {
        return facets(
            output<&Box::temperature>("temperature", "degC", "of the hottest sensor; nothing without one"),
            output<&Box::disk_free>("disk_free", "MB", "left on the disk"),
            output<&Box::watchdog>("watchdog", "", "the hardware's counts: a box that hangs is reset"),
            property<&Box::disk>("disk", "", "a folder on it"));
    }
};

} // namespace tappet
