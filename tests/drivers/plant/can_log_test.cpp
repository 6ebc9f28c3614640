// Candump logs of simulated buses: recording, replay and its times, comparison, and the refusal of files.
#include "drivers/plant/can_log.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <vector>

#include <unistd.h>

namespace tappet {
namespace {

using can::Frame;

constexpr std::array machine_sends{can::Identifier{0x201}, can::Identifier{0x202}};
constexpr std::array machine_receives{can::Identifier{0x181}, can::Identifier{0x182}};

struct CanLog : testing::Test {
    CanLog() {
        std::filesystem::create_directories(folder);
        EXPECT_TRUE(machine.open({.interface = "machine",
                                  .receive = machine_receives,
                                  .transmit = machine_sends,
                                  .takes_fd = true}));
        EXPECT_TRUE(plant.open({.interface = "plant",
                                .receive = machine_sends,
                                .transmit = machine_receives,
                                .takes_fd = true}));
        EXPECT_TRUE(bus.attach(machine) && bus.attach(plant));
        bus.set_tap(&tap);
    }
    ~CanLog() override { std::filesystem::remove_all(folder); }

    std::string file(std::string_view text) {
        const std::string path = (folder / "a.log").string();
        std::ofstream{path, std::ios::binary} << text;
        return path;
    }
    Sentence open(std::string_view text, Duration begins_at = {}) {
        return replay.open("can", file(text), begins_at, machine_receives, machine_sends);
    }
    void send(can::Twin& end, std::uint32_t id, std::uint8_t value, Time now) {
        Frame frame{.id = id, .length = 1, .stamp = now};
        frame.data[0] = value;
        EXPECT_EQ(end.send(frame, can::Keep::every), can::Send::queued);
        end.service(now);
    }
    /// As the twins of a machine move: first the frames of the ends, then those of the log.
    void move(Time now) {
        bus.deliver_until(now);
        drain();
        replay.play(bus, now);
        bus.deliver_until(now);
        drain();
    }
    void drain() {
        for (Frame frame; tap.pop(frame);) replay.heard(frame);
    }
    std::vector<Frame> arrived(can::Twin& end) {
        std::vector<Frame> all;
        for (Frame frame; end.receive(frame).what == can::Received::frame;) all.push_back(frame);
        return all;
    }
    std::string refusal(std::string_view text) {
        CanReplay fresh;
        const Sentence fault = fresh.open("can", file(text), {}, machine_receives, machine_sends);
        std::string said{fault.view()};
        if (const std::size_t at = said.find("a.log"); at != said.npos) said.erase(0, at);
        return said;
    }

    std::filesystem::path folder =
        std::filesystem::path{testing::TempDir()} / ("can_log." + std::to_string(getpid()));
    can::TwinBus bus{1};
    can::Twin machine, plant;
    can::TwinBus::Tap tap;
    CanReplay replay;
};

TEST_F(CanLog, records_frames_of_both_ends_in_the_order_of_the_wire) {
    CanRecorder recorder;
    ASSERT_TRUE(recorder.open("axis can", (folder / "new").string()).empty());
    recorder.begin(Time{1s});
    recorder.begin(Time{2s}); // it has begun
    send(machine, 0x201, 0xAA, Time{1001ms});
    send(plant, 0x181, 0xBB, Time{1001ms});
    bus.deliver_until(Time{1001ms});
    EXPECT_TRUE(arrived(plant).size() == 1 && arrived(machine).size() == 1);
    bus.faults.lose.next = 1; // acknowledged by another node: it was on the wire
    send(plant, 0x182, 0xCC, Time{2500ms});
    bus.deliver_until(Time{2500ms});
    for (Frame frame; tap.pop(frame);) recorder.record(frame);
    bool good = false;
    const Sentence said = recorder.close(good);
    EXPECT_TRUE(good);
    EXPECT_NE(said.view().find("3 frames recorded"), std::string_view::npos) << said.view();
    EXPECT_TRUE(said.view().ends_with("--replay-can axis can=" + (folder / "new/axis_can.log").string() +
                                      "@0.001000"))
        << said.view();
    std::ifstream log{folder / "new/axis_can.log"};
    EXPECT_EQ((std::string{std::istreambuf_iterator<char>{log}, {}}),
              "(0000000000.001000) axis_can 181#BB\n"
              "(0000000000.001000) axis_can 201#AA\n"
              "(0000000001.500000) axis_can 182#CC\n");
}

TEST_F(CanLog, does_not_overwrite_an_earlier_recording) {
    const std::string log = file("(0.000000) can 181#01\n");
    CanRecorder recorder;
    const Sentence said = recorder.open(std::filesystem::path{log}.stem().string(), folder.string());
    EXPECT_TRUE(said.view().ends_with("exists already; name another folder, or remove it")) << said.view();
    EXPECT_EQ(std::filesystem::file_size(log), 22u);
}

TEST_F(CanLog, reports_files_that_it_cannot_write) {
    CanRecorder recorder;
    const Sentence said = recorder.open("can", file("") + "/below_a_file");
    EXPECT_TRUE(said.view().ends_with("name a folder in which you may write")) << said.view();
    if (!std::filesystem::exists("/dev/full")) GTEST_SKIP();
    std::filesystem::create_symlink("/dev/full", folder / "full.log");
    ASSERT_TRUE(recorder.open("full", folder.string()).empty());
    recorder.record({});
    bool good = true;
    EXPECT_TRUE(recorder.close(good).view().ends_with("is the disk full?"));
    EXPECT_FALSE(good);
}

TEST_F(CanLog, replays_each_frame_at_its_time_since_the_first_of_the_log) {
    ASSERT_TRUE(open("(1700000000.000000) can0 181#01\n"
                     "\n"
                     "(1700000000.250000) can0 182##1AABBCCDD\r\n"
                     "(1700000000.250000) can0 181#02\n",
                     2ms)
                    .empty());
    bus.mute(plant);
    move(Time{100ms}); // the run begins here
    EXPECT_EQ(replay.next(), Time{102ms});
    EXPECT_TRUE(arrived(machine).empty());
    send(plant, 0x181, 0xFF, Time{101ms});
    move(Time{101ms});
    EXPECT_TRUE(arrived(machine).empty()) << "in place of the plant's";
    move(Time{102ms});
    const auto first = arrived(machine);
    ASSERT_EQ(first.size(), 1u);
    EXPECT_EQ(first[0].data[0], 1);
    EXPECT_EQ(first[0].stamp, Time{102ms});
    EXPECT_EQ(replay.next(), Time{352ms});
    EXPECT_FALSE(replay.is_over());
    move(Time{352ms});
    const auto last = arrived(machine);
    ASSERT_EQ(last.size(), 2u) << "in the order of the log";
    EXPECT_TRUE(last[0].fd && last[0].bit_rate_switch);
    EXPECT_EQ(last[0].length, 4);
    EXPECT_EQ(last[1].data[0], 2);
    EXPECT_TRUE(replay.is_over());
    EXPECT_EQ(replay.next(), never);
    EXPECT_EQ(plant.counters().sent, 0u) << "it has not looked yet";
    EXPECT_TRUE(arrived(plant).empty());
    EXPECT_EQ(plant.counters().sent, 1u) << "it believes that somebody heard it";
}

TEST_F(CanLog, passes_frames_to_the_plant_while_the_plant_is_muted) {
    ASSERT_TRUE(open("(1.0) can0 181#01\n").empty());
    bus.mute(plant);
    send(machine, 0x201, 7, Time{1ms});
    move(Time{1ms});
    EXPECT_EQ(arrived(plant).size(), 1u);
}

TEST_F(CanLog, skips_and_counts_frames_that_the_machine_does_not_receive) {
    ASSERT_TRUE(open("(1.0) can0 181#01\n(1.0) can0 7FF#01\n(1.0) can0 00000181#01\n(1.0) can0 181#R\n"
                     "(1.0) can0 20000040#0000000000000000\n(1.0) can0 201#05\n")
                    .empty());
    move(Time{});
    EXPECT_EQ(arrived(machine).size(), 1u);
    EXPECT_EQ(machine.counters().impostors, 0u) << "what it sends itself is not replayed";
    const auto counts = replay.counts();
    EXPECT_EQ(counts.played, 1u);
    EXPECT_EQ(counts.unknown, 2u);
    EXPECT_EQ(counts.remote, 1u);
    EXPECT_EQ(counts.errors, 1u);
    EXPECT_EQ(counts.only_in_log, 1u);
    EXPECT_TRUE(replay.report().view().ends_with(
        "left out 2 of other identifiers, 1 remote and 1 error frames; of the frames that the machine sent, "
        "0 "
        "are as in the log, 0 are not, 1 are only in the log and 0 are not in it"))
        << replay.report().view();
}

TEST_F(CanLog, compares_the_sent_frames_for_each_identifier) {
    ASSERT_TRUE(open("(1.000) can0 181#01\n"
                     "(1.001) can0 201#01\n"
                     "(1.002) can0 201#02\n"
                     "(1.003) can0 181#01\n")
                    .empty());
    move(Time{});
    send(machine, 0x202, 9, Time{1ms}); // the log has no such frame: nothing to compare
    send(machine, 0x201, 1, Time{1ms});
    move(Time{1ms});
    move(Time{2ms});
    send(machine, 0x201, 3, Time{2500us});
    move(Time{2500us});
    send(machine, 0x201, 4, Time{3ms});
    move(Time{3ms});
    const auto counts = replay.counts();
    EXPECT_EQ(counts.equal, 1u);
    EXPECT_EQ(counts.different, 1u);
    EXPECT_EQ(counts.first_different, Time{2500us});
    EXPECT_EQ(counts.only_in_log, 0u);
    EXPECT_EQ(counts.only_sent, 1u);
    EXPECT_NE(replay.report().view().find("(the first 0.002500 s after the beginning)"),
              std::string_view::npos)
        << replay.report().view();
}

// Under virtual time, question and answer have the same time.
TEST_F(CanLog, replays_an_answer_of_the_same_time_only_after_its_request) {
    ASSERT_TRUE(open("(1.0) can0 181#01\n(1.001) can0 201#01\n(1.001) can0 181#02\n").empty());
    move(Time{});
    EXPECT_EQ(arrived(machine).size(), 1u);
    move(Time{1ms});
    EXPECT_TRUE(arrived(machine).empty()) << "the machine has not had its turn";
    EXPECT_EQ(replay.next(), Time{1ms + 1us});
    send(machine, 0x201, 1, Time{1ms});
    move(Time{1ms});
    EXPECT_EQ(arrived(machine).size(), 1u);
    EXPECT_TRUE(replay.is_over());
}

TEST_F(CanLog, waits_at_most_a_microsecond_for_a_missing_request) {
    ASSERT_TRUE(open("(1.0) can0 181#01\n(1.001) can0 201#01\n(1.001) can0 181#02\n").empty());
    for (const Duration at : {0us, 1000us, 1001us}) move(Time{at});
    EXPECT_EQ(arrived(machine).size(), 2u);
    EXPECT_TRUE(replay.is_over());
}

TEST_F(CanLog, skips_and_reports_a_truncated_last_line) {
    ASSERT_TRUE(open("(1.0) can0 181#01\n(1.001) can0 181#0203\n(1.002) can0 181#0").empty());
    for (const Duration at : {0us, 1000us, 2000us}) move(Time{at});
    EXPECT_EQ(arrived(machine).size(), 2u);
    EXPECT_TRUE(replay.is_over());
    EXPECT_NE(replay.report().view().find("its last line is cut off, and left out"), std::string_view::npos);
}

TEST_F(CanLog, ends_at_a_last_line_that_is_cut_anywhere) {
    const std::string whole = "(1.0) can0 181#01\n";
    const std::string last = "(1700000000.123456) can0 18FF0102##3001122334455667788 R";
    for (std::size_t length = 1; length < last.size() - 2; ++length)
        for (const std::string end : {"", "\n", "\r\n\n"}) {
            const std::string said = refusal(whole + last.substr(0, length) + end);
            EXPECT_EQ(said, "") << last.substr(0, length);
        }
    EXPECT_EQ(refusal(whole + "(1.1) can0 181#0" + std::string(100, '\0')), "");
    EXPECT_EQ(refusal(whole + "(1.1) can0 181#1\n(1.2) can0 181#01\n"),
              "a.log:2:17: a byte is two hexadecimal digits; the line is cut off")
        << "not the last one";
    EXPECT_EQ(refusal(whole + "(1.1) can0 181#1X\n"),
              "a.log:2:17: a byte is two hexadecimal digits; the line is cut off")
        << "wrong, not cut";
    ASSERT_TRUE(open(whole + "(1.1) can0 181#1\n").empty());
    for (const Duration at : {0ms, 100ms}) move(Time{at});
    EXPECT_EQ(arrived(machine).size(), 1u);
    EXPECT_NE(replay.report().view().find("its last line is cut off, and left out"), std::string_view::npos);
    CanReplay zeros;
    ASSERT_TRUE(
        zeros.open("can", file(whole + std::string(64, '\0')), {}, machine_receives, machine_sends).empty());
    EXPECT_TRUE(zeros.counts().is_cut);
}

// Cut between two bytes, it is a right line of a shorter frame.
TEST_F(CanLog, leaves_out_a_last_line_without_its_end) {
    for (const std::string cut : {"0203", "02", "", "020304 R"}) {
        CanReplay of_cut;
        const std::string path = file("(1.0) can0 181#01\n(1.1) can0 181#" + cut);
        ASSERT_TRUE(of_cut.open("can", path, {}, machine_receives, machine_sends).empty()) << cut;
        EXPECT_EQ(of_cut.counts().played, 1u) << cut;
        EXPECT_TRUE(of_cut.counts().is_cut) << cut;
    }
    ASSERT_TRUE(open("(1.0) can0 181#01\n(1.1) can0 181#02").empty());
    for (const Duration at : {0ms, 100ms}) move(Time{at});
    EXPECT_EQ(arrived(machine).size(), 1u);
    EXPECT_TRUE(replay.is_over());
    EXPECT_NE(replay.report().view().find("; its last line is cut off, and left out"),
              std::string_view::npos);
    CanReplay whole;
    ASSERT_TRUE(
        whole.open("can", file("(1.0) can0 181#01\r\n"), {}, machine_receives, machine_sends).empty());
    EXPECT_FALSE(whole.counts().is_cut);
}

TEST_F(CanLog, begins_a_new_stretch_where_its_clock_was_set_back) {
    ASSERT_TRUE(open("(1000.0) can0 181#01\n(1001.0) can0 181#02\n(501.0) can0 181#03\n"
                     "(501.5) can0 181#04\n(500.25) can0 181#05\n")
                    .empty());
    std::vector<std::size_t> frames;
    for (const Duration at : {0ms, 999ms, 1000ms, 1499ms, 1500ms}) {
        move(Time{at});
        frames.push_back(arrived(machine).size());
    }
    EXPECT_EQ(frames, (std::vector<std::size_t>{1, 0, 2, 0, 2}));
    EXPECT_TRUE(replay.is_over());
    EXPECT_EQ(replay.counts().set_back, 2u);
    EXPECT_NE(replay.report().view().find(
                  "; its clock was set back 2 times (first in line 3, by 500.000000 s), each a new stretch "
                  "(in disorder? LC_ALL=C sort -s -k1.2n); left out"),
              std::string_view::npos)
        << replay.report().view();
}

// The order of GNU sort, where digits differ: sort -s alone puts 9.5 behind 10.1.
TEST_F(CanLog, is_in_order_after_its_cure) {
    const std::string path = file("(10.10) can0 181#01\n(10.05) can0 181#02\n(9.99) can0 181#03\n"
                                  "(10.05) can0 181#04\n");
    CanReplay fresh;
    const std::string said{fresh.open("can", path, {}, machine_receives, machine_sends).view()};
    const std::size_t cure = said.find("LC_ALL=C sort");
    ASSERT_NE(cure, said.npos) << said;
    const std::string sorted = (folder / "sorted.log").string();
    ASSERT_EQ(std::system((said.substr(cure) + " " + path + " > " + sorted).c_str()), 0);
    std::ifstream log{sorted};
    EXPECT_EQ((std::string{std::istreambuf_iterator<char>{log}, {}}),
              "(9.99) can0 181#03\n(10.05) can0 181#02\n(10.05) can0 181#04\n(10.10) can0 181#01\n");
}

TEST_F(CanLog, refuses_a_file_with_line_column_and_cure) {
    EXPECT_EQ(refusal(""), "a.log: there is no frame in it; name a log of candump -L or -l");
    EXPECT_EQ(refusal("(1.0) can0 181#01\n(0.901) can0 181#01\n"),
              "a.log:2:2: this time is before that of the line above; put them in order: LC_ALL=C sort -s "
              "-k1.2n");
    EXPECT_EQ(refusal("(9000000000) can0 181#01\n(0) can0 181#01\n(9000000000) can0 181#01\n(0) can0 181#01\n"
                      "(1) can0 181#01\n"),
              "a.log:5:2: the log lasts more than 9000000000 seconds; divide it");
    EXPECT_EQ(
        refusal("(1.0) can0 181#01\n(1.0) can1 181#01\n"),
        "a.log:2:7: here is a frame of another interface; a bus is replayed from a log of its own: grep ' "
        "can0 '");
    EXPECT_EQ(refusal("(1.0) can0 7FF#01\n"), "a.log: none of its frames has an identifier that the machine "
                                              "receives on \"can\"; is it the log of that bus?");
    CanReplay fresh;
    EXPECT_TRUE(fresh.open("can", (folder / "none.log").string(), {}, machine_receives, machine_sends)
                    .view()
                    .ends_with("cannot be read; name a log of candump -L or -l"));
}

TEST_F(CanLog, reports_a_file_that_changes_during_the_replay) {
    std::string text;
    for (int i = 0; i < 10'000; ++i) text += "(" + std::to_string(1000 + i) + ".0) can0 181#01\n";
    ASSERT_TRUE(open(text).empty());
    move(Time{});
    text.replace(text.size() - 100, 1, "?");
    file(text);
    move(Time{20'000s});
    EXPECT_TRUE(replay.is_over());
    EXPECT_FALSE(replay.fault().empty());
}

} // namespace
} // namespace tappet
