// The scope of a whole machine as a browser reads it: the carpet loom's own memory, and the same memory
// damaged (thesis A.2.1).
#include "tests/apps/carpet_loom/loom_run.hpp"
#include "toolchain/tools/browser/waves.hpp"

#include "tests/toolchain/tools/browser/vcd_reader.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <memory>
#include <new>
#include <random>

namespace tappet::browser {
namespace {

constexpr Duration between_looks = 20ms;

/// A started loom, and a reader of its memory.
struct Scope : testing::Test {
    std::unique_ptr<carpet::LoomRun> run = std::make_unique<carpet::LoomRun>(loom::Settings{}, 7);
    std::optional<MapReader> map;
    std::optional<ScopeReader> scope;

    void SetUp() override {
        const auto started = run->start();
        ASSERT_TRUE(started.has_value()) << started.error().view();
        auto opened = MapReader::open(run->instance().observation().shared_memory());
        ASSERT_TRUE(opened.has_value()) << opened.error();
        map = *opened;
        auto read = ScopeReader::open(*map);
        ASSERT_TRUE(read.has_value()) << read.error();
        scope = *read;
    }
    void TearDown() override { run->stop(); }
    std::uint32_t activity(std::string_view name) {
        for (std::uint32_t a = 0; a < map->activities().size(); ++a)
            if (map->text(map->activities()[a].name) == name) return a;
        ADD_FAILURE() << "no activity " << name;
        return 0;
    }
};

TEST_F(Scope, names_the_functions_in_every_cycle_of_an_activity) {
    const std::uint32_t motion = activity("motion");
    Waves waves = scope->empty();
    std::uint64_t position = scope->tape(motion).head();
    for (int look = 0; look < 20; ++look) {
        run->run_for(between_looks);
        EXPECT_TRUE(scope->follow(motion, position, waves));
    }
    ASSERT_NEAR(static_cast<double>(waves.cycles.size()), 400, 1);
    for (std::size_t i = 0; i < waves.cycles.size(); ++i) {
        const WaveCycle& cycle = waves.cycles[i];
        EXPECT_EQ(cycle.release - waves.cycles[0].release, static_cast<std::int64_t>(i) * 1'000'000);
        std::vector<std::string> steps;
        for (const Block& block : cycle.blocks)
            if (WaveActivity::kind_of(block.function) == "step")
                steps.push_back(waves.activities[motion].name_of(block.function));
        std::ranges::sort(steps);
        EXPECT_EQ(steps, (std::vector<std::string>{"main.step", "network.step", "warp.step"}));
    }
    waves.from = waves.cycles.front().release;
    waves.to = waves.cycles.back().end;
    EXPECT_EQ(VcdReader{as_vcd(waves)}.fault(), "");
}

TEST_F(Scope, reports_cycles_that_were_overwritten_before_reading) {
    const std::uint32_t motion = activity("motion");
    Waves waves = scope->empty();
    std::uint64_t position = scope->tape(motion).head();
    run->run_for(5s);
    EXPECT_FALSE(scope->follow(motion, position, waves));
    EXPECT_GT(waves.cycles.size(), 100u) << "the last ones are there: 100 ms at least";
    EXPECT_EQ(position, scope->tape(motion).head());
}

TEST_F(Scope, keeps_worst_cycles_of_every_real_time_activity_with_what_ran_around_them) {
    run->run_for(2s);
    const auto kept = scope->worst();
    ASSERT_TRUE(kept.has_value());
    std::vector<std::size_t> of(map->activities().size(), 0);
    for (const Kept& each : *kept) {
        ++of[each.of.activity];
        const Waves waves = scope->waves_of(each);
        const bool has_itself = std::ranges::any_of(waves.cycles, [&](const WaveCycle& cycle) {
            return cycle.activity == each.of.activity && cycle.begin == each.of.begin &&
                   cycle.end == each.of.end;
        });
        EXPECT_TRUE(has_itself);
        EXPECT_EQ(VcdReader{as_vcd(waves)}.fault(), "");
    }
    for (std::uint32_t a = 0; a < of.size(); ++a)
        EXPECT_EQ(of[a] > 0, map->activities()[a].real_time != 0) << map->text(map->activities()[a].name);
    EXPECT_TRUE(
        std::ranges::is_sorted(*kept, std::ranges::greater{}, [](const Kept& k) { return k.of.rank_ns; }));
    EXPECT_EQ(scope->directory().overtaken, 0u);
}

/// An address sanitizer would report a read outside.
TEST_F(Scope, never_reads_outside_of_a_damaged_memory) {
    run->run_for(200ms);
    const auto memory = run->instance().observation().shared_memory();
    const std::size_t bytes = memory.size();
    constexpr std::align_val_t page{4096};
    const auto free = [](std::byte* at) { ::operator delete[](at, page); };
    const std::unique_ptr<std::byte[], decltype(free)> copy{
        static_cast<std::byte*>(::operator new[](bytes, page)), free};
    const std::uint64_t scope_at = map->header().scope_at;
    const std::size_t scope_bytes = scope->directory().bytes;
    std::mt19937_64 random{std::random_device{}()};
    int refused = 0;
    std::memcpy(copy.get(), memory.data(), bytes);
    for (int round = 0; round < 300; ++round) {
        std::memcpy(copy.get() + scope_at, memory.data() + scope_at, scope_bytes);
        // Most damage hits the directory and the heads of the tapes.
        for (int n = 0; n < 1 + round % 20; ++n) {
            const std::size_t within =
                round % 2 == 0 ? sizeof(scope::Directory) + 10 * sizeof(scope::Tape) + 64 : scope_bytes;
            copy[scope_at + random() % within] = static_cast<std::byte>(random());
        }
        const auto damaged_map = MapReader::open({copy.get(), bytes});
        ASSERT_TRUE(damaged_map.has_value()) << "the map itself is whole";
        const auto damaged = ScopeReader::open(*damaged_map);
        if (!damaged) {
            ++refused;
            continue;
        }
        Waves waves = damaged->empty();
        for (std::uint32_t a = 0; a < map->activities().size(); ++a) {
            std::uint64_t position = 0;
            static_cast<void>(damaged->follow(a, position, waves));
        }
        if (const auto kept = damaged->worst())
            for (const Kept& each : *kept) static_cast<void>(damaged->waves_of(each));
    }
    EXPECT_GT(refused, 0);
}

} // namespace
} // namespace tappet::browser
