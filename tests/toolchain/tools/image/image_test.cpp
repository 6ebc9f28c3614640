// The contents of an image and the disks that may receive it, without a kernel of ours: the test makes the
// kernel's tables and the disks.
#include "tests/toolchain/folder.hpp"
#include "toolchain/tools/image/disk.hpp"
#include "toolchain/tools/image/flash.hpp"
#include "toolchain/tools/image/image.hpp"
#include "toolchain/tools/image/kernel_modules.hpp"
#include "toolchain/tools/image/keys.hpp"
#include "toolchain/tools/image/sbom.hpp"
#include "toolchain/tools/image/slots.hpp"
#include "toolchain/tools/image/tool.hpp"
#include "toolchain/tools/image/unified_kernel.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <sstream>

namespace tappet::image {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;
namespace fs = std::filesystem;

struct Folder : testing::Test {
    test::Folder folder;
    static std::string fault_of(const auto& act) {
        try {
            act();
        } catch (const Fault& fault) {
            return fault.what();
        }
        return "none";
    }
};

struct Modules : Folder {
    Modules() {
        write_file(folder / "modules.dep", "kernel/can-dev.ko:\n"
                                           "kernel/sja1000.ko: kernel/can-dev.ko\n"
                                           "kernel/peak_pci.ko: kernel/sja1000.ko kernel/can-dev.ko\n"
                                           "kernel/ext4.ko: kernel/jbd2.ko\n"
                                           "kernel/jbd2.ko:\n"
                                           "kernel/crc32c_fast.ko:\n"
                                           "kernel/crc32c_plain.ko:\n");
        write_file(folder / "modules.alias", "# Aliases\n"
                                             "alias pci:v0000001Cd* peak_pci\n"
                                             "alias of:N*Tpeak* can_dev\n"
                                             "alias fs-ext4 ext4\n"
                                             "alias cpu:type:x86* crc32c_fast\n"
                                             "alias crc32c crc32c_fast\n"
                                             "alias crc32c crc32c_plain\n");
        write_file(folder / "modules.softdep", "softdep jbd2 pre: crc32c post: nobody\n");
        write_file(folder / "modules.builtin", "kernel/drivers/serial.ko\n");
    }
    [[nodiscard]] std::string table(const std::vector<std::string>& rows) const {
        return choose_modules(rows, {}, folder).table;
    }
};

TEST_F(Modules, are_listed_with_their_dependencies_and_devices) {
    EXPECT_EQ(table({"peak_pci restart=1"}), "module peak_pci restart=1\n"
                                             "needs can_dev\n"
                                             "needs sja1000\n"
                                             "alias pci:v0000001Cd*\n"
                                             "module can_dev\n"
                                             "module sja1000\n"
                                             "needs can_dev\n");
}

TEST_F(Modules, are_always_loaded_when_they_drive_no_device) {
    EXPECT_THAT(table({"can-dev"}), HasSubstr("module can_dev\nalias always\n"));
}

TEST_F(Modules, include_early_dependencies_of_later_modules) {
    const std::string text = choose_modules({"can-dev"}, {"peak_pci"}, folder).table;
    EXPECT_THAT(text, HasSubstr("module can_dev\nalias always\nlater-module peak_pci\nneeds can_dev\n"));
    EXPECT_THAT(text, HasSubstr("\nmodule sja1000\n"));
}

TEST_F(Modules, include_the_generic_modules_that_the_kernel_would_request) {
    const std::string text = table({"ext4"});
    EXPECT_THAT(text, HasSubstr("module ext4\nneeds crc32c_plain\nneeds jbd2\nalias always\n"));
    EXPECT_THAT(text, Not(HasSubstr("crc32c_fast")));
    EXPECT_EQ(choose_modules({"ext4"}, {}, folder).files.size(), 3u);
}

TEST_F(Modules, are_omitted_when_built_into_the_kernel) { EXPECT_EQ(table({"serial"}), ""); }

TEST_F(Modules, are_refused_when_the_kernel_lacks_them) {
    EXPECT_THAT(fault_of([&] { static_cast<void>(table({"peek_pci"})); }),
                HasSubstr("has no module \"peek_pci\"; correct the board's kernel_modules(..)"));
}

struct Disk : Folder {
    fs::path disk = folder / "disk.img";
    void make(const std::string& kernel) const {
        write_file(folder / "tappet.efi", kernel);
        write_file(folder / "loader.efi", "a loader");
        write_disk(disk,
                   {.loader = folder / "loader.efi",
                    .kernel = folder / "tappet.efi",
                    .header = box::header_of({{"loom", "my_box", "0", 7, 1}, kernel, {}}, nullptr),
                    .certificates = {},
                    .watchdog_s = 30},
                   folder);
    }
    [[nodiscard]] init::BootState slot(std::size_t i) const {
        return read_slot(disk, partitions()[i]).value();
    }
};

TEST_F(Disk, boots_its_first_slot_and_falls_back_to_its_second) {
    make("version 1");
    EXPECT_EQ(slot(1).kernel, "C:SLOTA:tappet.efi");
    EXPECT_EQ(slot(2).kernel, "C:SLOTB:tappet.efi");
    EXPECT_GT(slot(1).revision, slot(2).revision);
    for (const std::size_t i : {1u, 2u}) EXPECT_EQ(slot(i).state, init::SlotState::good);
    EXPECT_EQ(slot(1).watchdog_s, 30u);
}

TEST_F(Disk, is_the_same_bit_by_bit_when_it_is_written_again) {
    make("version 1");
    const std::string first = read_file(disk);
    make("version 1");
    EXPECT_TRUE(read_file(disk) == first);
    make("version 2");
    EXPECT_FALSE(read_file(disk) == first) << "else this compares nothing";
}

TEST_F(Disk, receives_a_new_version_in_the_unused_slot_for_one_trial) {
    make("version 1");
    write_file(folder / "new.efi", "version 2");
    EXPECT_EQ(install(disk, folder / "new.efi"), 3u);
    EXPECT_EQ(slot(1).revision, 2u) << "what runs stays";
    EXPECT_EQ(slot(2).revision, 3u);
    EXPECT_EQ(slot(2).state, init::SlotState::installed);
    EXPECT_EQ(install(disk, folder / "new.efi"), 4u);
    EXPECT_EQ(slot(1).revision, 4u) << "then the other is not in use";
}

TEST_F(Disk, is_refused_without_our_slots) {
    write_file(disk, std::string(1'000'000, 'x'));
    EXPECT_THAT(fault_of([&] { install(disk, disk); }), HasSubstr("mcopy failed"));
}

TEST_F(Disk, refuses_a_kernel_that_is_larger_than_a_slot) {
    EXPECT_THAT(fault_of([&] { make(std::string(partitions()[1].bytes(), 'x')); }),
                HasSubstr("leave modules out of the board"));
}

TEST_F(Disk, names_the_version_in_each_slot) {
    make("version 7");
    for (const std::size_t i : {1u, 2u}) {
        const std::string at =
            disk.string() + "@@" + std::to_string(partitions()[i].first_sector * sector_bytes);
        run_tool(
            {"mcopy", "-n", "-i", at, "::" + std::string{box::header_file}, (folder / "header").string()});
        EXPECT_EQ(box::manifest_of(read_file(folder / "header")).version, 7u);
    }
}

struct UnifiedKernel : Folder {
    const std::string stub = "/usr/lib/x86_64-linux-gnu/efibootguard/kernel-stubx64.efi";
    const std::string kernel = read_file(stub); // any program will do
    std::string bytes;
    UnifiedKernel() {
        write_file(folder / "root", std::string(50'000, 'r'));
        run_tool({"bg_gen_unified_kernel", stub, stub, (folder / "unified").string(), "--cmdline", "quiet",
                  "--initrd", (folder / "root").string()});
        bytes = read_file(folder / "unified");
    }
    /// A row of the table of sections: number, name, size, two addresses and place in the file.
    [[nodiscard]] std::string section(const std::string& name) const {
        write_file(folder / "unified", bytes);
        std::istringstream table{run_tool({"objdump", "-h", (folder / "unified").string()})};
        std::string word, size, address, place;
        while (table >> word && word != name) {
        }
        table >> size >> address >> address >> place;
        return bytes.substr(std::stoul(place, nullptr, 16), std::stoul(size, nullptr, 16));
    }
    [[nodiscard]] unsigned long loaded_bytes() const {
        write_file(folder / "unified", bytes);
        const std::string said = run_tool({"objdump", "-p", (folder / "unified").string()});
        return std::stoul(said.substr(said.find("SizeOfImage") + 11), nullptr, 16);
    }
};

TEST_F(UnifiedKernel, takes_no_more_memory_than_its_parts) {
    EXPECT_GT(loaded_bytes(), 100'000'000u) << "else there is nothing to do";
    draw_together(bytes);
    EXPECT_LT(loaded_bytes(), 500'000u);
    EXPECT_TRUE(section(".kernel").starts_with(kernel));
    EXPECT_TRUE(section(".initrd").starts_with(std::string(50'000, 'r')));
}

TEST_F(UnifiedKernel, is_refused_when_it_is_malformed) {
    const std::string whole = bytes;
    for (const std::size_t left : {0u, 60u, 300u}) {
        bytes = whole.substr(0, left);
        EXPECT_THAT(fault_of([&] { draw_together(bytes); }), HasSubstr("the unified kernel image is "));
    }
    bytes = std::string(4096, 'x');
    EXPECT_THAT(fault_of([&] { draw_together(bytes); }), HasSubstr("the unified kernel image is "));
}

struct Keys : Folder {
    fs::path keys = folder / "keys", loader = folder / "loader.efi";
    Keys() {
        write_keys(keys);
        write_file(loader, read_file("/usr/lib/x86_64-linux-gnu/efibootguard/efibootguardx64.efi"));
    }
    [[nodiscard]] std::string verify(const fs::path& certificate) const {
        return run_tool({"osslsigncode", "verify", "-CAfile", certificate.string(), "-in", loader.string()},
                        Trouble::is_told);
    }
};

TEST_F(Keys, sign_reproducibly_and_no_other_key_verifies) {
    sign_program(loader, keys);
    const std::string first = read_file(loader);
    EXPECT_THAT(verify(keys / "db.crt"), HasSubstr("Succeeded"));
    EXPECT_THAT(verify(keys / "KEK.crt"), Not(HasSubstr("Succeeded")));
    write_file(loader, read_file("/usr/lib/x86_64-linux-gnu/efibootguard/efibootguardx64.efi"));
    sign_program(loader, keys);
    EXPECT_TRUE(read_file(loader) == first);
}

TEST_F(Keys, are_never_overwritten_and_only_their_owner_reads_the_secret) {
    EXPECT_THAT(fault_of([&] { write_keys(keys); }), HasSubstr("is there already; name another folder"));
    for (const char* secret : {"secret", "db.key", "KEK.key", "PK.key"})
        EXPECT_EQ(fs::status(keys / secret).permissions(), fs::perms::owner_read) << secret;
}

TEST_F(Keys, sign_nothing_without_the_secret_key) {
    fs::remove(keys / "secret");
    EXPECT_THAT(fault_of([&] { sign(folder, keys); }), HasSubstr("has no secret key"));
}

struct Flash : Folder {
    fs::path image = folder / "disk.img", device = folder / "device";
    Flash() {
        write_file(image, "an image" + std::string(3'000'000, 'i'));
        write_file(device, std::string(5'000'000, '\0'));
    }
};

TEST_F(Flash, writes_every_byte_and_erases_only_the_old_tables) {
    ASSERT_EQ(refusal_to_flash(image, device, false), "");
    std::uint64_t last = 0, all = 0;
    flash(image, device, [&](std::uint64_t bytes, std::uint64_t of) { last = bytes, all = of; });
    const std::string after = read_file(device);
    EXPECT_TRUE(after.starts_with(read_file(image)));
    EXPECT_EQ(after.size(), 5'000'000u);
    EXPECT_LT(last, all);
}

TEST_F(Flash, erases_the_second_copy_of_an_old_partition_table) {
    write_file(device, std::string(5'000'000, 'o'));
    flash(image, device, {});
    EXPECT_EQ(read_file(device).find_last_not_of('\0'), 5'000'000u - 64 * 512 - 1);
}

TEST_F(Flash, refuses_a_disk_with_data_unless_it_may_be_erased) {
    write_file(device, std::string(5'000'000, 'o'));
    EXPECT_THAT(refusal_to_flash(image, device, false),
                HasSubstr("is not empty: its contents would be lost"));
    EXPECT_EQ(refusal_to_flash(image, device, true), "");
}

TEST_F(Flash, refuses_a_target_that_is_too_small_missing_or_no_disk) {
    write_file(device, "");
    EXPECT_THAT(refusal_to_flash(image, device, false), HasSubstr("take a larger disk"));
    EXPECT_THAT(refusal_to_flash(image, folder / "nothing", false),
                HasSubstr("is not there; lsblk lists the disks"));
    EXPECT_THAT(refusal_to_flash(image, "/dev/null", true), HasSubstr("is neither a disk nor a file"));
}

TEST_F(Flash, refuses_the_disk_that_this_machine_lives_on) {
    const std::string root = run_tool({"findmnt", "-n", "-o", "SOURCE", "/"});
    const std::string source = root.substr(0, root.find('\n'));
    if (!fs::is_block_file(source)) GTEST_SKIP() << "the root here is " << source << ", no disk";
    EXPECT_THAT(refusal_to_flash(image, source, true),
                testing::AnyOf(HasSubstr("is mounted at /"), HasSubstr("name the whole disk")));
}

struct Bill : Folder {};

TEST_F(Bill, names_the_package_of_every_file_that_was_linked) {
    const std::string archive = run_tool({"g++", "-print-file-name=libstdc++.a"});
    write_file(folder / "program.inputs", "program: \\\n  " + archive.substr(0, archive.find('\n')) +
                                              " \\\n  ours.a \\\n  libtappet_libmodbus.a\n\nours.a:\n");
    fs::create_directories(folder / "libmodbus");
    write_file(folder / "libmodbus/VERSION", "3.1.6-2\n");
    const auto parts = linked_into(folder / "program.inputs", folder);
    ASSERT_EQ(parts.size(), 2u);
    EXPECT_EQ(parts[0].name + " " + parts[0].version, "libmodbus 3.1.6-2");
    EXPECT_THAT(parts[1].name, HasSubstr("libstdc++"));
    EXPECT_EQ(parts[1].version, debian_package(parts[1].name).version);
}

TEST_F(Bill, refuses_files_of_no_package) {
    write_file(folder / "program.inputs", "program: \\\n  /usr/lib/of_nobody.a\n");
    EXPECT_THAT(fault_of([&] { static_cast<void>(linked_into(folder / "program.inputs", folder)); }),
                HasSubstr("no Debian package holds /usr/lib/of_nobody.a"));
    EXPECT_THAT(fault_of([&] { static_cast<void>(linked_into(folder / "nothing", folder)); }),
                HasSubstr("build the firmware by tappet_machine(..)"));
}

TEST_F(Bill, is_sorted_without_duplicates_and_dates) {
    const Component b{"b", "2"}, a{"a", "1"};
    const std::string bill = bill_of_materials("loom", "box", 7, {b, a, b});
    EXPECT_EQ(bill, bill_of_materials("loom", "box", 7, {a, b}));
    EXPECT_THAT(bill, HasSubstr("\"purl\": \"pkg:deb/debian/a@1?arch=amd64\""));
    EXPECT_THAT(bill, HasSubstr("\"bomFormat\": \"CycloneDX\""));
    EXPECT_THAT(bill, Not(HasSubstr("timestamp")));
}

} // namespace
} // namespace tappet::image
