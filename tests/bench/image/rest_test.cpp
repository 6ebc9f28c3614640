// A slot with a changed byte, or with an interrupted start: the other slot takes over, and hands back to a
// slot that is whole.
#include "tests/bench/image/written_images.hpp"
#include "toolchain/tools/bench/folders.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace tappet::bench {
namespace {

using init::SlotState;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

std::string kernel() { return image::read_file(image("lonely") / "tappet.efi"); }

TEST(Box, boots_the_other_slot_when_one_boot_file_is_torn) {
    EmulatedBox box{image("loom") / "disk.img"};
    std::string name;
    for (const char character : image::kernel_of(image::partitions()[1])) name += {character, '\0'};
    change_byte(box, 1, name, 0);
    box.switch_on({"-no-reboot"});
    const std::string said = box.await("Tappet, carpet-loom on board bench");
    SCOPED_TRACE(said);
    EXPECT_THAT(said, HasSubstr("Starting C:SLOTB:tappet.efi"));
    EXPECT_THAT(said, HasSubstr("Tappet, carpet-loom on board bench"));
}

/// Changes an unused part of the kernel's header: it boots, and works.
TEST(Box, gives_up_a_slot_whose_kernel_changed_on_the_disk) {
    EmulatedBox box{image("lonely") / "disk.img"};
    change_byte(box, 1, kernel().substr(0, 512), 0x20);
    box.switch_on();
    const std::string said = box.await("from the next start on the other slot is used");
    SCOPED_TRACE(said);
    EXPECT_THAT(said, HasSubstr("Starting C:SLOTA"));
    EXPECT_THAT(said, HasSubstr("the kernel in the slot that runs is not what was written there"));
    box.switch_off();
    box.switch_on();
    EXPECT_THAT(box.await("armed on board"), AllOf(HasSubstr("Starting C:SLOTB"), HasSubstr("given up")));
}

constexpr const char* has_started = "the start is over";

/// No operator is there: loader and watchdog act.
void works_on_the_other_slot(const EmulatedBox& started, const std::string& bytes, std::size_t behind,
                             const char* symptom) {
    EmulatedBox box{started.disk()};
    change_byte(box, 1, bytes, behind);
    box.switch_on();
    const std::string said = box.await(is_complete);
    SCOPED_TRACE(said);
    EXPECT_THAT(said,
                AllOf(HasSubstr(symptom), HasSubstr("Starting C:SLOTB"),
                      HasSubstr("a byte changed on the disk: it is given up"), HasSubstr("armed on board")));
    EXPECT_THAT(asked("box " + box.address()),
                AllOf(HasSubstr("runs: version 1, revision 1, good"),
                      HasSubstr("other: version 1, revision 0, given up: its kernel is not what was")));
}

TEST(Box, falls_back_when_its_proven_kernel_no_longer_boots) {
    EmulatedBox box{image("lonely") / "disk.img"};
    box.switch_on();
    box.await(has_started);
    box.switch_off();
    ASSERT_EQ(slot(box, 1).state, SlotState::installed);
    ASSERT_EQ(slot(box, 2).state, SlotState::good);

    const std::string unified = kernel(),
                      compressed = image::read_file(cache_folder() / "kernel/box/vmlinuz");
    works_on_the_other_slot(box, unified.substr(0, 512), unified.find("PE"), "Cannot load specified kernel");
    works_on_the_other_slot(box, compressed.substr(compressed.size() / 2, 512), 0,
                            "Failed to decompress kernel");
}

TEST(Box, returns_to_the_same_version_after_a_power_cut_during_its_start) {
    EmulatedBox box{image("lonely") / "disk.img"};
    box.switch_on();
    box.await(has_started);
    box.switch_off();
    for (int cut = 0; cut < 2; ++cut) {
        box.switch_on();
        box.await(cut == 0 ? "Starting C:SLOTA" : "Tappet, carpet-loom");
        box.switch_off();
        ASSERT_EQ(slot(box, 1).state, SlotState::testing);
        box.switch_on();
        const std::string said = box.await(has_started);
        SCOPED_TRACE(said);
        box.switch_off();
        const std::size_t there = said.find("Starting C:SLOTB"), back = said.find("Starting C:SLOTA");
        EXPECT_LT(there, back);
        EXPECT_THAT(said.substr(there, back - there),
                    AllOf(HasSubstr("did not finish"), HasSubstr("the box goes back to it"),
                          Not(HasSubstr("armed on board"))));
        EXPECT_THAT(said.substr(back), HasSubstr("armed on board"));
        EXPECT_EQ(slot(box, 1).state, SlotState::installed);
    }
}

} // namespace
} // namespace tappet::bench
