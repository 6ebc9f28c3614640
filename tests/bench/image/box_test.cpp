// A flashed image on an emulated box with UEFI: it boots and works; a new version stays once it has proven
// itself; a version that fails in any way is rolled back at the next boot.
#include "board/box/update.hpp"
#include "tests/bench/image/data_partition.hpp"
#include "tests/bench/image/written_images.hpp"
#include "toolchain/tools/bench/folders.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <iostream>
#include <regex>

namespace tappet::bench {
namespace {

using init::SlotState;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;
namespace fs = std::filesystem;

double seconds_after(const std::string& text, const std::string& words) {
    std::smatch found;
    return std::regex_search(text, found, std::regex(words + " ([0-9.]+) s")) ? std::stod(found[1]) : -1.0;
}

constexpr const char* kernel_words =
    "console=ttyS0 quiet panic=-1 sysctl.kernel.sched_rt_runtime_us=-1 cryptomgr.notests rdinit=/init";

TEST(Box, works_from_the_first_boot_and_keeps_a_working_update) {
    EmulatedBox box{image("loom") / "disk.img"};
    ASSERT_EQ(image::install(box.disk(), image("loom") / "tappet.efi"), 3u);
    box.switch_on({"-no-reboot", "-m", "160"}); // MB, of which its UEFI takes most
    const std::string said = box.await_end();
    SCOPED_TRACE(said);
    EXPECT_THAT(said, HasSubstr("revision 3 is on trial"));
    EXPECT_THAT(said, HasSubstr("A TEST IMAGE"));
    EXPECT_THAT(said, HasSubstr("Secure Boot is off"));
    EXPECT_THAT(said, HasSubstr("armed on board \"bench\", 0 warnings"));
    const double to_armed = seconds_after(said, "init: .* armed");
    // No upper bound is checked: the time depends on the host's disk.
    EXPECT_GT(to_armed, 0.0);
    std::cout << "init to armed: " << to_armed << " s" << std::endl;
    EXPECT_THAT(said, HasSubstr("\"picks\": 60"));
    EXPECT_THAT(said, HasSubstr("revision 3 has proven itself and stays"));
    EXPECT_THAT(said, HasSubstr("power off"));
    EXPECT_TRUE(has_kept(box, 2));
    EXPECT_EQ(slot(box, 2).revision, 3u);
}

/// The part that is short enough for ci/test.
TEST(Box, arms_and_works_when_started_at_its_kernel) {
    EmulatedBox box{image("loom") / "disk.img"};
    box.switch_on_at_kernel(cache_folder() / "kernel/box/vmlinuz", image("loom") / "root.cpio.zst",
                            kernel_words);
    const std::string said = box.await(" picks=1");
    SCOPED_TRACE(said);
    EXPECT_THAT(said, HasSubstr("data partition at /var/lib/tappet is up"));
    EXPECT_THAT(said, HasSubstr("armed on board \"bench\", 0 warnings"));
    EXPECT_THAT(said, HasSubstr(" picks=1")) << "it weaves: the number of picks is 1 or begins with 1";
}

TEST(Box, rolls_back_and_names_missing_hardware_when_an_update_cannot_arm) {
    EmulatedBox box{image("loom") / "disk.img"};
    image::install(box.disk(), image("production") / "tappet.efi");
    box.switch_on({"-object", "can-bus,id=bus", "-device", "kvaser_pci,canbus=bus"});
    const std::string said = box.await_end(); // the end of the old version's plant
    SCOPED_TRACE(said);
    EXPECT_THAT(said, HasSubstr("CAN interface can0 at 1000000 bit/s is up"));
    EXPECT_THAT(said, HasSubstr("network eth0 as 192.168.7.1/24 is up"));
    EXPECT_THAT(said, HasSubstr("data partition at /var/lib/tappet is up"));
    EXPECT_THAT(said, HasSubstr("GPIO chip INTC1020:00 is missing; check its label in the board"));
    EXPECT_THAT(said, HasSubstr("it was on trial: the box goes back to the other slot"));
    EXPECT_THAT(said, HasSubstr("\"picks\": 60")) << "of the old one";
    EXPECT_EQ(slot(box, 2).state, SlotState::failed);
}

TEST(Box, rolls_back_by_its_watchdog_when_an_update_hangs) {
    EmulatedBox box{image("loom") / "disk.img"};
    image::install(box.disk(), image("hanging") / "tappet.efi");
    box.switch_on();
    const std::string said = box.await("carpet-loom: armed");
    SCOPED_TRACE(said);
    EXPECT_THAT(said, HasSubstr("hang: it hangs"));
    EXPECT_THAT(said, HasSubstr("carpet-loom: armed"));
    box.switch_off();
    EXPECT_EQ(slot(box, 2).state, SlotState::failed);
}

TEST(Box, is_reset_by_its_watchdog_when_machine_and_guardian_die_at_once) {
    EmulatedBox box{image("orphaned") / "disk.img"};
    box.switch_on_at_kernel(cache_folder() / "kernel/box/vmlinuz", image("orphaned") / "root.cpio.zst",
                            kernel_words);
    box.await("its outputs may not be safe");
    box.forget();
    const std::string said = box.await("armed on board");
    SCOPED_TRACE(said);
    EXPECT_THAT(said, HasSubstr("Tappet, carpet-loom on board")) << "it began anew before it armed again";
    EXPECT_THAT(said, Not(HasSubstr("it is started again")));
}

TEST(Box, rolls_back_and_reports_why_when_an_update_crashes) {
    EmulatedBox box{image("lonely") / "disk.img"}; // its old version does not end, so `tappet box` can ask it
    image::install(box.disk(), image("crashing") / "tappet.efi");
    box.switch_on();
    const std::string said = box.await("the version in the other slot failed its trial");
    SCOPED_TRACE(said);
    EXPECT_THAT(said, HasSubstr("it was on trial: the box goes back to the other slot"));
    box.forget();
    box.await(is_complete);
    const std::string status = asked("box " + box.address());
    EXPECT_THAT(status, HasSubstr("runs: version 1, revision 2, good"));
    EXPECT_THAT(status, HasSubstr("other: version unknown, revision 0, failed"));
    EXPECT_THAT(status, HasSubstr("the firmware ended with code"))
        << "the last message of the version that failed";
}

TEST(Box, rolls_back_when_an_update_misses_a_deadline) {
    EmulatedBox box{image("loom") / "disk.img"};
    image::install(box.disk(), image("late") / "tappet.efi");
    box.switch_on({"-no-shutdown"});
    const std::string said = box.await("the version in the other slot failed its trial");
    SCOPED_TRACE(said);
    EXPECT_THAT(said, HasSubstr("missed its deadline on trial: the machine is stopped"));
    box.switch_off();
    EXPECT_EQ(slot(box, 2).state, SlotState::failed);
}

TEST(Box, installs_a_signed_update_over_the_network_on_a_button_press) {
    EmulatedBox box{image("lonely") / "disk.img"};
    const std::string update = (image("newer") / "update.tap").string();
    box.switch_on();
    box.await(is_complete);
    const std::string there = "update " + box.address() + " ";

    // Invalid updates, and updates changed in transit.
    EXPECT_THAT(asked(there + TAPPET_IMAGE), HasSubstr("is not a complete update"));
    const fs::path changed = box / "changed.tap";
    std::string bytes = image::read_file(update);
    bytes[bytes.size() / 2] ^= 1;
    image::write_file(changed, bytes);
    EXPECT_THAT(asked(there + changed.string()), HasSubstr("its signature does not match this box's key"));
    EXPECT_THAT(asked(there + (image("lonely") / "update.tap").string()),
                HasSubstr("the box refuses it: it is version 1, and this box has 1"));
    EXPECT_THAT(asked(there + (image("production") / "update.tap").string()),
                HasSubstr("the box refuses it: it is for carpet-loom on board ipc-x86_64"));
    const std::string raw = "exec 3<>/dev/tcp/" + std::regex_replace(box.address(), std::regex{":"}, "/");
    EXPECT_THAT(run_line("bash -c '" + raw + "; echo weave >&3; cat <&3'").text,
                HasSubstr("unknown request; known are status, update and order"));
    run_line("bash -c '" + raw +
             "; echo update >&3; head -c 5000 /dev/urandom >&3'"); // hangs up without completing

    EXPECT_THAT(asked(there + update), HasSubstr("version 2 is received and its signature is valid"));
    EXPECT_THAT(asked("box " + box.address()), HasSubstr("an update waits for the power button"));
    box.press_power_button();
    const std::string said = box.await_end(); // the new version's plant ends it
    SCOPED_TRACE(said);
    EXPECT_THAT(said, HasSubstr("version 2 is written and read back"));
    EXPECT_THAT(said, HasSubstr("image 2"));
    EXPECT_THAT(said, HasSubstr("revision 3 has proven itself and stays"));
    EXPECT_TRUE(has_kept(box, 2));
}

TEST(Box, obeys_signed_orders_when_its_power_button_is_pressed) {
    EmulatedBox box{image("lonely") / "disk.img"};
    box.switch_on();
    box.await(is_complete);
    const std::string there = "box " + box.address() + " ", keys = " --key " + image("keys").string();
    EXPECT_THAT(asked(there + "roll-back --key " + image("others").string()),
                HasSubstr("its signature does not match this box's key"));
    EXPECT_THAT(asked(there + "rol-back" + keys), HasSubstr("did you mean roll-back?"));
    EXPECT_THAT(asked(there + "factory-reset" + keys), HasSubstr("press the power button at the machine"));
    box.press_power_button();
    box.await("settings and learned values are gone");
    box.forget();
    box.await(is_complete);
    EXPECT_THAT(asked(there + "roll-back" + keys), HasSubstr("press the power button at the machine"));
    box.press_power_button();
    const std::string said = box.await("revision 3 is on trial");
    SCOPED_TRACE(said);
    EXPECT_THAT(said, HasSubstr("the version of the other slot goes on trial"));
}

TEST(Box, is_measured_when_its_power_button_is_pressed) {
    EmulatedBox box{image("lonely") / "disk.img"};
    box.switch_on();
    box.await(is_complete);
    const std::string there = "box " + box.address();
    EXPECT_THAT(asked(there + " measure --key " + image("keys").string()),
                HasSubstr("measure; press the power button"));
    box.press_power_button();
    box.await("the box is measured; tappet box shows the figures");
    box.forget();
    box.await(is_complete);
    const std::string status = asked(there);
    SCOPED_TRACE(status);
    EXPECT_THAT(status, HasSubstr("hardware latency: "));
    EXPECT_THAT(status, HasSubstr("processor 0: woke at most "));
    EXPECT_THAT(status, HasSubstr("in addition to its worst response of "));
    EXPECT_THAT(status, HasSubstr("hold the table's claims"))
        << "the box can or cannot hold them: times of an emulated box mean nothing";
}

TEST(Box, boots_only_software_of_its_owner_under_secure_boot) {
    const fs::path keys = image("keys");
    { // a new version with a changed byte, then one signed by another owner
        EmulatedBox box{image("production") / "disk.img", keys};
        const fs::path changed = box / "changed.efi";
        std::string bytes = image::read_file(image("production") / "tappet.efi");
        bytes[bytes.size() / 2] ^= 1;
        image::write_file(changed, bytes);
        for (const fs::path& kernel : {changed, image("foreign") / "tappet.efi"}) {
            image::install(box.disk(), kernel);
            box.switch_on();
            const std::string said = box.await("the version in the other slot failed its trial");
            SCOPED_TRACE(said);
            EXPECT_THAT(said, HasSubstr("Access Denied"));
            EXPECT_THAT(said, HasSubstr("Secure Boot is on: only signed code runs"));
            EXPECT_THAT(said, Not(HasSubstr("is on trial")));
            box.switch_off();
        }
    }
    { // a disk whose loader another owner signed
        EmulatedBox box{image("foreign") / "disk.img", keys};
        box.switch_on({"-no-reboot"});
        EXPECT_THAT(box.await("Access Denied"), Not(HasSubstr("EFI Boot Guard")));
    }
}

TEST(Box, repeats_a_trial_after_an_orderly_shutdown) {
    EmulatedBox box{image("loom") / "disk.img"};
    image::install(box.disk(), image("lonely") / "tappet.efi");
    box.switch_on({"-no-reboot"});
    EXPECT_THAT(box.await(is_complete), HasSubstr("revision 3 is on trial"));
    box.press_power_button();
    const std::string said = box.await_end();
    SCOPED_TRACE(said);
    EXPECT_THAT(said, HasSubstr("the power button ends it"));
    EXPECT_THAT(said, Not(HasSubstr("has proven itself")));
    EXPECT_EQ(slot(box, 2).state, SlotState::installed);
}

TEST(Box, does_not_repeat_a_failed_trial_after_a_shutdown) {
    EmulatedBox box{image("lonely") / "disk.img"};
    image::install(box.disk(), image("crashing") / "tappet.efi");
    box.switch_on({"-no-reboot"});
    box.await("it was on trial: the box goes back to the other slot");
    box.press_power_button();
    const std::string said = box.await_end();
    SCOPED_TRACE(said);
    EXPECT_THAT(said, HasSubstr("the power button ends it"));
    EXPECT_EQ(slot(box, 2).state, SlotState::testing)
        << "the loader rolls back a slot in this state at the next boot";
}

// A stick is a disk that was plugged in later. Since its plant does not end, the machine works until the
// button is pressed.
TEST(Box, installs_a_signed_update_from_a_stick_on_a_button_press) {
    EmulatedBox box{image("lonely") / "disk.img"};
    const fs::path stick = image("newer") / "update.tap";
    box.switch_on({"-drive", "if=none,id=stick,readonly=on,format=raw,file=" + stick.string(), "-device",
                   "qemu-xhci", "-device", "usb-storage,drive=stick"});
    box.await(is_complete);
    box.press_power_button();
    const std::string said = box.await_end(); // the new version's plant ends it
    SCOPED_TRACE(said);
    EXPECT_THAT(said, HasSubstr("version 2 is written and read back"));
    EXPECT_THAT(said, HasSubstr("image 2"));
    EXPECT_THAT(said, HasSubstr("revision 3 is on trial"));
    EXPECT_THAT(said, HasSubstr("revision 3 has proven itself and stays"));
    EXPECT_THAT(said, HasSubstr("is refused: it is version 2, and this box has 2")) << "once is enough";
    EXPECT_TRUE(has_kept(box, 2));
}

TEST(Box, boots_with_a_damaged_data_partition) {
    EmulatedBox box{image("lonely") / "disk.img"};
    const DataPartition data{box.disk(), box / "data"};
    const std::string there = "box " + box.address() + " ", keys = " --key " + image("keys").string();
    { // the superblock and the group descriptor table, which have backup copies
        data.write("/kept", "whole");
        data.damage(0, 3 * 1024);
        box.switch_on();
        const std::string said = box.await("armed on board");
        SCOPED_TRACE(said);
        EXPECT_THAT(said, HasSubstr("the data partition is repaired"));
        EXPECT_THAT(said, Not(HasSubstr("was created anew")));
        box.switch_off();
        EXPECT_EQ(data.read("/kept"), "whole");
    }
    { // all of it
        data.damage(0, image::partitions()[3].bytes());
        box.switch_on();
        const std::string said = box.await("armed on board");
        SCOPED_TRACE(said);
        EXPECT_THAT(said,
                    HasSubstr("the data partition could not be repaired, and was created anew: SETTINGS"));
        EXPECT_THAT(said, Not(HasSubstr("is full")));
        box.switch_off();
        EXPECT_THAT(data.read("/box.log"), HasSubstr("and was created anew"));
    }
    { // full to the last block
        data.fill();
        box.switch_on();
        const std::string said = box.await("armed on board");
        SCOPED_TRACE(said);
        EXPECT_THAT(said, HasSubstr("the data partition is full"));
        box.await(is_complete);
        EXPECT_THAT(asked(there + "factory-reset" + keys), HasSubstr("press the power button"));
        box.press_power_button();
        box.await("begins anew");
        box.forget();
        EXPECT_THAT(box.await("armed on board"), Not(HasSubstr("is full")));
    }
}

std::string folder_of_properties(const char* name) {
    return "/properties-" + box::manifest_of(image::read_file(image(name) / "manifest")).layout;
}

std::string property(const char* name, int value) {
    return std::string{"<simple name=\""} + name + "\" type=\"long\"><value>" + std::to_string(value) +
           "</value></simple>\n";
}

/// Waits, once the button is pressed, until the box is off or has started again.
std::string after_the_button(EmulatedBox& box, const char* wanted) {
    box.forget();
    box.press_power_button();
    return box.await(wanted);
}

TEST(Box, keeps_the_settings_of_each_layout_of_properties) {
    EmulatedBox box{image("milling_older") / "disk.img"};
    const DataPartition data{box.disk(), box / "data"};
    const std::string older = folder_of_properties("milling_older"),
                      newer = folder_of_properties("milling_newer");
    ASSERT_NE(older, newer);
    data.make_folder(older);
    data.write(older + "/mill.cpf",
               "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<!DOCTYPE properties SYSTEM \"cpf.dtd\">\n"
               "<properties>\n" +
                   property("depth", 7) + property("flutes", 4) + "</properties>\n");
    const std::string keys = " --key " + image("keys").string();
    box.switch_on();
    box.await(is_complete);
    EXPECT_THAT(asked("update " + box.address() + " " + (image("milling_newer") / "update.tap").string()),
                HasSubstr("its properties differ"));
    after_the_button(box, is_complete);
    const std::string updated = box.await("has proven itself and stays");
    SCOPED_TRACE(updated);
    EXPECT_THAT(updated, HasSubstr("\"flutes\"")) << "the dropped property is reported";
    EXPECT_THAT(asked("box " + box.address() + " roll-back" + keys), HasSubstr("press the power button"));
    const std::string back = after_the_button(box, "has proven itself and stays");
    SCOPED_TRACE(back);
    EXPECT_THAT(back, HasSubstr("\"coolant\""));
    after_the_button(box, "power off");
    box.switch_off();
    EXPECT_THAT(data.read(newer + "/mill.cpf"), AllOf(HasSubstr("<value>7<"), HasSubstr("coolant")));
    EXPECT_THAT(data.read(older + "/mill.cpf"), AllOf(HasSubstr("<value>7<"), HasSubstr("<value>4<")));
}

TEST(Box, has_a_reproducible_image) {
    const EmulatedBox elsewhere{image("loom") / "disk.img"};
    const fs::path again = elsewhere / "again";
    const Ended ended = run_line(std::string{WRITE_LOOM} + " --to " + again.string());
    ASSERT_EQ(ended.exit_code, 0) << ended.text;
    EXPECT_THAT(ended.text, HasSubstr("goal 12: held"));
    for (const char* part : {"disk.img", "tappet.efi", "sbom.cdx.json"})
        EXPECT_EQ(
            run_line("cmp " + (again / part).string() + " " + (image("loom") / part).string()).exit_code, 0)
            << part;
}

} // namespace
} // namespace tappet::bench
