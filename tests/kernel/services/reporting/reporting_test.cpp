// The tapes of a machine that records values: the recorded cycles and values, without any unwritten value.
#include "tests/kernel/services/reporting/recorded_machine.hpp"

#include "kernel/machine/map/view.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <memory>
#include <thread>

namespace tappet::recorded_test {
namespace {

struct Sample {
    std::uint32_t sequence = 0;
    Time at{};
    std::vector<std::uint64_t> words{};

    template <class T> [[nodiscard]] T value() const {
        T value{};
        std::memcpy(static_cast<void*>(&value), words.data(), sizeof value);
        return value;
    }
};

/// All samples that the tapes still hold, channel by channel in table order.
std::vector<std::vector<Sample>> samples_of(const MachineInstance& instance) {
    const auto memory = instance.observation().shared_memory();
    const auto view = map::View::open(memory);
    EXPECT_TRUE(view.has_value());
    const std::byte* begin = memory.data() + view->header().report_at;
    const auto& directory = *reinterpret_cast<const recorded::Directory*>(begin);
    std::vector<std::vector<Sample>> channels(directory.channels);
    const auto* tapes = reinterpret_cast<const recorded::Tape*>(begin + directory.tapes_at);
    for (std::uint32_t t = 0; t < directory.tapes; ++t) {
        const auto& tape = *reinterpret_cast<const recorded::ValueTape*>(begin + tapes[t].at);
        recorded::Moment moment;
        for (std::uint64_t after = tape.head(); tape.moment_before(after, moment); after = moment.at) {
            std::vector<std::uint64_t> words(moment.sample_words());
            EXPECT_TRUE(tape.copy(moment.at, words));
            for (std::size_t i = 0; i < words.size();) {
                const auto head = recorded::SampleHead::of(words[i++]);
                channels.at(head.channel)
                    .push_back({head.sequence, at_ns(moment.at_ns), {&words[i], &words[i] + head.words}});
                i += head.words;
            }
        }
    }
    for (auto& each : channels) std::ranges::reverse(each);
    return channels;
}

constexpr auto each_step = machine_with(reporting(report("axis.position", every(2)), report("axis.late"),
                                                  report("axis.pose", every(25)), report("press.strokes")));

TEST(Reporting, records_each_nth_step_from_the_first_one_on) {
    Rig<each_step> rig;
    ASSERT_TRUE(rig.start() && rig.run(100ms));
    const auto channels = samples_of(rig.instance);
    ASSERT_EQ(channels.size(), 4u);
    const std::int64_t steps = rig.axis->steps;
    ASSERT_EQ(channels[0].size(), static_cast<std::size_t>((steps + 1) / 2));
    for (std::size_t i = 0; i < channels[0].size(); ++i) {
        EXPECT_EQ(channels[0][i].sequence, i);
        EXPECT_EQ(channels[0][i].value<double>(), 0.25 * static_cast<double>(2 * i + 1));
        if (i > 0) {
            EXPECT_EQ(channels[0][i].at - channels[0][i - 1].at, 2ms);
        }
    }
    const Pose pose = channels[2].at(1).value<Pose>();
    EXPECT_EQ(pose.x, 1.5 * 26);
    EXPECT_EQ(pose.turns, -26);
    EXPECT_EQ(channels[3].back().value<std::int64_t>(), static_cast<std::int64_t>(channels[3].size()))
        << "an activity of its own has its own steps";
}

TEST(Reporting, records_no_unwritten_port) {
    Rig<each_step> rig;
    ASSERT_TRUE(rig.start() && rig.run(10ms));
    const auto late = samples_of(rig.instance)[1];
    ASSERT_EQ(late.size(), static_cast<std::size_t>(rig.axis->steps - 2));
    EXPECT_EQ(late.front().value<std::int32_t>(), -3);
}

constexpr auto changing = machine_with(
    reporting(report("axis.mode", on_change()), report("axis.position", on_change(1.0)),
              report("axis.gain", on_change()), report("axis.label", on_change()), report("press.closed")));

TEST(Reporting, on_change_records_the_first_value_and_each_different_one) {
    Rig<changing> rig;
    ASSERT_TRUE(rig.start() && rig.run(100ms));
    const auto channels = samples_of(rig.instance);
    std::vector<Mode> modes;
    for (const Sample& each : channels[0]) modes.push_back(each.value<Mode>());
    ASSERT_GE(modes.size(), 10u);
    for (std::size_t i = 0; i < modes.size(); ++i)
        EXPECT_EQ(modes[i], i % 2 == 0 ? Mode::resting : Mode::moving);
    ASSERT_EQ(channels[2].size(), 1u);
    EXPECT_EQ(channels[2][0].value<double>(), 1.0);
    EXPECT_EQ(channels[3].at(0).value<Text<12>>().view(), "axis");
}

TEST(Reporting, on_change_applies_its_band_to_the_last_recorded_value) {
    Rig<changing> rig;
    ASSERT_TRUE(rig.start() && rig.run(100ms));
    const auto positions = samples_of(rig.instance)[1];
    ASSERT_GT(positions.size(), 10u);
    for (std::size_t i = 1; i < positions.size(); ++i)
        EXPECT_EQ(positions[i].value<double>() - positions[i - 1].value<double>(), 1.25)
            << "a millimetre is within the band";
}

TEST(Reporting, on_change_records_each_step_to_and_from_nan_once) {
    static constexpr auto table = machine_with(reporting(report("axis.pull", on_change(0.5))));
    Rig<table> rig;
    ASSERT_TRUE(rig.start() && rig.run(5ms));
    for (const double pull : {std::nan(""), std::nan(""), 7.0, 7.4, 7.6}) {
        rig.axis->pulls = pull;
        ASSERT_TRUE(rig.run(3ms));
    }
    const auto pulls = samples_of(rig.instance)[0];
    ASSERT_EQ(pulls.size(), 4u);
    EXPECT_TRUE(std::isnan(pulls[1].value<double>()));
    EXPECT_EQ(pulls[2].value<double>(), 7.0);
    EXPECT_EQ(pulls[3].value<double>(), 7.6);
}

TEST(Reporting, records_the_safe_values_that_a_stop_leaves) {
    Rig<changing> rig;
    ASSERT_TRUE(rig.start() && rig.run(15ms));
    EXPECT_EQ(samples_of(rig.instance)[0].back().value<Mode>(), Mode::moving);
    rig.world.stop();
    EXPECT_EQ(samples_of(rig.instance)[0].back().value<Mode>(), Mode::resting);
}

TEST(Reporting, of_a_component_records_all_recordable_outputs) {
    static constexpr auto table = machine_with(reporting(report("axis.*", every(10)), report("axis.gain")));
    Rig<table> rig;
    ASSERT_TRUE(rig.start() && rig.run(50ms));
    EXPECT_EQ(samples_of(rig.instance).size(), 7u);
}

TEST(Reporting, overwrites_the_oldest_samples_and_shows_it_by_their_numbers) {
    Rig<each_step> rig;
    ASSERT_TRUE(rig.start() && rig.run(20s));
    const auto positions = samples_of(rig.instance)[0];
    EXPECT_GT(positions.front().sequence, 0u);
    EXPECT_GE(positions.back().at - positions.front().at, reporting_detail::tape_span)
        << "so long a tape holds at least";
    for (std::size_t i = 1; i < positions.size(); ++i)
        EXPECT_EQ(positions[i].sequence, positions[i - 1].sequence + 1);
    EXPECT_EQ(positions.back().sequence + 1, (rig.axis->steps + 1) / 2);
}

constexpr auto around = machine_with(
    reporting(report("axis.position", before(20ms), after(10ms), trigger("axis.missed")), report("axis.mode"),
              report("press.strokes", after(30ms), trigger("axis.missed"))));

TEST(Reporting, counts_the_events_of_windows_in_each_activity_with_one) {
    Rig<around> rig;
    rig.axis->misses_at = 60;
    ASSERT_TRUE(rig.start() && rig.run(100ms));
    const auto channels = samples_of(rig.instance);
    ASSERT_EQ(channels.size(), 5u) << "the event once for motion, once for slow";
    const auto& in_motion = channels[0];
    ASSERT_EQ(in_motion.size(), 1u) << "nothing before the first emission";
    EXPECT_EQ(in_motion[0].value<std::uint64_t>(), 1u);
    EXPECT_EQ(in_motion[0].at, channels[1].at(59).at) << "in the cycle that emitted it";
    ASSERT_EQ(channels[3].size(), 1u);
    EXPECT_GE(channels[3][0].at, in_motion[0].at);
    EXPECT_LE(channels[3][0].at, in_motion[0].at + 5ms) << "in the next cycle that can see it";
    EXPECT_EQ(channels[1].size(), static_cast<std::size_t>(rig.axis->steps)) << "the tape has all";
}

TEST(Reporting, does_not_change_the_machines_behaviour) {
    static constexpr auto silent = machine_with();
    Rig<each_step> with;
    Rig<silent> without;
    ASSERT_TRUE(with.start() && with.run(1s) && without.start() && without.run(1s));
    EXPECT_EQ(with.instance.observation().event_log_digest(),
              without.instance.observation().event_log_digest());
    EXPECT_EQ(with.axis->position.last(), without.axis->position.last());
}

// ---- the tape

struct Free {
    void operator()(recorded::ValueTape* tape) const {
        ::operator delete(tape, std::align_val_t{recorded::ValueTape::alignment});
    }
};

std::unique_ptr<recorded::ValueTape, Free> make_tape(std::size_t words, std::size_t most) {
    void* memory = ::operator new(recorded::ValueTape::bytes_for(words),
                                  std::align_val_t{recorded::ValueTape::alignment});
    return std::unique_ptr<recorded::ValueTape, Free>{new (memory) recorded::ValueTape{words, most}};
}

TEST(ValueTape, keeps_only_cycles_with_samples) {
    const auto tape = make_tape(256, 8);
    tape->end(tape->begin(), 1);
    EXPECT_EQ(tape->head(), 0u);
    recorded::Moment moment;
    EXPECT_FALSE(tape->moment_before(tape->head(), moment));
}

/// The thread sanitizer would detect a race; this test detects a torn cycle.
TEST(ValueTape, never_shows_a_reader_a_torn_cycle) {
    constexpr std::uint64_t moments = 200'000;
    const auto tape = make_tape(256, 8);
    std::atomic<bool> done{false};
    std::thread engine{[&] {
        for (std::uint64_t n = 1; n <= moments; ++n) {
            auto pen = tape->begin();
            for (std::uint64_t i = 0; i <= n % 6; ++i) pen.put(n);
            tape->end(pen, static_cast<std::int64_t>(n));
        }
        done = true;
    }};
    std::uint64_t read = 0;
    for (bool last = false; !last || read == 0;) {
        last = done;
        recorded::Moment moment;
        for (std::uint64_t after = tape->head(); tape->moment_before(after, moment); after = moment.at) {
            std::vector<std::uint64_t> words(moment.sample_words());
            if (!tape->copy(moment.at, words)) break;
            ++read;
            const auto n = static_cast<std::uint64_t>(moment.at_ns);
            ASSERT_EQ(words.size(), n % 6 + 1);
            for (const std::uint64_t word : words) ASSERT_EQ(word, n);
        }
    }
    engine.join();
}

} // namespace
} // namespace tappet::recorded_test
