// SPDX-License-Identifier: Apache-2.0
// Processes the network's offer first, then a stick. init itself verifies every offer.
#include "board/box/renewal.hpp"

#include "board/box/service.hpp"
#include "board/box/stick.hpp"

#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <optional>

#include <fcntl.h>
#include <sys/mount.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

namespace tappet::box {

namespace {

using std::chrono::milliseconds;

constexpr double says_what_it_is_s = 1.0; // for a stick that was just plugged in
constexpr double stick_patience_s = 5.0;
constexpr const char* measured_s = "60";

/// Returns the path when it is a regular file, and not anything else that the service could have created: it
/// may be taken over by a stranger. Empty: there is none.
std::string offered(const char* name) {
    const std::string path = std::string{service_folder} + "/" + name;
    struct stat facts{};
    return ::lstat(path.c_str(), &facts) == 0 && S_ISREG(facts.st_mode) ? path : std::string{};
}

class Renewal {
public:
    Renewal(const Facts& facts, const std::string& nonce, const std::string& data, Slots& slots,
            Modules& modules, const Voice& voice)
        : own_{manifest_of(facts)},
          key_{key_of(facts.one("key"))},
          nonce_{nonce},
          data_{data},
          slots_{slots},
          modules_{modules},
          voice_{voice} {}

    bool run() {
        if (const std::string order = offered(offered_order); !order.empty()) return carry_out(order);
        if (const std::string update = offered(offered_update); !update.empty()) return install(update);
        const auto disk = await_stick();
        return disk && install(*disk);
    }

private:
    std::optional<std::string> await_stick() {
        const double begun_s = uptime_s();
        for (;;) {
            static_cast<void>(modules_.load_what_fits(Modules::Which::all)); // of a stick plugged in later
            if (auto disk = find_update()) return disk;
            const double waited_s = uptime_s() - begun_s;
            if (waited_s >= says_what_it_is_s && !(has_usb_storage() && waited_s < stick_patience_s))
                return std::nullopt;
            init::pause_for(milliseconds{250});
        }
    }

    bool refuse(const std::string& what, const std::string& why) {
        voice_.say(what + " is refused: " + why);
        return false;
    }

    bool install(const std::string& file) {
        const std::string what = "the update on " + file;
        if (!key_) return refuse(what, "this box's image has no key; flash one that was written with --key");
        const auto update = read_update(file, *key_);
        if (!update) return refuse(what, update.error());
        if (const std::string why = refusal_of(update->manifest, own_); !why.empty())
            return refuse(what, why);
        const double before_s = uptime_s();
        if (const auto installed = slots_.install(update->kernel, update->header); !installed)
            return refuse(what, installed.error());
        voice_.say("version " + std::to_string(update->manifest.version) + " is written and read back in " +
                   text_of_seconds(uptime_s() - before_s) + ", and goes on trial");
        return true;
    }

    bool carry_out(const std::string& file) {
        const std::string text = init::read_text(file);
        const std::string verb = text.substr(0, text.find('\n'));
        const std::string rest = text.substr(std::min(verb.size() + 1, text.size()));
        if (!key_ ||
            !is_signed({verb, own_.machine, own_.board, nonce_}, rest.substr(0, rest.find('\n')), *key_))
            return refuse("the order that waits", "its signature does not match this box's key");
        const auto done = verb == "roll-back"       ? slots_.roll_back()
                          : verb == "measure"       ? on_data(&measure)
                          : verb == "factory-reset" ? on_data(&forget_settings)
                                                    : std::unexpected("this version does not know it");
        if (!done) return refuse("the order \"" + verb + "\"", done.error());
        voice_.say(verb == "roll-back" ? "the version of the other slot goes on trial"
                   : verb == "measure" ? "the box is measured; tappet box shows the figures"
                                       : "all settings and learned values are gone; the machine begins anew");
        return true;
    }

    /// Mounts the data partition for `act`, and unmounts it with everything written.
    init::Done on_data(init::Done (*act)(const std::string& folder)) {
        if (data_.empty()) return std::unexpected("there is no data partition");
        const std::string folder = "/run/data";
        if (const auto mounted = mount_data(data_, folder, [] {}); !mounted)
            return std::unexpected(mounted.error());
        const auto done = act(folder);
        ::sync();
        if (::umount(folder.c_str()) != 0) return init::failed("unmount " + data_);
        return done;
    }

    static init::Done measure(const std::string& folder) {
        const std::string path = folder + "/" + measured_file;
        const int file = ::open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0644);
        if (file < 0) return init::failed("open " + path);
        const auto started =
            init::start({"/bin/firmware", "--measure", measured_s}, file, "write the image anew");
        ::close(file);
        if (!started) return std::unexpected(started.error());
        int status = 0;
        ::waitpid(*started, &status, 0);
        // A box that cannot meet them is a valid result.
        return init::to_exit_code(status) <= 1 ? init::Done{} : std::unexpected(init::read_text(path));
    }

    /// Deletes everything but the logs.
    static init::Done forget_settings(const std::string& folder) {
        init::Done done{};
        for (const std::string& name : init::names_in(folder)) {
            if (name == "lost+found" || name.starts_with("box.log")) continue;
            std::error_code error;
            std::filesystem::remove_all(folder + "/" + name, error);
            if (error) done = std::unexpected("remove " + name + ": " + error.message());
        }
        return done;
    }

    Manifest own_;
    std::expected<PublicKey, std::string> key_;
    const std::string& nonce_;
    const std::string& data_;
    Slots& slots_;
    Modules& modules_;
    const Voice& voice_;
};

} // namespace

Manifest manifest_of(const Facts& facts) {
    return {facts.one("machine"), facts.one("board"), facts.one("layout"),
            static_cast<std::uint32_t>(std::strtoul(facts.one("image", 0, "0").c_str(), nullptr, 10)), 0};
}

bool renew(const Facts& facts, const std::string& nonce, const std::string& data, Slots& slots,
           Modules& modules, const Voice& voice) {
    return Renewal{facts, nonce, data, slots, modules, voice}.run();
}

} // namespace tappet::box
