// Power fails at any instant while a box writes to its disk. The writer's marks say what may then be found.
#include "tests/bench/image/emulated_box.hpp"
#include "tests/bench/image/instants.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <iostream>
#include <sstream>

namespace tappet::bench {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;
namespace fs = std::filesystem;

/// Keyed by the writer's phases: "sound", or the file whose fsync it omitted.
std::map<std::string, std::vector<Stretch>> stretches_of(const WriteLog& log) {
    std::map<std::string, std::vector<Stretch>> all;
    std::vector<Stretch>* phase = nullptr;
    const auto& entries = log.entries();
    for (std::size_t i = 0; i < entries.size(); ++i) {
        if (entries[i].is_flush || entries[i].at_byte != marks_at_byte) continue;
        if (phase != nullptr) phase->back().end = i;
        std::istringstream words{std::string{entries[i].bytes}};
        std::string name;
        Stretch next{.begin = i + 1, .end = entries.size()};
        words >> name >> next.allowed.least_settings >> next.allowed.most_settings >>
            next.allowed.least_version >> next.allowed.most_version;
        phase = &all[name];
        phase->push_back(next);
    }
    return all;
}

fs::path image(const char* name) { return fs::path{IMAGES} / name; }

/// Without the loader, which would take most of the time.
void switch_on(EmulatedBox& box, const char* name) {
    box.switch_on_with(bench::cache_folder() / "kernel/box/vmlinuz", image(name) / "root.cpio.zst");
}

/// The writer runs once for all tests.
struct Cuts : testing::Test {
    static constexpr std::uint64_t seed = 7;
    static std::unique_ptr<EmulatedBox> box;
    static std::unique_ptr<WriteLog> log;
    static std::map<std::string, std::vector<Stretch>> phases;
    static std::string said;

    static void SetUpTestSuite() {
        box = std::make_unique<EmulatedBox>(image("production") / "disk.img");
        const fs::path path = box->record();
        switch_on(*box, "writer");
        said = box->await_end();
        log = std::make_unique<WriteLog>(path);
        phases = stretches_of(*log);
    }
    static void TearDownTestSuite() {
        log.reset();
        box.reset();
    }

    EmulatedBox cut_box{image("production") / "disk.img"}; // as the writer found it
    CutDisk disk{cut_box.disk(), *log};
    Judge judge{cut_box.disk()};
    std::mt19937_64 lot{seed};

    void SetUp() override {
        ASSERT_THAT(said, HasSubstr("the writer ends"));
        ASSERT_THAT(said, Not(HasSubstr("gives up")));
        ASSERT_EQ(marks_at_byte, image::disk_bytes() - 1024 * 1024) << "behind the last partition";
        judge.knows(1, image::read_file(image("production") / "tappet.efi"));
    }
};

std::unique_ptr<EmulatedBox> Cuts::box;
std::unique_ptr<WriteLog> Cuts::log;
std::map<std::string, std::vector<Stretch>> Cuts::phases;
std::string Cuts::said;

TEST_F(Cuts, harm_nothing_at_any_instant) {
    for (const auto& [entry, allowed] : draw(*log, phases["sound"], 200, lot)) {
        disk.cut(entry, lot);
        EXPECT_EQ(judge.harm_to_slots(allowed), "") << "at entry " << entry;
        EXPECT_EQ(judge.harm_to_settings(allowed), "") << "at entry " << entry;
    }
}

/// ext4 itself writes the contents of a file before it renames it, so that file needs no test.
TEST_F(Cuts, do_harm_when_one_fsync_is_missing) {
    for (const char* file : {"/run/slot/tappet.efi", "/run/slot/BGENV.DAT", "/data"}) {
        const bool is_slot = std::string_view{file}.starts_with("/run/slot");
        std::string harm;
        int cuts = 0;
        for (const auto& [entry, allowed] : draw(*log, phases[file], 200, lot)) {
            disk.cut(entry, lot);
            ++cuts;
            harm = is_slot ? judge.harm_to_slots(allowed) : judge.harm_to_settings(allowed);
            if (!harm.empty()) break;
        }
        EXPECT_NE(harm, "") << file;
        std::cout << "without the fsync of " << file << ", cut " << cuts << ": " << harm.substr(0, 100)
                  << std::endl;
    }
}

/// The real loader boots a disk on which a cut left the tables of a slot torn, and the writer continues on
/// it.
TEST_F(Cuts, do_not_prevent_the_next_update) {
    std::vector<Stretch> installing;
    bool is_trial = false;
    for (const Stretch& each : phases["sound"])
        if (each.allowed.least_version != each.allowed.most_version) {
            if (!is_trial) installing.push_back(each);
            is_trial = !is_trial;
        }
    int lives = 0;
    for (const auto& [entry, allowed] : draw(*log, installing, 300, lot)) {
        disk.cut(entry, lot);
        if (!judge.has_torn_tables()) continue;
        const std::string label = image::partitions()[judge.slot_that_boots().value()].label;
        EmulatedBox now{cut_box.disk()};
        now.switch_on();
        EXPECT_THAT(now.await(":tappet.efi with watchdog"), HasSubstr("Starting C:" + label));
        now.switch_off();
        EmulatedBox next{cut_box.disk()};
        switch_on(next, "writer");
        EXPECT_THAT(next.await_end(), AllOf(HasSubstr("the writer ends"), Not(HasSubstr("gives up"))));
        EXPECT_FALSE(Judge{next.disk()}.has_torn_tables()) << "at entry " << entry;
        if (++lives == 1) break;
    }
    EXPECT_EQ(lives, 1);
}

TEST_F(Cuts, a_full_disk_keeps_the_old_settings) {
    EXPECT_THAT(said, HasSubstr("on a full disk: /data/settings.cpf: component \"settings\": its properties "
                                "cannot be saved and the old file remains"));
}

} // namespace
} // namespace tappet::bench
