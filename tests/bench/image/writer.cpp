// A PID 1 that writes to a box's disk like init and firmware, by their own code and the real kernel's file
// systems, and marks in between what a power cut may leave. Then it repeats this with one fsync omitted, each
// of them once: that must be found.
#include "board/box/disk.hpp"
#include "board/box/modules.hpp"
#include "board/box/slots.hpp"
#include "board/box/update.hpp"
#include "board/box/voice.hpp"
#include "tests/bench/image/settings.hpp"

#include <array>
#include <cerrno>
#include <cstdlib>
#include <cstring>

#include <fcntl.h>
#include <sys/mount.h>
#include <sys/syscall.h>
#include <unistd.h>

namespace {

std::string forgotten; // path of the file whose fsync does nothing; empty: none

} // namespace

/// This program's own.
extern "C" int fsync(int file) {
    std::array<char, 256> path{};
    const ssize_t length =
        ::readlink(("/proc/self/fd/" + std::to_string(file)).c_str(), path.data(), path.size());
    if (length > 0 && forgotten == std::string_view{path.data(), static_cast<std::size_t>(length)}) return 0;
    return static_cast<int>(::syscall(SYS_fsync, file));
}

namespace tappet::bench {
namespace {

const std::string data = "/data";

class Writer {
public:
    [[noreturn]] void live() {
        static_cast<void>(init::mount_kernel_files());
        voice_.open("ttyS0");
        if (const auto done = write_all(); !done) voice_.say("the writer gives up: " + done.error());
        voice_.say("the writer ends");
        init::power_off();
    }

private:
    init::Done write_all() {
        box::Modules modules{init::read_text("/etc/tappet/modules")};
        for (int i = 0; i < 100 && !box::find_partition(box::data_partition); ++i) {
            static_cast<void>(modules.load_what_fits(box::Modules::Which::all));
            init::pause_for(std::chrono::milliseconds{50});
        }
        const auto partition = box::find_partition(box::data_partition);
        if (!partition) return std::unexpected(partition.error());
        const auto mounted = box::mount_data(*partition, data, [] {});
        if (!mounted) return std::unexpected(mounted.error());
        voice_.say("mounted: " + *mounted);
        disk_ = ::open(partition->substr(0, partition->find_last_not_of("0123456789") + 1).c_str(),
                       O_WRONLY | O_DIRECT | O_CLOEXEC);
        if (auto begun = begin("sound", ""); !begun) return begun;
        for (int i = 0; i < 20; ++i)
            if (auto saved = save(); !saved) return saved;
        if (auto filled = fill(); !filled) return filled;
        for (int i = 0; i < 3; ++i) {
            if (auto updated = update(); !updated) return updated;
            if (auto started = start(); !started) return started;
        }
        if (auto returned = cut_start_short(); !returned) return returned;
        for (const char* file : {"/run/slot/tappet.efi", "/run/slot/BGENV.DAT"}) {
            if (auto begun = begin(file, file); !begun) return begun;
            if (auto updated = update(); !updated) return updated;
        }
        if (auto begun = begin(data, data); !begun) return begun;
        for (int i = 0; i < 5; ++i)
            if (auto saved = save(); !saved) return saved;
        return begin("end", "");
    }

    init::Done begin(const std::string& phase, const std::string& forgets) {
        forgotten.clear();
        ::sync();
        if (::fsync(disk_) != 0) return init::failed("flush the disk");
        phase_ = phase;
        forgotten = forgets;
        return mark();
    }

    /// Marks the allowed contents of the disk from here to the next mark.
    init::Done mark() {
        alignas(512) static std::array<char, 512> sector;
        const std::string text = phase_ + " " + std::to_string(settings_.least) + " " +
                                 std::to_string(settings_.most) + " " + std::to_string(version_.least) + " " +
                                 std::to_string(version_.most);
        sector.fill('\0');
        text.copy(sector.data(), sector.size() - 1);
        if (::pwrite(disk_, sector.data(), sector.size(), marks_at_byte) !=
            static_cast<ssize_t>(sector.size()))
            return init::failed("write a mark");
        return {};
    }

    init::Done save() {
        ++settings_.most;
        if (auto marked = mark(); !marked) return marked;
        if (const std::string refused = save_settings(data, settings_.most); !refused.empty())
            return std::unexpected(refused);
        settings_.least = settings_.most;
        write_history(200);
        return mark();
    }

    /// Writes without waiting, like a black box: it keeps the journal busy.
    static bool write_history(std::size_t bytes) {
        const int file = ::open((data + "/history").c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0600);
        const bool written =
            ::write(file, std::string(bytes, 'h').data(), bytes) == static_cast<ssize_t>(bytes);
        ::close(file);
        return written;
    }

    /// Fills the partition: then saving is refused, and the saved settings stay.
    init::Done fill() {
        for (std::size_t piece = 1 << 20; piece != 0; piece /= 2)
            while (write_history(piece)) {
            }
        ::sync();
        const std::string refused = save_settings(data, settings_.most + 1);
        voice_.say(refused.empty() ? "a full disk takes settings" : "on a full disk: " + refused);
        ::unlink((data + "/history").c_str());
        return save();
    }

    init::Done update() {
        ++version_.most;
        if (auto marked = mark(); !marked) return marked;
        box::Slots slots;
        static_cast<void>(slots.look());
        const std::string kernel = kernel_of_version(version_.most);
        const std::string header = box::header_of({{.version = version_.most}, kernel, {}}, nullptr);
        if (auto installed = slots.install(kernel, header); !installed) return installed;
        const std::uint32_t before = version_.least;
        version_.least = version_.most;
        if (auto marked = mark(); !marked) return marked;
        version_.least = before; // a cut during the trial leads back
        if (auto marked = mark(); !marked) return marked;
        if (auto begun = loader_makes(init::SlotState::testing, init::SlotState::installed); !begun)
            return begun;
        if (const auto looked = slots.look(); !looked) return looked;
        if (!slots.on_trial()) return std::unexpected("there is no trial");
        if (auto ended = slots.end_trial(); !ended) return ended;
        version_.least = version_.most;
        return mark();
    }

    /// Starts the proven version, the only one that may boot then. Twice, since after the first time the
    /// loader writes too.
    static init::Done start() {
        for (int i = 0; i < 2; ++i) {
            if (auto begun = loader_makes(init::SlotState::testing, init::SlotState::installed); !begun)
                return begun;
            box::Slots slots;
            if (auto looked = slots.look(); !looked) return looked;
            if (slots.on_trial()) return std::unexpected("a start is taken for a trial");
            if (auto ended = slots.end_start(true); !ended) return ended;
        }
        return {};
    }

    /// The loader changes to the other slot, and init changes back.
    static init::Done cut_start_short() {
        for (const auto from : {init::SlotState::installed, init::SlotState::testing}) {
            const auto to =
                from == init::SlotState::testing ? init::SlotState::failed : init::SlotState::testing;
            if (auto made = loader_makes(to, from); !made) return made;
        }
        box::Slots slots;
        if (auto looked = slots.look(); !looked) return looked;
        if (!box::is_fallback(slots.running(), slots.other())) return std::unexpected("no fallback");
        if (auto judged = slots.judge_other(); !judged) return judged;
        return start();
    }

    /// The loader's change to the state of the slot that it boots, or did not boot completely.
    static init::Done loader_makes(init::SlotState to, init::SlotState from) {
        for (const char* name : box::slot_partitions) {
            const auto partition = box::find_partition(name);
            if (!partition) return std::unexpected(partition.error());
            init::make_folder("/run/loader");
            if (::mount(partition->c_str(), "/run/loader", "vfat", 0, "codepage=437,iocharset=ascii") != 0)
                return init::failed("mount " + *partition);
            const std::string file = "/run/loader/" + std::string{init::boot_state_file};
            auto state = init::decode(init::read_text(file));
            if (state && state->state == from) {
                state->state = to;
                if (to == init::SlotState::failed) state->revision = 0;
                static_cast<void>(init::write_text(file, init::encode(*state)));
            }
            ::umount("/run/loader");
        }
        return {};
    }

    struct Range {
        std::uint32_t least = 0;
        std::uint32_t most = 0;
    };
    box::Voice voice_{};
    std::string phase_{};
    Range settings_{0, 0};
    Range version_{1, 1};
    int disk_ = -1;
};

} // namespace
} // namespace tappet::bench

int main() {
    tappet::bench::Writer writer;
    writer.live();
}
