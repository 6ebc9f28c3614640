// A second program records the cutter in real time, from the first cycle to the end: the thesis' report (3.3)
// as users see it.
#include "tests/toolchain/folder.hpp"
#include "tests/toolchain/program.hpp"

#include <nlohmann/json.hpp>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <map>
#include <sstream>
#include <vector>

namespace cut_to_length {
namespace {

using tappet::Ended;
using tappet::run_line;
using tappet::test::Folder;
using testing::HasSubstr;

/// Runs the machine and a shell script beside it; `browse` is tappet-browse.
Ended beside_the_cutter(const Folder& folder, const std::string& what) {
    return run_line("cd " + folder.string() +
                    " && browse() { " TAPPET_BROWSE " --directory browsers \"$@\"; }"
                    "; " TAPPET_CUTTER
                    " --real --quiet --for 60 --browse browsers > machine 2>&1 & machine=$!"
                    "; for i in $(seq 300); do browse report > list 2> /dev/null && break; sleep 0.1; done"
                    "; " +
                    what + "; kill -TERM $machine; wait $machine; true");
}

TEST(RecordedCutter, records_each_step_in_a_file) {
    const Folder folder;
    const Ended ended =
        beside_the_cutter(folder, "cat list; browse report start a.mcap --for 2s"
                                  "; browse report convert a.mcap a.csv; echo converted: $?"
                                  "; cp a.mcap b.csv; browse report convert b.csv b.csv; echo kept: $?"
                                  "; cmp a.mcap b.csv && echo as it was"
                                  "; browse info > /dev/full; echo full: $?");
    EXPECT_THAT(ended.text,
                HasSubstr("'b.csv' exists already; name another file, or remove it\nkept: 2\nas it was"));
    EXPECT_THAT(ended.text, HasSubstr("its output could not be written; is the disk full?\nfull: 2"));
    EXPECT_THAT(ended.text, HasSubstr("line.target  every step  m/s"));
    EXPECT_THAT(ended.text, HasSubstr("wheel.fired  on change"));
    EXPECT_THAT(ended.text, HasSubstr("written to a.mcap: "));
    ASSERT_THAT(ended.text, HasSubstr("converted: 0"));
    const Ended read = run_line("/usr/bin/python3 " TAPPET_MCAP_READER " " + (folder / "a.mcap").string());
    ASSERT_EQ(read.exit_code, 0) << read.text;
    std::map<std::string, std::vector<nlohmann::json>> topics;
    std::istringstream lines{read.text};
    std::size_t messages = 0;
    for (std::string line; std::getline(lines, line); ++messages) {
        const auto message = nlohmann::json::parse(line);
        topics[message["topic"]].push_back(message);
    }
    ASSERT_FALSE(topics["line.target"].empty()) << "it has a step each 5 ms";
    ASSERT_EQ(topics["line.speed"].size(), 1u) << "a property that stands";
    EXPECT_EQ(topics["line.speed"][0]["message"]["value"], 2.0);
    for (const auto& each : topics["line.target"]) {
        EXPECT_GE(each["message"]["value"], 0.0);
        EXPECT_LE(each["message"]["value"], 2.0);
    }
    for (const auto& [topic, samples] : topics) {
        if (topic == "lost") continue;
        std::uint64_t missing = 0, told = 0;
        for (std::size_t i = 1; i < samples.size(); ++i) {
            EXPECT_GE(samples[i]["time"], samples[i - 1]["time"]);
            missing += samples[i]["sequence"].get<std::uint64_t>() -
                       samples[i - 1]["sequence"].get<std::uint64_t>() - 1;
        }
        for (const auto& lost : topics["lost"])
            if (lost["message"]["channel"] == topic) told += lost["message"]["samples"].get<std::uint64_t>();
        EXPECT_GE(told, missing) << topic;
    }
    std::ifstream table{folder / "a.csv"};
    std::string head;
    std::getline(table, head);
    EXPECT_EQ(head.substr(0, 12), "time_s,lost,");
    EXPECT_THAT(head, HasSubstr(",line.target,"));
    std::size_t rows = 0;
    for (std::string line; std::getline(table, line);) ++rows;
    EXPECT_GT(rows, 0u);
    EXPECT_LE(rows, messages);
}

TEST(RecordedCutter, is_recorded_until_the_recording_or_the_machine_ends) {
    const Folder folder;
    const Ended ended = beside_the_cutter(
        folder, "browse report start a.mcap > a & recorder=$!"
                "; for i in $(seq 300); do browse report stop a.mcap 2> /dev/null && break; sleep 0.1; done"
                "; wait $recorder; echo stopped: $?; cat a"
                "; browse report start b.mcap > b & recorder=$!"
                "; for i in $(seq 300); do test -s b && break; sleep 0.1; done"
                "; kill -TERM $machine; wait $recorder; echo ended: $?; cat b"
                "; browse report stop a.mcap; echo nobody: $?"
                "; browse report convert a.mcap a.txt; browse report convert machine a.csv"
                "; browse report stop");
    EXPECT_THAT(ended.text, HasSubstr("stopped: 0"));
    EXPECT_THAT(ended.text, HasSubstr("written to a.mcap: "));
    EXPECT_THAT(ended.text, HasSubstr("ended: 0"));
    EXPECT_THAT(ended.text, HasSubstr("samples; the machine has ended"));
    EXPECT_THAT(ended.text, HasSubstr("nobody records into 'a.mcap'"));
    EXPECT_THAT(ended.text, HasSubstr("nobody: 2"));
    EXPECT_THAT(ended.text, HasSubstr("'report convert' makes a file that ends with .csv, not 'a.txt'"));
    EXPECT_THAT(ended.text, HasSubstr("'machine' is not an MCAP file"));
    EXPECT_THAT(ended.text, HasSubstr("'report stop' takes the file of 'report start'"));
    for (const char* name : {"a.mcap", "b.mcap"}) {
        const Ended read = run_line("/usr/bin/python3 " TAPPET_MCAP_READER " " + (folder / name).string());
        EXPECT_EQ(read.exit_code, 0) << name << ": " << read.text;
    }
}

TEST(RecordedCutter, leaves_a_readable_file_when_the_recorder_is_killed) {
    const Folder folder;
    const Ended ended = beside_the_cutter(
        folder,
        "browse report start a.mcap > a & recorder=$!"
        "; for i in $(seq 300); do test $(stat -c %s a.mcap || echo 0) -gt 20000 && break; sleep 0.1; done"
        "; kill -KILL $recorder; wait $recorder; browse report convert a.mcap a.csv; echo converted: $?");
    EXPECT_THAT(ended.text, HasSubstr("the recording was cut off, and is good up to that point"));
    EXPECT_THAT(ended.text, HasSubstr("converted: 0"));
    const Ended read =
        run_line("/usr/bin/python3 " TAPPET_MCAP_READER " " + (folder / "a.mcap").string() + " --cut");
    EXPECT_EQ(read.exit_code, 0) << read.text;
    EXPECT_THAT(read.text, HasSubstr("line.target"));
}

} // namespace
} // namespace cut_to_length
