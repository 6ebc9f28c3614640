// The disk of a box after a power cut: which slot its loader boots and with which contents, and whether the
// data partition keeps the settings.
#pragma once

#include "board/box/slot.hpp"
#include "board/box/update.hpp"
#include "tests/bench/image/power_cut.hpp"
#include "tests/bench/image/settings.hpp"
#include "tests/toolchain/program.hpp"
#include "toolchain/tools/bench/folders.hpp"
#include "toolchain/tools/image/disk.hpp"
#include "toolchain/tools/image/tool.hpp"

#include <algorithm>
#include <array>
#include <cstring>
#include <filesystem>
#include <map>
#include <optional>
#include <string>

#include <sys/mman.h>
#include <unistd.h>

namespace tappet::bench {

/// The allowed contents.
struct Allowed {
    std::int64_t least_settings = 0, most_settings = 0; ///< 0: none yet
    std::uint32_t least_version = 0, most_version = 0;
};

class Judge {
public:
    explicit Judge(const std::filesystem::path& disk) : disk_bytes_{disk, false} {}
    ~Judge() { ::close(memory_); }
    Judge(const Judge&) = delete;
    Judge& operator=(const Judge&) = delete;

    /// Registers a kernel other than that of kernel_of_version().
    void knows(std::uint32_t version, std::string kernel) { kernels_[version] = std::move(kernel); }

    /// Empty: it boots an allowed version, whole.
    [[nodiscard]] std::string harm_to_slots(const Allowed& allowed) {
        const auto slot = slot_that_boots();
        if (!slot) return "no slot boots";
        const image::Partition& partition = image::partitions()[*slot];
        const std::string kernel = file_in(partition, "TAPPET  EFI");
        for (std::uint32_t version = allowed.least_version; version <= allowed.most_version; ++version)
            if (kernel == kernel_of(version)) return {};
        return partition.label + " boots, and its kernel of " + std::to_string(kernel.size()) +
               " bytes is none that may be there";
    }

    /// Empty: after its journal, the file system is in order and holds allowed settings, whole.
    [[nodiscard]] std::string harm_to_settings(const Allowed& allowed) {
        const std::string partition = copy_out(image::partitions()[3]);
        Ended mended = run_line("/usr/sbin/e2fsck -p " + partition);
        if (mended.exit_code > 1) mended = run_line("/usr/sbin/e2fsck -p -b 8193 -B 1024 " + partition);
        if (mended.exit_code > 1) return "e2fsck would ask a human: " + mended.text;
        if (const Ended checked = run_line("/usr/sbin/e2fsck -fn " + partition); checked.exit_code != 0)
            return "e2fsck is not content: " + checked.text;
        const std::string found = work_ / "settings.cpf";
        std::filesystem::remove(found);
        run_line("/usr/sbin/debugfs -R 'dump /settings.cpf " + found + "' " + partition);
        if (!std::filesystem::exists(found) || std::filesystem::file_size(found) == 0)
            return allowed.least_settings == 0 ? "" : "the settings are gone";
        const std::string text = image::read_file(found);
        for (std::int64_t number = allowed.least_settings; number <= allowed.most_settings; ++number)
            if (text == settings(number)) return {};
        return "of the settings there are " + std::to_string(text.size()) +
               " bytes that may not be there: " + text.substr(0, 200);
    }

    /// The loader's rule: the highest revision with a whole state boots; a slot found in its trial has had
    /// it, and the previous one boots. Then init's rule, which may return to the other slot.
    [[nodiscard]] std::optional<std::size_t> slot_that_boots() const {
        std::array<box::Slot, 2> slots{slot(1), slot(2)};
        const auto newest = [&] { return slots[0].state.revision >= slots[1].state.revision ? 0U : 1U; };
        if (box::Slot& first = slots[newest()]; first.state.state == init::SlotState::testing)
            first.state = {.state = init::SlotState::failed};
        const std::size_t running = newest();
        if (slots[running].state.revision == 0) return std::nullopt;
        box::Slot& other = slots[1 - running];
        if (!box::is_fallback(slots[running], other)) return running + 1;
        const bool is_harmed =
            !box::is_of(other.header, file_in(image::partitions()[2 - running], "TAPPET  EFI"));
        return box::after_cut_short(other.record, is_harmed).standing == box::Standing::proven ? 2 - running
                                                                                               : running + 1;
    }

    /// Whether a table of clusters is torn: a cluster belongs to no file, or a file has too few or too many.
    [[nodiscard]] bool has_torn_tables() const {
        for (const std::size_t slot : {1U, 2U}) {
            const std::string said =
                run_line("/usr/sbin/fsck.vfat -n " + copy_out(image::partitions()[slot])).text;
            for (const char* torn : {"Reclaim", "FATs differ", "File size is", "free cluster"})
                if (said.contains(torn)) return true;
        }
        return false;
    }

private:
    [[nodiscard]] box::Slot slot(std::size_t number) const {
        const image::Partition& partition = image::partitions()[number];
        box::Slot slot{.device = partition.name,
                       .state = {.state = init::SlotState::failed},
                       .header = file_in(partition, "MANIFEST   "),
                       .record = box::record_of(file_in(partition, "RECORD     "))};
        if (const auto state = init::decode(file_in(partition, "BGENV   DAT"))) slot.state = *state;
        return slot;
    }

    /// The file as the loader reads it, by the first table; shorter when its chain of clusters breaks.
    [[nodiscard]] std::string file_in(const image::Partition& partition, std::string_view name) const {
        const char* const slot = disk_bytes_.data() + partition.first_sector * image::sector_bytes;
        const auto number = [slot](std::size_t at, std::size_t bytes) {
            std::size_t value = 0;
            std::memcpy(&value, slot + at, bytes);
            return value;
        };
        const std::size_t table = number(14, 2) * image::sector_bytes, entries = number(17, 2),
                          root = table + number(16, 1) * number(22, 2) * image::sector_bytes,
                          clusters = root + entries * 32, cluster = number(13, 1) * image::sector_bytes,
                          count = (partition.bytes() - clusters) / cluster;
        std::string text;
        for (std::size_t at = root; at < clusters && slot[at] != '\0'; at += 32) {
            if (std::string_view{slot + at, 11} != name) continue;
            std::size_t left = number(at + 28, 4);
            for (std::size_t n = number(at + 26, 2); left != 0 && n >= 2 && n < 2 + count;
                 n = number(table + 2 * n, 2)) {
                text.append(slot + clusters + (n - 2) * cluster, std::min(left, cluster));
                left -= std::min(left, cluster);
            }
        }
        return text;
    }

    /// Copies into memory, where e2fsck's own flushes take no time; zeros stay holes. Returns the path.
    std::string copy_out(const image::Partition& partition) const {
        const std::string_view from{disk_bytes_.data() + partition.first_sector * image::sector_bytes,
                                    partition.bytes()};
        bool copied =
            ::ftruncate(memory_, 0) == 0 && ::ftruncate(memory_, static_cast<off_t>(partition.bytes())) == 0;
        for (std::size_t at = 0; copied && at < from.size(); at += 65536) {
            const std::string_view block = from.substr(at, 65536);
            if (block.find_first_not_of('\0') != std::string_view::npos)
                copied = ::pwrite(memory_, block.data(), block.size(), static_cast<off_t>(at)) ==
                         std::ssize(block);
        }
        if (!copied) throw image::Fault("no memory for a copy of " + partition.name);
        return "/proc/" + std::to_string(::getpid()) + "/fd/" + std::to_string(memory_);
    }

    const std::string& kernel_of(std::uint32_t version) {
        return kernels_.try_emplace(version, kernel_of_version(version)).first->second;
    }

    const std::string& settings(std::int64_t number) {
        std::string& text = settings_[number];
        if (text.empty() && save_settings((work_ / "").native(), number).empty())
            text = image::read_file(work_ / "settings.cpf");
        return text;
    }

    MappedFile disk_bytes_;
    int memory_ = ::memfd_create("partition", 0);
    bench::WorkFolder work_{"tappet-judge"};
    std::map<std::uint32_t, std::string> kernels_{};
    std::map<std::int64_t, std::string> settings_{};
};

} // namespace tappet::bench
