// SPDX-License-Identifier: Apache-2.0
// PID 1 of a box: brings up the hardware of its board's facts, starts the firmware and supervises it until
// power-off. It reports each missing item on every console in one sentence. There is no shell and no way to
// get one.

#include "board/box/custody.hpp"
#include "board/box/disk.hpp"
#include "board/box/ears.hpp"
#include "board/box/hardware.hpp"
#include "board/box/layouts.hpp"
#include "board/box/renewal.hpp"
#include "board/box/service.hpp"
#include "board/box/slot_check.hpp"
#include "board/init/devices.hpp"
#include "kernel/os/clock.hpp"

#include <array>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <deque>
#include <filesystem>
#include <utility>

#include <fcntl.h>
#include <sys/mount.h>
#include <sys/reboot.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

namespace tappet::box {
namespace {

using std::chrono::milliseconds;

constexpr double patience_s = 5.0; // for hardware that appears late
constexpr int no_process = -1;
constexpr double gone_patience_s = 2.0; // for killed processes to end
constexpr double again_after_s = 1.0;
constexpr std::chrono::seconds renewal_patience{300};
constexpr std::chrono::seconds mount_patience{300}; // for the check, or for a new file system
constexpr int starts_anew = 1;
constexpr std::size_t longest_last_words = 240;
constexpr double tell_trial_s = 5.0; // for a person at the machine to read the reason

const std::string log_file = std::string{data_folder} + "/box.log";
constexpr std::size_t told_of_log = 4000;
constexpr std::uintmax_t least_free_bytes = 256 * 1024;

class Init final : public Processes {
public:
    [[noreturn]] void live() {
        begin();
        bring_up_to_arm();
        look_at_slots();
        start_plant();
        if (may_start_)
            start_firmware();
        else
            bring_up_rest();
        for (;;) look();
    }

private:
    void begin() {
        const auto mounted = init::mount_kernel_files();
        for (const Words& each : facts_.all("console")) voice_.open(each[0]);
        voice_.say("Tappet, " + facts_.one("machine") + " on board " + facts_.one("board") + ", image " +
                   facts_.one("image", 0, "without a number"));
        if (!mounted) voice_.say(mounted.error());
        if (facts_.one("build") == "debug") voice_.say("A DEBUG BUILD, which is not for production");
        if (!facts_.all("plant").empty()) voice_.say("A TEST IMAGE: it carries a plant, and touches no wire");
        is_locked_down_ = box::is_locked_down();
        voice_.say(is_locked_down_ ? "Secure Boot is on: only signed code runs"
                                   : "Secure Boot is off: anyone with the disk can change the software");
        ::setenv("PATH", "/bin", 1);
        ::reboot(RB_DISABLE_CAD); // Ctrl-Alt-Del arrives as SIGINT, and causes an orderly end
        if (const auto opened = ears_.open(); !opened) voice_.say(opened.error());
        modules_.take_signatures_off(!is_locked_down_);
    }

    /// Brings up only what arming needs: the rest follows when the machine has armed.
    void bring_up_to_arm() {
        stage("file systems and consoles");
        if (const auto up = init::set_link("lo", true); !up) voice_.say(up.error());
        std::vector<Need> needs = needs_of(facts_);
        if (facts_.one("world") == "bench") // the others depend on these modules
            if (const auto came = modules_.load_what_fits(Modules::Which::to_arm); !came)
                voice_.say(came.error());
        if (const std::string path = facts_.one("watchdog"); !path.empty())
            needs.push_back({"watchdog " + path, "check that the board's modules name its driver",
                             [path] { return ::access(path.c_str(), F_OK) == 0; },
                             [this] { return custody_.hold_watchdog(); }});
        needs.push_back({std::string{"data partition at "} + data_folder,
                         "check its disk, or flash the box anew, which loses its settings",
                         [] { return find_partition(data_partition).has_value(); },
                         [this] { return take_data_partition(); }});
        const double until_s = uptime_s() + patience_s;
        for (milliseconds pause{10};
             !bring_up(needs, modules_, Modules::Which::to_arm, voice_) && uptime_s() < until_s;
             pause = std::min(2 * pause, milliseconds{250}))
            init::pause_for(pause);
        tell_missing(needs, voice_);
        set_governor(voice_);
        stop_throttling(voice_);
        stage(std::to_string(modules_.loaded()) + " kernel modules and the board's devices");
        if (!may_start_)
            voice_.say("the firmware is not started: without the data partition it has no settings");
    }

    /// Reads the slots: the running version must be known before it changes anything.
    void look_at_slots() {
        custody_.kick();
        if (const auto looked = slots_.look(); !looked) voice_.say("a slot is unusable: " + looked.error());
        const Verdict verdict = judge_fallback(slots_);
        if (!verdict.said.empty()) voice_.say(verdict.said);
        if (verdict.starts_anew) restart();
        if (slots_.on_trial())
            voice_.say("revision " + std::to_string(slots_.running().state.revision) + " is on trial");
        if (verdict.said.empty() && slots_.other().state.state == init::SlotState::failed)
            voice_.say(slots_.other().record.standing == Standing::untried
                           ? "the version in the other slot failed its trial; its last messages are in " +
                                 log_file
                           : "the version in the other slot is " + standing_of(slots_.other()));
        stage("the slots");
    }

    void compare_slots() {
        if (const auto begun = slot_check_.begin(slots_); !begun) voice_.say(begun.error());
    }

    /// Brings up the rest, once; late hardware is retried, see await_networks().
    void bring_up_rest() {
        if (std::exchange(has_all_, true)) return;
        const double before_s = uptime_s();
        networks_ = networks_of(facts_);
        await_networks_until_s_ = uptime_s() + patience_s;
        await_networks();
        ears_.open_power_buttons();
        nonce_ = new_nonce(); // waits until the kernel has gathered enough entropy
        start_service();
        if (!slots_.on_trial()) compare_slots();
        voice_.say("networks, buttons and service, for which the machine does not wait: " +
                   text_of_seconds(uptime_s() - before_s));
    }

    void await_networks() {
        if (await_networks_until_s_ == 0.0) return;
        const bool is_over = uptime_s() >= await_networks_until_s_;
        if (!bring_up(networks_, modules_, Modules::Which::all, voice_) && !is_over) return;
        tell_missing(networks_, voice_);
        await_networks_until_s_ = 0.0;
    }

    init::Done take_data_partition() {
        const auto device = find_partition(data_partition);
        if (!device) return std::unexpected(device.error());
        const Time until = now() + mount_patience;
        const auto mounted = mount_data(*device, data_folder, [&] { custody_.kick_until(until); });
        if (!mounted) return std::unexpected(mounted.error());
        if (!mounted->empty()) voice_.say(*mounted);
        data_device_ = *device;
        std::error_code error;
        if (std::filesystem::space(data_folder, error).free < least_free_bytes)
            voice_.say("the data partition is full: settings and black boxes cannot be saved; "
                       "tappet box BOX factory-reset empties it");
        may_start_ = true;
        if (const auto kept = voice_.keep_in(log_file); !kept) voice_.say(kept.error());
        init::make_folder(properties_folder(facts_.one("layout")));
        return {};
    }

    void note_layout() {
        if (slots_.on_trial()) return;
        if (const auto kept = box::note_layout(facts_.one("layout")); !kept) voice_.say(kept.error());
    }

    void start_service() {
        const std::string port = facts_.one("service");
        if (port.empty()) return;
        if (service_ == no_process)
            if (const auto made = make_service_folder(); !made) voice_.say(made.error());
        tell_status();
        service_ = init::start({"/init", "service", nonce_}, ears_.mouth(), "write the image anew")
                       .value_or(no_process);
    }

    /// Writes the status for requests over the network.
    void tell_status() const {
        if (facts_.one("service").empty() || !has_all_) return;
        std::string text = "machine " + facts_.one("machine") + ", board " + facts_.one("board") + ", " +
                           (is_locked_down_ ? "Secure Boot" : "no Secure Boot") + "\n";
        text += "runs: " + summary_of(slots_.running()) + "\nother: " + summary_of(slots_.other()) + "\n";
        text += std::string{"firmware: "} +
                (!custody_.firmware_runs() ? "does not run"
                 : is_armed_               ? "is armed"
                                           : "has not armed") +
                (last_ending_.empty() ? "" : "; before: " + last_ending_) + "\n" +
                init::read_text(std::string{data_folder} + "/" + measured_file) + "last messages:\n";
        const std::string log = init::read_text(log_file);
        text += log.substr(log.size() - std::min(log.size(), told_of_log));
        const std::string file = std::string{service_folder} + "/" + status_file;
        static_cast<void>(write_through(file, O_CREAT | O_TRUNC, text));
        ::chmod(file.c_str(), 0644); // the service that reads it runs as `nobody`
    }

    void stage(const std::string& what) {
        const double now = uptime_s();
        voice_.say(what + ": " + text_of_seconds(now - last_stage_s_));
        last_stage_s_ = now;
    }

    void start_firmware() {
        if (const auto free = custody_.hand_over(); !free) return voice_.say(free.error());
        start_s_ = uptime_s();
        is_armed_ = false;
        const std::string layout = facts_.one("layout"), last = last_layout();
        std::vector<std::string> words{"/bin/firmware", "--properties", properties_folder(layout),
                                       "--black-box", data_folder};
        if (!last.empty() && last != layout)
            words.insert(words.end(), {"--take-over", properties_folder(last)});
        const auto started = init::start(words, ears_.mouth(), "write the image anew");
        custody_.firmware_started(started.value_or(no_process));
        if (!started) voice_.say(started.error());
        tell_status();
    }

    /// Starts the plant of a test board; its ends of the wires come first.
    void start_plant() {
        const auto given = facts_.all("plant");
        if (given.empty()) return;
        plant_ = init::start(given.front(), ears_.mouth(), "give the image its plant").value_or(no_process);
        for (const double until_s = uptime_s() + patience_s; !plant_is_ready_ && uptime_s() < until_s;) {
            init::pause_for(milliseconds{5});
            take_notices();
        }
        stage("the plant");
    }

    void look() {
        ears_.wait(milliseconds{250});
        custody_.kick();
        pass_on();
        take_notices();
        if (ears_.power_button_was_pressed()) end_in_order("the power button", false);
        take_signals();
        if (has_all_)
            await_networks();
        else if (uptime_s() > start_s_ + patience_s) // the firmware has neither armed nor ended
            bring_up_rest();
        if (service_again_at_s_ != 0.0 && uptime_s() >= service_again_at_s_) {
            service_again_at_s_ = 0.0;
            start_service();
        }
        if (again_at_s_ != 0.0 && uptime_s() >= again_at_s_) {
            again_at_s_ = 0.0;
            if (slots_.on_trial()) restart();
            start_firmware();
        }
    }

    void pass_on() {
        ears_.take_prints([this](std::string_view piece) {
            voice_.pass_on(piece);
            for (const char character : piece) {
                if (character != '\n' && line_.size() < longest_last_words) line_ += character;
                if (character == '\n' && !line_.empty()) last_words_ = std::exchange(line_, {});
            }
        });
    }

    void take_notices() {
        ears_.take_notices([this](std::string_view notice) {
            custody_.hear(notice);
            if (notice == "X_TAPPET_PLANT=ready") {
                plant_is_ready_ = true;
            } else if (notice == "READY=1" && !is_ending_) {
                const double now = uptime_s();
                voice_.say("armed " + text_of_seconds(now - begun_s_) + " after init began, " +
                           text_of_seconds(now - start_s_) +
                           " of it in the firmware; memory left: " + memory_left());
                raise_interrupts(facts_, voice_);
                is_armed_ = true;
                bring_up_rest();
                note_layout();
                tell_status();
            } else if (notice.starts_with("X_TAPPET_LATE=") && slots_.on_trial() && !is_ending_) {
                voice_.say(
                    "activity \"" + std::string{notice.substr(notice.find('=') + 1)} +
                    "\" missed its deadline on trial: the machine is stopped, and the box goes back to "
                    "the other slot");
                restart();
            } else if (notice == "X_TAPPET_PROVEN=1" && slots_.on_trial()) {
                const double before = uptime_s();
                const auto ended = slots_.end_trial();
                voice_.say(ended ? "revision " + std::to_string(slots_.running().state.revision) +
                                       " has proven itself and stays, written in " +
                                       text_of_seconds(uptime_s() - before)
                                 : "the trial is not over: " + ended.error());
                if (ended) compare_slots();
                note_layout();
                tell_status();
            }
        });
    }

    static std::string memory_left() {
        const std::string text = init::read_text("/proc/meminfo");
        const std::size_t at = text.find("MemAvailable:");
        if (at == std::string::npos) return "unknown";
        return std::to_string(std::atol(text.c_str() + at + 13) / 1024) + " MB";
    }

    void take_signals() {
        ears_.take_signals([this](int signal) {
            if (signal == SIGINT) end_in_order("Ctrl-Alt-Del", true);
            if (signal == SIGTERM) end_in_order("a signal", false);
        });
        init::reap([this](pid_t pid, int code) {
            if (pid == plant_) {
                pass_on();
                voice_.say("the plant ended with code " + std::to_string(code));
                end_in_order("the end of its plant", false);
            }
            if (custody_.is(pid)) firmware_ended(code);
            if (const std::string said = slot_check_.end(pid, code, slots_); !said.empty()) {
                voice_.say(said);
                tell_status();
            }
            if (pid == service_ && code != 1) // with code 1 it has reported the reason itself
                service_again_at_s_ = uptime_s() + again_after_s;
        });
    }

    void firmware_ended(int code) {
        pass_on();
        take_notices();
        custody_.firmware_ended(code);
        if (is_ending_) return;
        if (custody_.outputs_are_safe()) bring_up_rest(); // otherwise nothing may delay the reset
        last_ending_ = "the firmware ended with code " + std::to_string(code) + " after " +
                       text_of_seconds(uptime_s() - start_s_) + "; its last message: " + last_words_;
        voice_.say(last_ending_);
        if (!custody_.outputs_are_safe()) {
            is_ending_ = true;
            tell_status();
            custody_.await_reset();
        } else if (code == 0) {
            voice_.say("it was asked to end; the power may be switched off");
        } else if (slots_.on_trial()) {
            voice_.say("it was on trial: the box goes back to the other slot");
            again_at_s_ = uptime_s() + tell_trial_s;
        } else if (may_start_again()) {
            voice_.say("it is started again; nothing moves before an acknowledgement at the machine");
            again_at_s_ = uptime_s() + again_after_s;
        } else {
            voice_.say("it ended " + facts_.one("restarts") + " times within " + facts_.one("restarts", 1) +
                       " s and is not started again; repair what it names, then switch the box off and on");
        }
        tell_status();
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

    /// Returns when the outputs are safe.
    void stop_everything() {
        is_ending_ = true;
        custody_.end_everything();
        ::sync();
        voice_.let_go();
        if (!data_device_.empty() && ::umount(data_folder) != 0)
            ::mount(nullptr, data_folder, nullptr, MS_REMOUNT | MS_RDONLY, nullptr);
    }

    // ---- for custody
    Time now() override { return os::Clock::monotonic(); }
    void pause(milliseconds time) override {
        pass_on();
        take_notices();
        init::reap([this](pid_t pid, int code) {
            if (custody_.is(pid)) firmware_ended(code);
            custody_.worker_ended(pid, code);
        });
        init::pause_for(time);
    }
    void say(const std::string& sentence) override { voice_.say(sentence); }
    void ask_to_end(pid_t process) override { ::kill(process, SIGTERM); }
    void kill(pid_t process) override { ::kill(process, SIGKILL); }
    void kill_children_of(pid_t process) override {
        for (const pid_t child : init::children_of(process)) ::kill(child, SIGKILL);
    }
    void kill_others() override {
        ::kill(-1, SIGKILL);
        // This also closes their files and releases their mounts.
        for (const double gone_s = uptime_s() + gone_patience_s;
             ::waitpid(-1, nullptr, WNOHANG) >= 0 && uptime_s() < gone_s;)
            init::pause_for(milliseconds{1});
    }
    void reset_box() override { init::reset_box(); }

    /// Ends in order. A trial, and a start, continues at the next boot, because switching off is no verdict
    /// on it. A failed trial is over.
    [[noreturn]] void end_in_order(const std::string& by, bool again) {
        const bool has_failed = again_at_s_ != 0.0 && slots_.on_trial();
        bring_up_rest();
        voice_.say(by + " ends it");
        stop_everything();
        if (!has_failed)
            if (const auto kept = slots_.keep_trial(); !kept) voice_.say(kept.error());
        again |= !again && renew_under_watchdog();
        voice_.say(again ? "restart" : "power off");
        if (again) init::restart_box();
        init::power_off();
    }

    /// Runs the renewal in a child, and waits for it only for a limited time, because a watchdog that cannot
    /// be stopped continues to count while a slot is written.
    bool renew_under_watchdog() {
        if (const auto held = custody_.hold_watchdog(); !held) voice_.say(held.error());
        const pid_t worker = ::fork();
        if (worker == 0)
            ::_exit(renew(facts_, nonce_, data_device_, slots_, modules_, voice_) ? starts_anew : 0);
        const bool has_renewed = worker > 0 && custody_.await_worker(worker, renewal_patience) == starts_anew;
        custody_.stand_down();
        return has_renewed;
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
    SlotCheck slot_check_{};
    std::string nonce_{};
    std::vector<Need> networks_{};
    double await_networks_until_s_ = 0.0; // 0: not awaited any more
    bool has_all_ = false;
    bool may_start_ = false; // false without the data partition, since settings are never guessed
    bool is_armed_ = false;
    bool is_locked_down_ = false;
    bool plant_is_ready_ = false;
    bool is_ending_ = false;
    std::string data_device_{};
    std::string line_{}; // the incomplete last line of firmware and plant
    std::string last_words_{};
    std::string last_ending_{};
    std::deque<double> restarts_s_{};
    Custody custody_{*this, facts_.one("watchdog"),
                     std::chrono::seconds{std::atoi(facts_.one("watchdog", 1, "10").c_str())}};
    pid_t plant_ = no_process;
    pid_t service_ = no_process;
    double start_s_ = 0.0;
    double again_at_s_ = 0.0; // 0: nothing is to be started or restarted
    double service_again_at_s_ = 0.0;
    Ears ears_{};
};

} // namespace
} // namespace tappet::box

int main(int count, char** words) {
    using namespace tappet;
    if (count == 3 && std::string_view{words[1]} == "service") {
        const box::Facts facts{init::read_text("/etc/tappet/box")};
        box::serve_network({static_cast<std::uint16_t>(std::atoi(facts.one("service").c_str())),
                            box::key_of(facts.one("key")), box::manifest_of(facts), words[2]});
    }
    box::Init init;
    init.live();
}
