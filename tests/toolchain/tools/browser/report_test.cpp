// Recorded values on their way out of a machine (thesis 3.3): a browser reads the tapes and writes the file;
// both survive overwriting, truncation and damage.
#include "tests/kernel/services/reporting/recorded_machine.hpp"
#include "tests/toolchain/folder.hpp"
#include "tests/toolchain/program.hpp"
#include "toolchain/tools/browser/csv.hpp"
#include "toolchain/tools/browser/record_file.hpp"
#include "toolchain/tools/browser/recording.hpp"

#include <nlohmann/json.hpp>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <bit>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <random>
#include <sstream>

namespace tappet::browser {
namespace {

using recorded_test::machine_with;
using recorded_test::Rig;
using testing::HasSubstr;
using testing::StartsWith;

constexpr auto shop = machine_with(reporting(
    report("axis.position", every(2)), report("axis.force", on_change(0.5)), report("axis.mode", on_change()),
    report("axis.pose", every(10)), report("axis.label", on_change()), report("axis.filter", on_change()),
    report("axis.pull", every(50)), report("press.strokes")));
constexpr std::int64_t zero_ns = 1'700'000'000'000'000'000;

/// The machine and its recorder.
struct Recorded : testing::Test {
    Rig<shop> rig;
    std::optional<MapReader> map;
    std::optional<RecordReader> reader;
    std::optional<Recording> recording;
    std::string file{};

    void SetUp() override {
        auto opened = MapReader::open(rig.instance.observation().shared_memory());
        ASSERT_TRUE(opened.has_value()) << opened.error();
        map.emplace(std::move(*opened));
        auto read = RecordReader::open(*map);
        ASSERT_TRUE(read.has_value()) << read.error();
        reader.emplace(std::move(*read));
        recording.emplace(*map, reader->channels(), zero_ns);
        ASSERT_TRUE(rig.start());
    }
    void record(Duration time, Duration between_looks = 20ms) {
        for (Duration done{}; done < time; done += between_looks) {
            ASSERT_TRUE(rig.run(between_looks));
            recording->add(reader->follow());
            file += recording->take();
        }
    }
    const std::string& end() {
        recording->end();
        return file += recording->take();
    }
};

struct Read {
    std::uint32_t sequence = 0;
    std::uint64_t time = 0;
    nlohmann::json value{};
};

/// Messages by their topics.
std::map<std::string, std::vector<Read>> by_topic(const mcap::Contents& contents) {
    std::map<std::uint16_t, std::string> topics;
    std::map<std::string, std::vector<Read>> found;
    for (const mcap::Channel& each : contents.channels) topics[each.id] = each.topic;
    for (const mcap::Message& each : contents.messages) {
        const auto json = nlohmann::json::parse(each.data);
        found[topics.at(each.channel)].push_back(
            {each.sequence, each.log_ns, json.contains("value") ? json["value"] : json});
    }
    return found;
}

TEST_F(Recorded, the_file_says_what_the_machine_computed) {
    rig.axis->pulls = std::nan("");
    record(1s);
    const auto contents = mcap::read(end());
    ASSERT_TRUE(contents.has_value()) << contents.error();
    EXPECT_TRUE(contents->has_end);
    const auto read = by_topic(*contents);
    const auto& position = read.at("axis.position");
    ASSERT_EQ(position.size(), static_cast<std::size_t>((rig.axis->steps + 1) / 2));
    for (std::size_t i = 0; i < position.size(); ++i) {
        EXPECT_EQ(position[i].value, 0.25 * static_cast<double>(2 * i + 1));
        EXPECT_EQ(position[i].sequence, i);
        EXPECT_EQ(position[i].time - position[0].time, 2'000'000 * i);
    }
    EXPECT_EQ(position[0].time, static_cast<std::uint64_t>(zero_ns) + 1'000'000) << "the first period's end";
    const auto& pose = read.at("axis.pose");
    ASSERT_GT(pose.size(), 90u);
    for (std::size_t i = 0; i < pose.size(); ++i) {
        const auto step = static_cast<std::int64_t>(10 * i + 1);
        EXPECT_EQ(pose[i].value, (nlohmann::json{{"x", 1.5 * static_cast<double>(step)}, {"turns", -step}}));
    }
    EXPECT_EQ(read.at("axis.mode")[1].value, "moving");
    EXPECT_EQ(read.at("axis.label").at(0).value, "axis");
    EXPECT_EQ(read.at("axis.filter").at(0).value, 0.004) << "in seconds";
    EXPECT_TRUE(read.at("axis.pull").at(1).value.is_null()) << "it is no number";
    for (std::size_t i = 0; i < read.at("press.strokes").size(); ++i)
        EXPECT_EQ(read.at("press.strokes")[i].value, i + 1);
    EXPECT_EQ(recording->lost(), 0u);
    EXPECT_FALSE(read.contains("lost"));
}

TEST_F(Recorded, overwritten_values_are_counted_in_the_file) {
    record(40ms);
    ASSERT_TRUE(rig.run(10s));
    record(40ms);
    const auto contents = mcap::read(end());
    ASSERT_TRUE(contents.has_value()) << contents.error();
    auto read = by_topic(*contents);
    std::uint64_t told = 0;
    for (const Read& each : read.at("lost")) told += each.value.at("samples").get<std::uint64_t>();
    EXPECT_GT(told, 0u);
    EXPECT_EQ(recording->lost(), told);
    for (auto& [topic, messages] : read) {
        if (topic == "lost") continue;
        std::uint64_t missing = 0;
        for (std::size_t i = 1; i < messages.size(); ++i)
            missing += messages[i].sequence - messages[i - 1].sequence - 1;
        std::uint64_t told_of_it = 0;
        for (const Read& each : read.at("lost"))
            if (each.value.at("channel") == topic)
                told_of_it += each.value.at("samples").get<std::uint64_t>();
        EXPECT_EQ(told_of_it, missing) << topic;
    }
}

TEST(Overwritten, a_rarely_changing_value_is_written_again_once_the_loss_is_seen) {
    static constexpr auto table =
        machine_with(reporting(report("axis.position"), report("axis.pull", on_change())));
    Rig<table> rig;
    const auto map = MapReader::open(rig.instance.observation().shared_memory());
    ASSERT_TRUE(map.has_value());
    auto reader = RecordReader::open(*map);
    ASSERT_TRUE(reader.has_value()) << reader.error();
    ASSERT_TRUE(rig.start() && rig.run(10ms));
    static_cast<void>(reader->follow());
    for (const double pull : {2.0, 3.0, 4.0}) { // and never again
        rig.axis->pulls = pull;
        ASSERT_TRUE(rig.run(5ms));
    }
    ASSERT_TRUE(rig.run(10s));
    std::vector<RecordedSample> pulls;
    for (RecordedSample& each : reader->follow())
        if (each.channel == 1) pulls.push_back(std::move(each));
    ASSERT_EQ(pulls.size(), 1u);
    EXPECT_EQ(std::bit_cast<double>(pulls[0].words[0]), 4.0);
    EXPECT_EQ(pulls[0].sequence, 3u);
    EXPECT_EQ(pulls[0].lost, 2u);
    ASSERT_TRUE(rig.run(10s));
    for (const RecordedSample& each : reader->follow()) EXPECT_NE(each.channel, 1u) << "it was told";
}

TEST_F(Recorded, a_file_that_begins_late_starts_with_the_current_values) {
    ASSERT_TRUE(rig.run(700ms));
    auto late = RecordReader::open(*map);
    ASSERT_TRUE(late.has_value());
    ASSERT_TRUE(rig.run(1ms));
    std::map<std::string, RecordedSample> standing;
    for (RecordedSample& each : late->begin()) standing[late->channels()[each.channel].name] = each;
    ASSERT_EQ(standing.size(), 4u) << "what is recorded each so many steps comes soon";
    EXPECT_EQ(standing.at("axis.mode").words[0], static_cast<std::uint64_t>(rig.axis->mode.last()));
    EXPECT_EQ(standing.at("axis.label").sequence, 0u);
    EXPECT_EQ(standing.at("axis.label").lost, 0u);
    for (const RecordedSample& each : late->follow())
        EXPECT_FALSE(standing.contains(late->channels()[each.channel].name)) << "it was told already";
    ASSERT_TRUE(rig.run(10s));
    std::map<std::uint32_t, std::uint64_t> lost;
    for (const RecordedSample& each : late->follow()) lost[each.channel] += each.lost;
    EXPECT_GT(lost.at(0), 0u);
}

TEST_F(Recorded, a_truncated_file_is_good_up_to_its_last_whole_record) {
    record(40ms);
    const std::string whole = end();
    const auto all = mcap::read(whole);
    ASSERT_TRUE(all.has_value());
    std::size_t before = 0;
    for (std::size_t bytes = 0; bytes < whole.size(); ++bytes) {
        const auto part = mcap::read(std::string_view{whole}.substr(0, bytes));
        ASSERT_TRUE(part.has_value()) << "cut at byte " << bytes << ": " << part.error();
        ASSERT_FALSE(part->has_end);
        ASSERT_LE(part->whole_bytes, bytes);
        ASSERT_GE(part->messages.size(), before);
        before = part->messages.size();
        for (std::size_t i = 0; i < part->messages.size(); ++i)
            ASSERT_EQ(part->messages[i].data, all->messages[i].data);
    }
    EXPECT_EQ(before, all->messages.size());
}

TEST_F(Recorded, damage_of_a_file_never_causes_a_read_outside_of_it) {
    record(40ms);
    const std::string whole = end();
    std::mt19937_64 random{7};
    for (int round = 0; round < 3000; ++round) {
        std::string damaged = whole;
        for (int n = 0; n <= round % 3; ++n) damaged[random() % damaged.size()] = static_cast<char>(random());
        const auto read = mcap::read(damaged);
        if (read) static_cast<void>(as_csv(*read));
    }
}

// Outside of the chunks are the header, the machine's name and the end.
TEST_F(Recorded, a_flipped_bit_is_reported_and_costs_at_most_its_chunk) {
    record(1s);
    const std::string whole = end();
    const auto all = mcap::read(whole);
    ASSERT_TRUE(all && all->damage.empty());
    const std::size_t chunks = whole.find("\x06"), behind = whole.rfind("\x0f");
    std::mt19937_64 random{7};
    std::size_t most_lost = 0;
    int unnoticed = 0, cut = 0;
    for (int round = 0; round < 600; ++round) {
        std::string damaged = whole;
        const std::size_t at = chunks + random() % (behind - chunks);
        damaged[at] = static_cast<char>(damaged[at] ^ 1 << random() % 8);
        const auto read = mcap::read(damaged);
        ASSERT_TRUE(read) << read.error();
        unnoticed += read->damage.empty() && read->has_end;
        cut += read->has_end ? 0 : 1;
        if (read->has_end) most_lost = std::max(most_lost, all->messages.size() - read->messages.size());
    }
    // A damaged byte makes a chunk an index, which no reader uses.
    EXPECT_LE(unnoticed, 3);
    EXPECT_LT(most_lost, all->messages.size() / 10) << "of a chunk";
    EXPECT_LE(cut, 12) << "a length that flipped";
    std::printf(
        "of 600 bits %d were not noticed, %d hid what follows; %zu of %zu messages were lost at most\n",
        unnoticed, cut, most_lost, all->messages.size());
}

TEST_F(Recorded, zeros_left_by_a_power_cut_are_not_damage) {
    record(40ms);
    const std::string whole = file;
    const auto all = mcap::read(whole);
    const auto read = mcap::read(whole + std::string(5000, '\0'));
    ASSERT_TRUE(all && read);
    EXPECT_FALSE(read->has_end);
    EXPECT_EQ(read->damage, "");
    EXPECT_EQ(read->messages.size(), all->messages.size());
    EXPECT_GT(read->messages.size(), 0u);
}

constexpr auto windowed = machine_with(reporting(
    report("axis.position", every(2), before(20ms), after(10ms), trigger("axis.missed")),
    report("axis.mode", on_change(), before(15ms), trigger("axis.missed")), report("press.strokes")));

TEST(Window, keeps_only_what_was_recorded_around_its_event) {
    Rig<windowed> rig;
    const auto map = MapReader::open(rig.instance.observation().shared_memory());
    ASSERT_TRUE(map.has_value());
    auto reader = RecordReader::open(*map);
    ASSERT_TRUE(reader.has_value()) << reader.error();
    Recording recording{*map, reader->channels(), 0};
    ASSERT_TRUE(rig.start());
    for (const std::int64_t miss : {101, 107, 201}) {
        rig.axis->misses_at = miss;
        for (; rig.axis->steps < miss; recording.add(reader->follow())) ASSERT_TRUE(rig.run(3ms));
    }
    ASSERT_TRUE(rig.run(100ms));
    recording.add(reader->follow());
    recording.end();
    const std::string file = recording.take();
    const auto contents = mcap::read(file);
    ASSERT_TRUE(contents.has_value());
    const auto read = by_topic(*contents);
    EXPECT_EQ(read.at("axis.missed").size(), 3u);
    EXPECT_EQ(read.at("axis.missed").back().value, 3);
    std::vector<int> steps;
    for (const Read& each : read.at("axis.position")) steps.push_back(int(each.value.get<double>() * 4));
    std::vector<int> wanted;
    for (int step = 81; step <= 117; step += 2) wanted.push_back(step); // two windows that meet
    for (int step = 181; step <= 211; step += 2) wanted.push_back(step);
    EXPECT_EQ(steps, wanted);
    const auto& mode = read.at("axis.mode");
    ASSERT_EQ(mode.size(), 6u);
    EXPECT_EQ(mode[0].value, "resting") << "it stood when the window began";
    EXPECT_LT(mode[0].time, read.at("axis.missed")[0].time - 15'000'000);
    EXPECT_EQ(mode[1].value, "moving");
    EXPECT_EQ(read.at("press.strokes").back().value, read.at("press.strokes").size()) << "it has no window";
    EXPECT_EQ(recording.lost(), 0u);
}

/// A copy of the machine's memory, to be damaged.
class Copied {
public:
    explicit Copied(std::span<const std::byte> memory)
        : bytes_{static_cast<std::byte*>(::operator new[](memory.size(), page))}, size_{memory.size()} {
        take(memory);
    }
    ~Copied() { ::operator delete[](bytes_, page); }
    Copied(const Copied&) = delete;
    Copied& operator=(const Copied&) = delete;
    void take(std::span<const std::byte> memory) const { std::memcpy(bytes_, memory.data(), size_); }
    [[nodiscard]] std::span<std::byte> bytes() const { return {bytes_, size_}; }

private:
    static constexpr std::align_val_t page{4096};
    std::byte* bytes_;
    std::size_t size_;
};

/// An address sanitizer would report a read outside.
TEST_F(Recorded, a_damaged_description_in_memory_causes_no_read_outside_of_it) {
    record(100ms);
    const auto memory = rig.instance.observation().shared_memory();
    const Copied copy{memory};
    const std::uint64_t begin = map->header().report_at;
    std::mt19937_64 random{11};
    int refused = 0;
    for (int round = 0; round < 400; ++round) {
        copy.take(memory);
        // Most damage hits the description, although the values are larger.
        for (int n = 0; n < 1 + round % 20; ++n)
            copy.bytes()[begin + random() % (n % 2 == 0 ? 600 : memory.size() - begin)] =
                static_cast<std::byte>(random());
        auto damaged = MapReader::open(copy.bytes());
        ASSERT_TRUE(damaged.has_value());
        auto read = RecordReader::open(*damaged);
        refused += read ? 0 : 1;
        if (read) static_cast<void>(read->follow());
    }
    EXPECT_GT(refused, 50);
}

TEST_F(Recorded, damaged_words_on_a_tape_cause_no_read_outside_of_it) {
    const auto memory = rig.instance.observation().shared_memory();
    const std::byte* begin = memory.data() + map->header().report_at;
    const auto* tape = reinterpret_cast<const recorded::Tape*>(
        begin + reinterpret_cast<const recorded::Directory*>(begin)->tapes_at);
    const std::size_t words_at = map->header().report_at + tape->at + sizeof(recorded::ValueTape);
    const Copied before{memory};
    record(100ms);
    const Copied copy{memory};
    auto same = MapReader::open(copy.bytes());
    ASSERT_TRUE(same.has_value());
    std::mt19937_64 random{13};
    std::size_t least = ~std::size_t{0};
    for (int round = 0; round < 400; ++round) {
        copy.take(before.bytes());
        auto read = RecordReader::open(*same);
        ASSERT_TRUE(read.has_value()) << read.error();
        copy.take(memory);
        for (int n = 0; n < 1 + round % 20; ++n)
            copy.bytes()[words_at + random() % 4096] = static_cast<std::byte>(random());
        least = std::min(least, read->follow().size());
    }
    EXPECT_LT(least, 300u) << "some of it was thrown away";
}

TEST_F(Recorded, an_independent_reader_finds_the_same) {
    record(300ms);
    ASSERT_TRUE(rig.run(5s)); // so that something is lost
    record(20ms);
    const std::string& whole = end();
    const auto contents = mcap::read(whole);
    ASSERT_TRUE(contents.has_value());
    const test::Folder folder;
    const std::string name = folder / "a.mcap";
    const auto foreign = [&](std::string_view bytes, std::string_view option) {
        std::ofstream{name, std::ios::binary} << bytes;
        return run_line("/usr/bin/python3 " TAPPET_MCAP_READER " " + name + " " + std::string{option});
    };
    const Ended all = foreign(whole, "");
    const Ended cut = foreign(std::string_view{whole}.substr(0, whole.size() * 2 / 3), "--cut");
    ASSERT_EQ(all.exit_code, 0) << all.text;
    EXPECT_EQ(cut.exit_code, 0) << cut.text;
    EXPECT_THAT(all.text, StartsWith(cut.text));
    std::map<std::uint16_t, std::string> topics;
    for (const mcap::Channel& each : contents->channels) topics[each.id] = each.topic;
    std::istringstream lines{all.text};
    std::size_t i = 0;
    for (std::string line; std::getline(lines, line); ++i) {
        const auto theirs = nlohmann::json::parse(line);
        const mcap::Message& ours = contents->messages.at(i);
        EXPECT_EQ(theirs["topic"], topics[ours.channel]);
        EXPECT_EQ(theirs["sequence"], ours.sequence);
        EXPECT_EQ(theirs["time"], ours.log_ns);
        EXPECT_EQ(theirs["message"], nlohmann::json::parse(ours.data));
    }
    EXPECT_EQ(i, contents->messages.size());
}

// ---- the table

mcap::Contents contents_of(const std::string& file) {
    auto contents = mcap::read(file);
    EXPECT_TRUE(contents.has_value()) << contents.error();
    return std::move(*contents);
}

TEST(Csv, has_a_line_for_each_time_and_a_column_for_each_channel) {
    std::string file;
    mcap::put_begin(file, "test");
    mcap::put_channel(file, {1, 0, "a,b", "json", {}});
    mcap::put_channel(file, {4, 0, "c", "json", {}});
    mcap::put_message(file, {1, 0, 1'000'000'001, R"({"value": 0.5})"});
    mcap::put_message(file, {4, 0, 1'000'000'001, R"({"value": "say \"no\""})"});
    mcap::put_message(file, {4, 1, 3'000'000'000, R"({"value": [1, 2]})"});
    mcap::put_message(file, {1, 1, 2'000'000'000, R"({"value": null})"}); // of before an event
    mcap::put_message(file, {1, 2, 3'000'000'000, R"({"value": true})"});
    mcap::put_message(file, {1, 3, 3'000'000'000, R"({"other": 1, "value": 2})"});
    EXPECT_EQ(as_csv(contents_of(file)), "time_s,\"a,b\",c\r\n"
                                         "1.000000001,0.5,\"say \"\"no\"\"\"\r\n"
                                         "2.000000000,,\r\n"
                                         "3.000000000,true,\"[1,2]\"\r\n"
                                         "3.000000000,\"{\"\"other\"\":1,\"\"value\"\":2}\",\r\n");
}

TEST(Csv, has_only_its_header_for_an_empty_recording) {
    std::string file;
    mcap::put_begin(file, "test");
    EXPECT_EQ(as_csv(contents_of(file)), "time_s\r\n");
}

// ---- refused files

std::string fault_of(std::string_view file) {
    const auto read = mcap::read(file);
    return read ? read->damage : read.error();
}

TEST(Mcap, refuses_other_files_and_contradictions) {
    EXPECT_THAT(fault_of("PNG"), HasSubstr("is not an MCAP file"));
    std::string file;
    mcap::put_begin(file, "test");
    EXPECT_EQ(fault_of(file), "");
    std::string no_channel = file;
    mcap::put_message(no_channel, {7, 0, 1, "{}"});
    EXPECT_THAT(fault_of(no_channel), HasSubstr("a message is of channel 7, which is not there, at byte"));
    EXPECT_THAT(fault_of(file + std::string("\x04\x02\0\0\0\0\0\0\0\x01\0", 11)),
                HasSubstr("contradicts itself at byte"));
    EXPECT_THAT(fault_of(file + std::string("\x06\0\0\0\0\0\0\0\0", 9)),
                HasSubstr("a chunk does not have its checksum at byte"));
    std::string packed{"\x06\x27\0\0\0\0\0\0\0", 9};
    packed += std::string(28, '\0') + std::string("\x03\0\0\0lz4", 7) + std::string(4, '\0');
    EXPECT_THAT(fault_of(file + packed), testing::AnyOf(HasSubstr("packed"), HasSubstr("checksum")));
    EXPECT_EQ(fault_of(file + std::string(40, '\0')), "") << "a cut";
    EXPECT_THAT(fault_of(file + std::string(40, '\0') + "x"), HasSubstr("there is no record at byte"));
    EXPECT_EQ(fault_of(file + std::string("\x80\0\0\0\0\0\0\0\0", 9)), "") << "of somebody else's";
    EXPECT_THAT(fault_of(file + std::string("\x7f\0\0\0\0\0\0\0\0", 9)), HasSubstr("is of no kind"));
}

// ---- files on the disk

struct Disk : testing::Test {
    test::Folder folder;
    [[nodiscard]] std::string at(const char* name) const { return (folder / name).string(); }
};

TEST_F(Disk, a_recording_holds_all_that_was_written_and_is_never_overwritten) {
    {
        auto file = RecordFile::create(at("a.mcap"));
        ASSERT_TRUE(file.has_value());
        (*file)->write("one ");
        (*file)->write("two");
        EXPECT_TRUE((*file)->finish().has_value());
    }
    EXPECT_EQ(LocalFiles{}.read(at("a.mcap")).value(), "one two");
    const auto again = RecordFile::create(at("a.mcap"));
    ASSERT_FALSE(again.has_value());
    EXPECT_THAT(again.error().sentence, HasSubstr("is there already; name another file"));
    EXPECT_FALSE(RecordFile::create(at("none/a.mcap")).has_value());
}

TEST_F(Disk, a_file_without_a_lock_has_no_recorder) {
    std::ofstream{at("a.mcap")} << "x";
    const auto stopped = stop_recording(at("a.mcap"));
    ASSERT_FALSE(stopped.has_value());
    EXPECT_THAT(stopped.error().sentence, HasSubstr("nobody records into"));
    EXPECT_THAT(stop_recording(at("b.mcap")).error().sentence, HasSubstr("name the file of 'report start'"));
}

} // namespace
} // namespace tappet::browser
