// Totals that survive the main switch, stored in files, over two lives of a machine.
#include "kernel/pieces/kept.hpp"
#include "kernel/services/configuration/property_files.hpp"
#include "kernel/services/configuration/property_keeper.hpp"
#include "tests/kernel/base/hostile.hpp"
#include "tests/kernel/machine/virtual_rig.hpp"
#include "tests/kernel/os/folder.hpp"

namespace tappet {
namespace {

struct Press {
    Output<bool> runs;
    Output<std::int64_t> strokes;
    bool turns = false;
    std::int64_t count = 0;
    void step(const Cycle&) noexcept TAPPET_REALTIME {
        runs.write(turns);
        strokes.write(count);
    }
    static constexpr auto interface() {
        return facets(output<&Press::runs>("runs", "", "it turns"),
                      output<&Press::strokes>("strokes", "", "since start"));
    }
};

// clang-format off
inline constexpr auto table = machine("press",
    components(component<Press>("press"), component<HourMeter>("hours", properties_file("hours.cpf", optional)),
               component<Total>("strokes", properties_file("strokes.cpf", optional)),
               component<Total>("spare", properties_file("spare.cpf", optional)),
               component<PropertyKeeper>("keeper", set("every", 60s))),
    activities(activity("main", every(10ms), budget(50us), runs("press", "hours", "strokes")),
               activity("aside", every(10ms), budget(50us), runs("spare")),
               activity("keeper", every(100ms), not_real_time, runs("keeper"))),
    connections(data("press.runs", "hours.runs", stale_after(1s), hold),
                data("press.strokes", "strokes.count"), data("press.strokes", "spare.count", stale_after(1s), hold)),
    reactions(), behaviours());
// clang-format on

constexpr std::size_t aside = 1; ///< the activity

/// One life of the machine, which ends without notice, as by the main switch.
struct Life : VirtualRig {
    PropertyFiles files;

    explicit Life(const std::string& directory)
        : VirtualRig{AtRunTime<table, test_board>::machine()}, files{directory} {
        instance.read_properties_from(files.store());
        start();
    }
};

struct Kept : test::Hostile {
    test::Folder folder;
    std::string directory = folder.path;
};

TEST_F(Kept, hours_and_totals_resume_at_the_last_saved_values) {
    {
        Life life{directory};
        life.the<Press>("press").turns = true;
        life.the<Press>("press").count = 7;
        life.run(61s);
        EXPECT_NEAR(life.the<HourMeter>("hours").hours.last() * 3600, 61.0, 0.1);
        EXPECT_EQ(life.the<Total>("strokes").sum.last(), 7);
        life.the<Press>("press").count = 9;
        life.run(10s);
        EXPECT_EQ(life.the<Total>("strokes").sum.last(), 9);
        EXPECT_EQ(life.the<PropertyKeeper>("keeper").saved.last(), 1);
        EXPECT_EQ(life.the<PropertyKeeper>("keeper").failed.last(), 0);
    }
    Life life{directory};
    life.run(1s);
    EXPECT_NEAR(life.the<HourMeter>("hours").hours.last() * 3600, 60.0, 0.2) << "it did not run since";
    EXPECT_EQ(life.the<Total>("strokes").sum.last(), 7) << "two were lost with the last seconds";
    life.the<Press>("press").count = 2;
    life.run(1s);
    EXPECT_EQ(life.the<Total>("strokes").sum.last(), 9);
    life.the<Press>("press").count = 1;
    life.run(1s);
    EXPECT_EQ(life.the<Total>("strokes").sum.last(), 10) << "a smaller count began anew";
}

TEST_F(Kept, a_restarted_total_counts_nothing_twice) {
    Life life{directory};
    life.the<Press>("press").count = 10'000;
    life.run(1s);

    for (const LifeChange change : {LifeChange::stop, LifeChange::start, LifeChange::restart}) {
        life.change("strokes", change);
        life.run(100ms);
        life.the<Press>("press").count += 5;
        life.run(100ms);
    }
    EXPECT_EQ(life.the<Total>("strokes").sum.last(), 10'015);
}

TEST_F(Kept, values_are_saved_although_another_activity_is_stopped) {
    Life life{directory};
    life.the<Press>("press").count = 7;
    life.run(1s);
    testing::internal::CaptureStdout();
    static_cast<void>(life.instance.life().ask_activity(aside, LifeChange::stop));
    life.run(30min);
    const std::string said = testing::internal::GetCapturedStdout();
    EXPECT_NE(said.find("component \"spare\": its properties are not saved"), std::string::npos) << said;
    EXPECT_TRUE(std::filesystem::exists(directory + "/strokes.cpf"));
    life.the<Press>("press").count = 8;
    life.run(61s);
    Life next{directory};
    EXPECT_EQ(next.the<Total>("strokes").total.get(), 8);
}

TEST_F(Kept, totals_and_hours_saturate_at_the_ends_of_their_range) {
    using Whole = std::numeric_limits<std::int64_t>;
    Life life{directory};
    auto& total = life.the<Total>("strokes").total;
    auto& count = life.the<Press>("press").count;
    total.set(-5);
    count = 3;
    life.run(20ms);
    EXPECT_EQ(total.get(), -2);
    for (int n = 0; n < 500; ++n) {
        const std::int64_t before = total.get(), bits = static_cast<std::int64_t>(random.next());
        count = one_of(std::array{Whole::min(), Whole::max(), bits, std::int64_t{0}, count});
        life.run(20ms);
        ASSERT_GE(total.get(), before) << count;
    }
    EXPECT_EQ(total.get(), Whole::max());
    auto& hours = life.the<HourMeter>("hours").total;
    hours.set(8'999'999'999s);
    life.the<Press>("press").turns = true;
    life.run(5s);
    EXPECT_EQ(hours.get(), 9'000'000'000s) << "or no file of it is read again";
}

TEST_F(Kept, hours_count_only_while_running) {
    Life life{directory};
    Press& press = life.the<Press>("press");
    const auto seconds = [&] { return life.the<HourMeter>("hours").hours.last() * 3600; };
    life.run(5s);
    EXPECT_EQ(seconds(), 0.0);
    press.turns = true;
    life.run(5s);
    press.turns = false;
    life.run(5s);
    EXPECT_NEAR(seconds(), 5.0, 0.05);
}

TEST_F(Kept, a_keeper_that_cannot_write_reports_it_and_continues) {
    Life life{directory};
    std::filesystem::create_directory(directory + "/hours.cpf.tappet-new"); // the path of the new file
    testing::internal::CaptureStdout();
    life.run(125s);
    const std::string said = testing::internal::GetCapturedStdout();
    EXPECT_EQ(life.the<PropertyKeeper>("keeper").failed.last(), 2);
    EXPECT_NE(said.find("keeper: "), std::string::npos) << said;
    EXPECT_TRUE(std::filesystem::exists(directory + "/strokes.cpf")) << "the others are kept";
}

} // namespace
} // namespace tappet
