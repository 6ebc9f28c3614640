// SPDX-License-Identifier: Apache-2.0
// Devices, Ethernet; the processors; the interrupt threads.
#include "board/box/hardware.hpp"

#include "board/init/devices.hpp"

#include <algorithm>
#include <cstdlib>
#include <cstring>

#include <fcntl.h>
#include <linux/gpio.h>
#include <sched.h>
#include <sys/ioctl.h>
#include <sys/mount.h>
#include <unistd.h>

namespace tappet::box {

namespace {

std::string base_name(const std::string& path) { return path.substr(path.rfind('/') + 1); }

bool exists(const std::string& path) { return ::access(path.c_str(), F_OK) == 0; }

/// Returns whether the chip exists, by its path, or by its label as gpiodetect shows it.
bool has_chip(const std::string& address) {
    if (address.starts_with('/')) return exists(address);
    return std::ranges::any_of(init::names_in("/dev"), [&](const std::string& name) {
        if (!name.starts_with("gpiochip")) return false;
        const int chip = ::open(("/dev/" + name).c_str(), O_RDONLY | O_CLOEXEC);
        gpiochip_info info{};
        const bool known = chip >= 0 && ::ioctl(chip, GPIO_GET_CHIPINFO_IOCTL, &info) == 0;
        if (chip >= 0) ::close(chip);
        return known && address == info.label;
    });
}

init::Done nothing_to_do() { return {}; }

/// Hardware that the firmware opens itself only has to exist.
Need awaited(const std::string& what, const std::string& cure, std::function<bool()> is_there) {
    return {what, cure, std::move(is_there), nothing_to_do};
}

/// Takes name, bit rate, and the rate of CAN FD's data phase where the board has CAN FD.
Need can_bus(const Words& bus, bool is_emulated) {
    const std::string& name = bus[0];
    if (is_emulated)
        return {"CAN interface " + name, "add vcan to the board's modules", [] { return true; },
                [name] { return init::create_can(name); }};
    const auto rate_of = [&](std::size_t which) {
        return which < bus.size() ? static_cast<std::uint32_t>(std::strtoul(bus[which].c_str(), nullptr, 10))
                                  : 0;
    };
    return {"CAN interface " + name + " at " + bus[1] + (bus.size() > 2 ? " and " + bus[2] : "") + " bit/s",
            "check its card, and that the board's modules name its driver",
            [name] { return init::has_interface(name); },
            [name, nominal = rate_of(1), data = rate_of(2)]() -> init::Done {
                if (auto set = init::set_bit_rates(name, nominal, data); !set) return set;
                return init::set_link(name, true);
            }};
}

Need gpio_chip(const std::string& address, const std::string& lines, bool is_emulated) {
    if (is_emulated)
        return {"GPIO chip " + address, "add gpio-sim to the board's modules", [] { return true; },
                [address, lines] { return init::create_gpio_chip(base_name(address), lines); }};
    return awaited(
        "GPIO chip " + address,
        "check its label in the board against gpiodetect's, and that the board's modules name its driver",
        [address] { return has_chip(address); });
}

Need network(const std::string& name, const std::string& address) {
    return {"network " + name + " as " + address,
            "check its port, and that the board's modules name its driver",
            [name] { return init::has_interface(name); },
            [name, address]() -> init::Done {
                if (auto set = init::set_address(name, address); !set) return set;
                return init::set_link(name, true);
            }};
}

} // namespace

std::vector<Need> needs_of(const Facts& facts) {
    const bool is_emulated = facts.one("world") == "bench";
    std::vector<Need> needs;
    for (const Words& each : facts.all("device")) {
        const std::string &kind = each[0], &address = each[1];
        if (kind == "can")
            needs.push_back(can_bus({each.begin() + 1, each.end()}, is_emulated));
        else if (kind == "gpio")
            needs.push_back(gpio_chip(address, each[2], is_emulated));
        else // of any other kind a file; the firmware refuses what it finds at another address
            needs.push_back(awaited(kind + " device " + address,
                                    "check its cable, the board's devices, and that the board's modules "
                                    "name its driver",
                                    [address] { return !address.starts_with('/') || exists(address); }));
    }
    return needs;
}

std::vector<Need> networks_of(const Facts& facts) {
    std::vector<Need> needs;
    for (const Words& each : facts.all("network")) needs.push_back(network(each[0], each[1]));
    return needs;
}

bool bring_up(std::vector<Need>& needs, Modules& modules, Modules::Which which, const Voice& voice) {
    if (const auto came = modules.load_what_fits(which); !came) voice.say(came.error());
    for (Need& need : needs) {
        if (need.is_up || !need.is_there()) continue;
        const auto done = need.bring_up();
        need.is_up = true;
        voice.say(done ? need.what + " is up"
                       : need.what + " is refused: " + done.error() + "; " + need.cure);
    }
    return std::ranges::all_of(needs, &Need::is_up);
}

void tell_missing(const std::vector<Need>& needs, const Voice& voice) {
    for (const Need& need : needs)
        if (!need.is_up) voice.say(need.what + " is missing; " + need.cure);
}

void set_governor(const Voice& voice) {
    const std::string folder = "/sys/devices/system/cpu/cpufreq";
    for (const std::string& policy : init::names_in(folder))
        if (policy.starts_with("policy") &&
            !init::write_text(folder + "/" + policy + "/scaling_governor", "performance"))
            voice.say("the frequency governor of " + policy + " is not performance: " + std::strerror(errno) +
                      "; give the board's kernel command line cpufreq.default_governor=performance");
}

void stop_throttling(const Voice& voice) {
    const auto stopped = init::stop_throttling();
    if (!stopped)
        voice.say("real-time threads are throttled: " + stopped.error());
    else if (*stopped > 0)
        voice.say("the fair server is stopped on " + std::to_string(*stopped) + " processors");
}

void raise_interrupts(const Facts& facts, const Voice& voice) {
    const std::string priority = facts.one("interrupts");
    if (priority.empty()) return;
    sched_param parameter{};
    parameter.sched_priority = std::atoi(priority.c_str());
    for (const Words& device : facts.all("device")) {
        int raised = 0;
        for (const std::string& process : init::names_in("/proc")) {
            const std::string name = init::read_line("/proc/" + process + "/comm");
            if (!name.starts_with("irq/") ||
                !name.ends_with("-" + base_name(device[1]).substr(0, 15 - name.find('-') - 1)))
                continue;
            raised += ::sched_setscheduler(std::atoi(process.c_str()), SCHED_FIFO, &parameter) == 0;
        }
        if (raised != 0)
            voice.say("interrupts of " + device[1] + " have priority " + priority);
        else
            voice.say("no interrupt thread is named after " + device[1] + ", so none of it has priority " +
                      priority + "; see /proc/interrupts for its name");
    }
}

bool is_locked_down() {
    ::mount("securityfs", "/sys/kernel/security", "securityfs", 0, nullptr);
    const std::string how = init::read_line("/sys/kernel/security/lockdown");
    return how.contains("[integrity]") || how.contains("[confidentiality]");
}

} // namespace tappet::box
