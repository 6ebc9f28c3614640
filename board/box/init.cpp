// SPDX-License-Identifier: Apache-2.0
// PID 1 of a box: brings up what its board's facts name, starts the firmware and stays with it until the
// power goes. What is missing is said on every console, in one sentence each. There is no shell and no way to
// one.

#include "board/box/disk.hpp"
#include "board/box/hardware.hpp"
#include "board/box/stick.hpp"
#include "board/init/devices.hpp"
#include "kernel/os/clock.hpp"
#include "kernel/os/watchdog.hpp"

#include <array>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <deque>

#include <fcntl.h>
#include <linux/input.h>
#include <poll.h>
#include <sys/mount.h>
#include <sys/reboot.h>
#include <sys/signalfd.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

namespace tappet::box {
namespace {

using std::chrono::milliseconds;

constexpr milliseconds patience{5000}; // for hardware that comes late
constexpr int no_firmware = -1;
constexpr int wrong_set_up = 2;          // Ending::wrong_set_up: nothing was touched
constexpr double stop_patience_s = 15.0; // for the firmware's orderly end
constexpr double again_after_s = 1.0;
constexpr double says_what_it_is_s = 1.0; // a stick that was plugged in just now
constexpr double tell_trial_s = 5.0;      // for who stands there to read why
constexpr std::string_view notify_name{"\0tappet-init", 12};

std::string text_of(double seconds) {
    std::array<char, 32> text{};
    std::snprintf(text.data(), text.size(), "%.3f s", seconds);
    return text.data();
}

class Init {
public:
    [[noreturn]] void live() {
        begin();
        bring_up_box();
        start_plant();
        if (may_start_) start_firmware();
        for (;;) look();
    }

private:
    void begin() {
        const auto mounted = init::mount_kernel_files();
        for (const Words& each : facts_.all("console")) voice_.open(each[0]);
        voice_.say("Tappet, " + facts_.one("machine") + " on board " + facts_.one("board") + ", image " +
                   facts_.one("image", 0, "without a number"));
        if (!mounted) voice_.say(mounted.error());
        ::setenv("PATH", "/bin", 1);
        ::setenv("NOTIFY_SOCKET", "@tappet-init", 1);
        ::reboot(RB_DISABLE_CAD); // Ctrl-Alt-Del comes as SIGINT, and ends in order
        sigset_t all;
        ::sigfillset(&all);
        ::sigprocmask(SIG_SETMASK, &all, nullptr);
        signals_ = ::signalfd(-1, &all, SFD_NONBLOCK | SFD_CLOEXEC);
        notices_ = ::socket(AF_UNIX, SOCK_DGRAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
        sockaddr_un address{};
        address.sun_family = AF_UNIX;
        std::memcpy(address.sun_path, notify_name.data(), notify_name.size());
        const auto length = static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + notify_name.size());
        int ends[2] = {-1, -1};
        if (notices_ < 0 || ::bind(notices_, reinterpret_cast<sockaddr*>(&address), length) != 0 ||
            ::pipe2(ends, O_CLOEXEC) != 0)
            voice_.say(std::string{"nothing of the firmware will be heard: "} + std::strerror(errno));
        heard_ = ends[0];
        spoken_ = ends[1];
        ::fcntl(heard_, F_SETFL, O_NONBLOCK);
    }

    void bring_up_box() {
        stage("file systems and consoles");
        if (const auto up = init::set_link("lo", true); !up) voice_.say(up.error());
        std::vector<Need> needs = needs_of(facts_);
        if (facts_.one("world") == "bench") // what the others are made of comes first
            if (const auto came = modules_.load_what_fits(); !came) voice_.say(came.error());
        if (const std::string path = facts_.one("watchdog"); !path.empty())
            needs.push_back({"watchdog " + path, "check that the board's modules name its driver",
                             [path] { return ::access(path.c_str(), F_OK) == 0; },
                             [this] { return hold_watchdog(); }});
        if (const std::string folder = facts_.one("data"); !folder.empty()) {
            may_start_ = false; // settings are never guessed
            needs.push_back({"data partition at " + folder, "flash the box anew, or check its disk",
                             [] { return find_partition(data_partition).has_value(); },
                             [this, folder]() -> init::Done {
                                 const auto device = find_partition(data_partition);
                                 if (!device) return std::unexpected(device.error());
                                 const auto mounted = mount_data(*device, folder);
                                 data_folder_ = folder;
                                 may_start_ = mounted.has_value();
                                 return mounted;
                             }});
        }
        box::bring_up(needs, modules_, voice_, patience);
        stage(std::to_string(modules_.loaded()) + " kernel modules and the board's devices");
        set_governor(voice_);
        if (const auto looked = slots_.look(); !looked) voice_.say("a slot is of no use: " + looked.error());
        if (slots_.on_trial()) voice_.say("revision " + std::to_string(slots_.revision()) + " is on trial");
        open_power_buttons();
        stage("slots and buttons");
        if (!may_start_)
            voice_.say("the firmware is not started: without the data partition it has no settings");
    }

    void stage(const std::string& what) {
        const double now = uptime_s();
        voice_.say(what + ": " + text_of(now - last_stage_s_));
        last_stage_s_ = now;
    }

    /// Kicked by us while no firmware has it.
    init::Done hold_watchdog() {
        const std::string path = facts_.one("watchdog");
        const std::chrono::seconds within{std::atoi(facts_.one("watchdog", 1, "10").c_str())};
        if (auto opened = watchdog_.open(path.c_str(), within); !opened)
            return std::unexpected(std::string{opened.error().view()});
        return {};
    }

    void open_power_buttons() {
        for (const std::string& name : init::names_in("/dev/input"))
            if (name.starts_with("event"))
                if (const int device =
                        ::open(("/dev/input/" + name).c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC);
                    device >= 0)
                    buttons_.push_back(device);
    }

    void start_firmware() {
        watchdog_.hand_over();
        start_s_ = uptime_s();
        outputs_are_safe_ = false;
        const auto started = init::start({"/bin/firmware"}, spoken_, "write the image anew");
        firmware_ = started.value_or(no_firmware);
        if (!started) voice_.say(started.error());
    }

    /// Of a test board. Its ends of the wires come first.
    void start_plant() {
        const auto given = facts_.all("plant");
        if (given.empty()) return;
        plant_ = init::start(given.front(), spoken_, "give the image its plant").value_or(no_firmware);
        for (auto waited = milliseconds{0}; !plant_is_ready_ && waited < patience;
             waited += milliseconds{5}) {
            init::pause_for(milliseconds{5});
            take_notices();
        }
        stage("the plant");
    }

    void look() {
        std::vector<pollfd> files{{signals_, POLLIN, 0}, {notices_, POLLIN, 0}, {heard_, POLLIN, 0}};
        for (const int button : buttons_) files.push_back({button, POLLIN, 0});
        ::poll(files.data(), files.size(), 250);
        watchdog_.kick(os::Clock::monotonic());
        pass_on();
        take_notices();
        take_buttons();
        take_signals();
        if (again_at_s_ != 0.0 && uptime_s() >= again_at_s_) {
            again_at_s_ = 0.0;
            if (slots_.on_trial()) restart();
            start_firmware();
        }
    }

    void pass_on() const {
        std::array<char, 4096> text{};
        for (ssize_t count = 0; (count = ::read(heard_, text.data(), text.size())) > 0;)
            voice_.pass_on({text.data(), static_cast<std::size_t>(count)});
    }

    void take_notices() {
        std::array<char, 256> text{};
        for (ssize_t count = 0; (count = ::recv(notices_, text.data(), text.size(), 0)) > 0;) {
            const std::string_view notice{text.data(), static_cast<std::size_t>(count)};
            if (notice == "X_TAPPET_PLANT=ready") {
                plant_is_ready_ = true;
            } else if (notice == "READY=1") {
                const double now = uptime_s();
                voice_.say("armed " + text_of(now - begun_s_) + " after init began, " +
                           text_of(now - start_s_) + " of it in the firmware; memory left: " + memory_left());
                raise_interrupts(facts_, voice_);
            } else if (notice == "X_TAPPET_OUTPUTS=safe") {
                outputs_are_safe_ = true;
            } else if (notice == "X_TAPPET_PROVEN=1" && slots_.on_trial()) {
                const double before = uptime_s();
                const auto ended = slots_.end_trial(init::SlotState::good);
                voice_.say(ended ? "revision " + std::to_string(slots_.revision()) +
                                       " has proven itself and stays, written in " +
                                       text_of(uptime_s() - before)
                                 : "the trial is not over: " + ended.error());
            }
        }
    }

    static std::string memory_left() {
        const std::string text = init::read_text("/proc/meminfo");
        const std::size_t at = text.find("MemAvailable:");
        if (at == std::string::npos) return "unknown";
        return std::to_string(std::atol(text.c_str() + at + 13) / 1024) + " MB";
    }

    void take_buttons() {
        for (const int button : buttons_) {
            input_event event{};
            while (::read(button, &event, sizeof event) == static_cast<ssize_t>(sizeof event))
                if (event.type == EV_KEY && event.code == KEY_POWER && event.value == 1)
                    end_in_order("the power button", false);
        }
    }

    void take_signals() {
        signalfd_siginfo signal{};
        while (::read(signals_, &signal, sizeof signal) == static_cast<ssize_t>(sizeof signal)) {
            if (signal.ssi_signo == SIGINT) end_in_order("Ctrl-Alt-Del", true);
            if (signal.ssi_signo == SIGTERM) end_in_order("a signal", false);
        }
        init::reap([this](pid_t pid, int code) {
            if (pid == plant_) {
                pass_on();
                voice_.say("the plant ended with code " + std::to_string(code));
                end_in_order("the end of its plant", false);
            }
            if (pid == firmware_) firmware_ended(code);
        });
    }

    void firmware_ended(int code) {
        firmware_ = no_firmware;
        pass_on();
        take_notices();
        if (is_ending_) return;
        voice_.say("the firmware ended with code " + std::to_string(code) + " after " +
                   text_of(uptime_s() - start_s_));
        if (outputs_are_safe_ || code == wrong_set_up) {
            if (const auto held = hold_watchdog(); !held && !facts_.one("watchdog").empty())
                voice_.say(held.error());
        } else {
            voice_.say("its outputs may not be safe: the watchdog is left alone, and resets the box");
        }
        if (code == 0) {
            voice_.say("it was asked to end; the power may go");
        } else if (slots_.on_trial()) {
            voice_.say("it was on trial: the box goes back to the other slot");
            again_at_s_ = uptime_s() + tell_trial_s;
        } else if (may_start_again()) {
            voice_.say("it is started again; nothing moves before an acknowledgement at the machine");
            again_at_s_ = uptime_s() + again_after_s;
        } else {
            voice_.say("it ended " + facts_.one("restarts") + " times within " + facts_.one("restarts", 1) +
                       " s and is left; repair what it names, then switch the box off and on");
        }
    }

    bool may_start_again() {
        const double now = uptime_s();
        const auto most = static_cast<std::size_t>(std::atoi(facts_.one("restarts", 0, "0").c_str()));
        const double within_s = std::atof(facts_.one("restarts", 1, "0").c_str());
        while (!restarts_s_.empty() && now - restarts_s_.front() > within_s) restarts_s_.pop_front();
        if (restarts_s_.size() >= most) return false;
        restarts_s_.push_back(now);
        return true;
    }

    void stop_everything() {
        is_ending_ = true;
        const double until_s = uptime_s() + stop_patience_s;
        if (firmware_ != no_firmware) ::kill(firmware_, SIGTERM);
        while (firmware_ != no_firmware && uptime_s() < until_s) {
            init::reap([this](pid_t pid, int code) {
                if (pid == firmware_) firmware_ended(code);
            });
            pass_on();
            init::pause_for(milliseconds{10});
        }
        if (firmware_ != no_firmware) voice_.say("the firmware does not end; it is killed");
        ::kill(-1, SIGKILL);
        ::sync();
        if (!data_folder_.empty() && ::umount(data_folder_.c_str()) != 0)
            ::mount(nullptr, data_folder_.c_str(), nullptr, MS_REMOUNT | MS_RDONLY, nullptr);
        watchdog_.stand_down();
    }

    /// A trial goes on at the next boot: who switched off has not judged it.
    [[noreturn]] void end_in_order(const std::string& by, bool again) {
        voice_.say(by + " ends it");
        stop_everything();
        again |= !again && take_update();
        if (slots_.on_trial())
            if (const auto kept = slots_.end_trial(init::SlotState::installed); !kept)
                voice_.say(kept.error());
        voice_.say(again ? "restart" : "power off");
        if (again) init::restart_box();
        init::power_off();
    }

    /// The machine stands, and who pressed the button is at it. True when there is something to start anew
    /// for.
    bool take_update() {
        static_cast<void>(modules_.load_what_fits()); // of a stick that came later
        std::optional<std::string> disk = find_update();
        const double begun_s = uptime_s();
        const auto may_come = [begun_s] {
            const double waited_s = uptime_s() - begun_s;
            return waited_s < says_what_it_is_s ||
                   (has_usb_storage() && waited_s < std::chrono::duration<double>(patience).count());
        };
        while (!disk && may_come()) {
            init::pause_for(milliseconds{250});
            static_cast<void>(modules_.load_what_fits());
            disk = find_update();
        }
        if (!disk) return false;
        voice_.say("there is an update on " + *disk);
        const auto refuse = [&](const std::string& why) {
            voice_.say("the update on " + *disk + " is not taken: " + why);
            return false;
        };
        const auto key = key_of(facts_.one("key"));
        if (!key) return refuse("this box's image has no key; flash one that was written with --key");
        const auto update = read_update(*disk, *key);
        if (!update) return refuse(update.error());
        const Manifest own{facts_.one("machine"), facts_.one("board"),
                           static_cast<std::uint32_t>(std::atoi(facts_.one("image", 0, "0").c_str())), 0};
        if (const std::string why = refusal_of(update->manifest, own); !why.empty()) return refuse(why);
        const double before = uptime_s();
        if (const auto installed = slots_.install(update->kernel); !installed)
            return refuse(installed.error());
        voice_.say("version " + std::to_string(update->manifest.version) + " is written and read back in " +
                   text_of(uptime_s() - before) + ", and goes on trial");
        return true;
    }

    [[noreturn]] void restart() {
        stop_everything();
        voice_.say("restart");
        init::restart_box();
    }

    double begun_s_ = uptime_s();
    double last_stage_s_ = begun_s_;
    Facts facts_{init::read_text("/etc/tappet/box")};
    Modules modules_{init::read_text("/etc/tappet/modules")};
    Voice voice_{};
    Slots slots_{};
    os::Watchdog watchdog_{};
    bool may_start_ = true;
    bool plant_is_ready_ = false;
    bool is_ending_ = false;
    bool outputs_are_safe_ = false; // told by the guardian of the last firmware
    std::string data_folder_{};
    std::vector<int> buttons_{};
    std::deque<double> restarts_s_{};
    pid_t firmware_ = no_firmware;
    pid_t plant_ = no_firmware;
    double start_s_ = 0.0;
    double again_at_s_ = 0.0; // 0: nothing is started or restarted
    int signals_ = -1;
    int notices_ = -1;
    int heard_ = -1;  // what firmware and plant say
    int spoken_ = -1; // to them
};

} // namespace
} // namespace tappet::box

int main() {
    tappet::box::Init init;
    init.live();
}
