// SPDX-License-Identifier: Apache-2.0
// Lays out the partitions; sgdisk, mtools and mke2fs write them, without root or a mount.
#include "toolchain/tools/image/disk.hpp"

#include "board/box/slot.hpp"
#include "board/box/update.hpp"
#include "toolchain/tools/image/tool.hpp"

#include <array>
#include <fstream>

namespace tappet::image {

namespace fs = std::filesystem;

namespace {

constexpr std::uint64_t sectors_of_mib(std::uint64_t mib) { return mib * 1024 * 1024 / sector_bytes; }

/// Fixed: nothing in an image is random.
std::string guid(unsigned number) { return "74617070-6574-4d00-8000-00000000000" + std::to_string(number); }

void make_fat(const fs::path& file, const Partition& partition, unsigned number) {
    fs::remove(file);
    write_file(file, "");
    fs::resize_file(file, partition.bytes());
    run_tool({"mkfs.vfat", "--invariant", "-i", "7461700" + std::to_string(number), "-n", partition.label,
              "-F", "16", file.string()});
}

void put(const fs::path& fat, const fs::path& file, const std::string& name) {
    run_tool({"mcopy", "-i", fat.string(), file.string(), "::" + name});
}

/// Writes the file system of a slot: the kernel, the loader's state, its label.
void write_slot(const fs::path& file, const Partition& partition, const DiskParts& parts,
                const init::BootState& state, unsigned number, const fs::path& work) {
    make_fat(file, partition, number);
    std::string label;
    for (const char character : partition.label) label += {character, '\0'}; // UTF-16
    write_file(work / "EFILABEL", label);
    write_file(work / init::boot_state_file, init::encode(state));
    put(file, work / "EFILABEL", "EFILABEL");
    put(file, work / init::boot_state_file, std::string{init::boot_state_file});
    write_file(work / box::header_file, parts.header);
    put(file, work / box::header_file, std::string{box::header_file});
    write_file(work / box::record_file, box::encode(box::Record{}));
    put(file, work / box::record_file, std::string{box::record_file});
    put(file, parts.kernel, file_in_slot);
}

/// Copies a file; blocks of zeros stay holes.
void copy_into(std::fstream& disk, const fs::path& file, const Partition& partition) {
    std::ifstream from{file, std::ios::binary};
    std::string block(1024 * 1024, '\0');
    for (std::uint64_t at = 0;
         from.read(block.data(), static_cast<std::streamsize>(block.size())) || from.gcount() > 0;
         at += block.size()) {
        const auto count = static_cast<std::size_t>(from.gcount());
        if (block.find_first_not_of('\0') >= count) continue;
        disk.seekp(static_cast<std::streamoff>(partition.first_sector * sector_bytes + at));
        disk.write(block.data(), static_cast<std::streamsize>(count));
    }
    if (!from.is_open() || from.bad()) throw Fault("cannot read " + file.string() + "; check the disk");
}

} // namespace

const std::vector<Partition>& partitions() {
    static const std::vector<Partition> all = [] {
        std::vector<Partition> rows{{"tappet-loader", "LOADER", "EF00", 2048, sectors_of_mib(16)},
                                    {"tappet-a", "SLOTA", "0700", 0, sectors_of_mib(48)},
                                    {"tappet-b", "SLOTB", "0700", 0, sectors_of_mib(48)},
                                    {"tappet-data", "DATA", "8300", 0, sectors_of_mib(64)}};
        for (std::size_t i = 1; i < rows.size(); ++i)
            rows[i].first_sector = rows[i - 1].first_sector + rows[i - 1].sectors;
        return rows;
    }();
    return all;
}

std::string kernel_of(const Partition& slot) { return "C:" + slot.label + ":" + file_in_slot; }

std::uint64_t disk_bytes() {
    const Partition& last = partitions().back();
    return last.first_sector * sector_bytes + last.bytes() +
           1024 * 1024; // the last MiB holds the table's second copy
}

void write_data(const fs::path& file) {
    write_file(file, "");
    fs::resize_file(file, partitions()[3].bytes());
    run_tool({"mke2fs", "-q", "-F", "-t", "ext4", "-L", "tappet-data", "-U", guid(9), "-b", "1024", "-E",
              "hash_seed=" + guid(9) + ",root_owner=0:0,lazy_itable_init=0,lazy_journal_init=0,nodiscard",
              file.string()});
}

void write_disk(const fs::path& disk, const DiskParts& parts, const fs::path& work) {
    const std::vector<Partition>& rows = partitions();
    if (const std::uint64_t needed = fs::file_size(parts.kernel) + 1024 * 1024; needed > rows[1].bytes())
        throw Fault("the image has " + std::to_string(needed) + " bytes, and a slot " +
                    std::to_string(rows[1].bytes()) + "; leave modules out of the board");
    fs::remove(disk);
    write_file(disk, "");
    fs::resize_file(disk, disk_bytes());
    std::vector<std::string> words{"sgdisk", "-a", "8", "-U", guid(0)};
    for (std::size_t i = 0; i < rows.size(); ++i) {
        const std::string n = std::to_string(i + 1);
        const std::uint64_t last = rows[i].first_sector + rows[i].sectors - 1;
        words.insert(words.end(),
                     {"-n", n + ":" + std::to_string(rows[i].first_sector) + ":" + std::to_string(last), "-t",
                      n + ":" + rows[i].type, "-u", n + ":" + guid(static_cast<unsigned>(i + 1)), "-c",
                      n + ":" + rows[i].name});
    }
    words.push_back(disk.string());
    run_tool(words);

    make_fat(work / "loader.img", rows[0], 0);
    run_tool({"mmd", "-i", (work / "loader.img").string(), "::EFI", "::EFI/BOOT"});
    put(work / "loader.img", parts.loader, "EFI/BOOT/BOOTX64.EFI");
    if (!parts.certificates.empty()) run_tool({"mmd", "-i", (work / "loader.img").string(), "::KEYS"});
    for (const fs::path& each : parts.certificates)
        put(work / "loader.img", each, "KEYS/" + each.filename().string());
    for (std::uint32_t slot = 1; slot <= 2; ++slot)
        write_slot(work / (rows[slot].name + ".img"), rows[slot], parts,
                   {kernel_of(rows[slot]), 3 - slot, parts.watchdog_s, init::SlotState::good}, slot, work);
    write_data(work / "data.img");

    std::fstream file{disk, std::ios::binary | std::ios::in | std::ios::out};
    copy_into(file, work / "loader.img", rows[0]);
    copy_into(file, work / "tappet-a.img", rows[1]);
    copy_into(file, work / "tappet-b.img", rows[2]);
    copy_into(file, work / "data.img", rows[3]);
    if (!file.flush()) throw Fault("cannot write " + disk.string() + "; check the space");
}

} // namespace tappet::image
