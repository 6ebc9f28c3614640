// Each program of figures runs for a moment: its result is complete and sane, it contains its floors and
// peers, and each claim is judged. The measured times are not tested.
#include "tests/figures/measure/result.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <string>
#include <thread>
#include <vector>

#include <unistd.h>

namespace tappet::figures {
namespace {

using testing::Contains;

/// Runs it with --smoke and a file for its result; a failed test says why.
Result run_smoke(const std::string& name) {
    const std::string program = TAPPET_FIGURES "/" + name + "/figures-" + name;
    const std::string file = testing::TempDir() + "figures-" + std::to_string(::getpid()) + ".json";
    const std::string command = "'" + program + "' --smoke --json '" + file + "' >/dev/null 2>&1";
    EXPECT_EQ(std::system(command.c_str()), 0) << command;
    auto read = read_result(file);
    ::unlink(file.c_str());
    EXPECT_TRUE(read.has_value()) << (read ? std::string{} : read.error());
    return read ? *read : Result{};
}

std::vector<std::string> ids_of(const auto& figures_or_plots) {
    std::vector<std::string> ids;
    for (const auto& each : figures_or_plots) ids.push_back(each.id);
    return ids;
}
std::ptrdiff_t rows_of(const Figure& figure, Standing role) {
    return std::ranges::count(figure.rows, role, &Row::role);
}

/// Each figure has a row of ours and another one beside it, each with ordered samples.
void expect_sound(const Result& result) {
    for (const Figure& figure : result.figures) {
        EXPECT_GE(figure.rows.size(), 2u) << figure.id;
        for (const Row& row : figure.rows) {
            const Summary& s = row.summary;
            EXPECT_GT(s.count, 0u) << figure.id << ": " << row.name;
            EXPECT_GT(s.median, 0) << figure.id << ": " << row.name;
            EXPECT_LE(s.median, s.p99) << figure.id << ": " << row.name;
            EXPECT_LE(s.p99, s.p999) << figure.id << ": " << row.name;
            EXPECT_LE(s.p999, s.max) << figure.id << ": " << row.name;
        }
        EXPECT_GT(rows_of(figure, Standing::ours), 0) << figure.id;
    }
    for (const Goal& goal : result.goals) {
        EXPECT_TRUE(std::isfinite(goal.measured)) << goal.text;
        EXPECT_GT(goal.limit, 0) << goal.text;
    }
}

/// Programs that contain only figures with floors, goals and statements.
struct Program {
    const char* name;
    std::vector<const char*> figures; ///< each of them has a floor
    std::size_t goals, statements;
};
class Figures : public testing::TestWithParam<Program> {};
TEST_P(Figures, stand_beside_their_floors_and_judge_each_claim) {
    const Program& program = GetParam();
    const Result result = run_smoke(program.name); // fails when two compared subjects do not do the same
    expect_sound(result);
    for (const char* id : program.figures) {
        const auto found = std::ranges::find(result.figures, id, &Figure::id);
        ASSERT_NE(found, result.figures.end()) << id;
        EXPECT_GT(rows_of(*found, Standing::floor), 0) << id;
    }
    EXPECT_EQ(result.goals.size(), program.goals);
    EXPECT_EQ(result.statements.size(), program.statements);
}
const Program programs[] = {
    {"behaviour",
     {"behaviour.event.random", "behaviour.event.steady", "behaviour.step", "behaviour.condition",
      "behaviour.timeout", "behaviour.statement"},
     5,
     0},
    {"dispatch",
     {"dispatch.method",        "dispatch.properties",      "dispatch.cam.row",
      "dispatch.cam.fire",      "dispatch.command.send",    "dispatch.command.execute",
      "dispatch.command.whole", "dispatch.command.for_one", "dispatch.emit.none",
      "dispatch.emit.call.1",   "dispatch.emit.call.2",     "dispatch.emit.call.8",
      "dispatch.emit.call.64",  "dispatch.emit.tell.1",     "dispatch.emit.tell.2",
      "dispatch.emit.tell.8",   "dispatch.emit.tell.64",    "dispatch.connect",
      "dispatch.step.empty",    "dispatch.step.10",         "dispatch.step.100",
      "dispatch.step.1000",     "dispatch.cycle.stamp",     "dispatch.cycle.idle",
      "dispatch.cycle.event"},
     15,
     0},
    {"recording", {"recording.step.100"}, 0, 1},
    {"scope",
     {"scope.step.1", "scope.step.10", "scope.step.timeless", "scope.mark", "scope.look", "scope.followed"},
     0,
     6},
    {"wire", {"wire.value.tell", "wire.value.hear", "wire.event"}, 3, 0},
};
INSTANTIATE_TEST_SUITE_P(Each, Figures, testing::ValuesIn(programs),
                         [](const auto& tested) { return tested.param.name; });

TEST(ExchangeFigures, stand_beside_floors_and_peers_and_judge_each_goal) {
    const Result result = run_smoke("exchange");
    const bool two_cores = std::ranges::none_of(
        result.notes, [](const std::string& note) { return note.contains("has one processor"); });
    for (const char* size : {"8", "160", "4096"})
        for (const char* kind : {"data.local.", "data.across.", "buffer.local.", "buffer.across."}) {
            const std::string id = "exchange." + std::string{kind} + size;
            EXPECT_EQ(std::ranges::count(result.figures, id, &Figure::id), 1) << id;
        }
    for (const Figure& figure : result.figures) {
        EXPECT_EQ(rows_of(figure, Standing::ours), 1) << figure.id;
        EXPECT_GE(rows_of(figure, Standing::floor) + rows_of(figure, Standing::peer), 1) << figure.id;
        for (const Row& row : figure.rows) EXPECT_GT(row.summary.count, 0u) << figure.id << ": " << row.name;
    }
    EXPECT_EQ(result.figures.size(), two_cores ? 22u : 12u);
    EXPECT_EQ(result.goals.size(), two_cores ? 11u : 2u);
    for (const Goal& goal : result.goals) {
        EXPECT_TRUE(std::isfinite(goal.measured)) << goal.text;
        EXPECT_GT(goal.measured, 0) << goal.text;
    }
}

TEST(ExperimentFigures, run_every_application_in_every_setting) {
    const Result result = run_smoke("experiments");
    expect_sound(result);
    for (const std::string application : {"minimal", "small", "concurrent", "large"})
        for (const char* what :
             {".period", ".period.data", ".period.events", ".latency", ".latency.data", ".exchange.high",
              ".command.send", ".command.serve", ".event.send", ".event.serve"})
            EXPECT_THAT(ids_of(result.figures), Contains("experiments." + application + what));
    for (const char* number : {"4.9.minimal", "4.9.large", "4.10.small", "4.14", "4.15", "4.17", "4.18",
                               "4.20", "4.21", "4.34", "4.35", "4.42", "4.43"})
        EXPECT_THAT(ids_of(result.plots), Contains(std::string{"experiments.figure."} + number));
    EXPECT_GE(result.statements.size(), 15u);
}

#if defined(TAPPET_HAS_BENCH)
TEST(BenchFigures, claim_nothing_when_nothing_was_booted) {
    const Result result = run_smoke("bench");
    EXPECT_EQ(result.program, "bench");
    EXPECT_TRUE(result.figures.empty());
    EXPECT_TRUE(result.statements.empty());
    ASSERT_EQ(result.notes.size(), 1u);
    EXPECT_EQ(result.notes.front(), "nothing was booted in this setting");
}

TEST(FirmwareFigures, report_only_the_size_without_a_boot) {
    const Result result = run_smoke("firmware");
    expect_sound(result);
    ASSERT_EQ(result.figures.size(), 1u);
    EXPECT_EQ(result.figures[0].id, "firmware.size");
    EXPECT_GT(result.figures[0].rows[0].summary.median, result.figures[0].rows[1].summary.median)
        << "a machine is larger than none";
    ASSERT_EQ(result.figures[0].rows.size(), 4u);
    ASSERT_EQ(result.goals.size(), 1u);
    EXPECT_EQ(result.goals[0].measured, result.figures[0].rows[0].summary.median);
    EXPECT_THAT(result.notes, Contains("nothing was booted in this setting"));
}
#endif

TEST(FloorsFigures, are_complete_and_contain_floors_only) {
    const Result result = run_smoke("floors");
    for (const Figure& figure : result.figures)
        for (const Row& row : figure.rows) {
            EXPECT_EQ(row.role, Standing::floor) << figure.id << ": " << row.name;
            EXPECT_GT(row.summary.count, 0u) << figure.id << ": " << row.name;
            EXPECT_GT(row.summary.median, 0) << figure.id << ": " << row.name;
            EXPECT_LE(row.summary.median, row.summary.max) << figure.id << ": " << row.name;
        }
    std::vector<std::string> expected{"floors.copy", "floors.word", "floors.system"};
    if (std::thread::hardware_concurrency() > 1)
        expected.insert(expected.end(), {"floors.line", "floors.wake"});
    EXPECT_EQ(ids_of(result.figures), expected);
    const auto expect_less = [&](const char* figure, const char* one, const char* other) {
        const Row *less = result.find(figure, one), *more = result.find(figure, other);
        ASSERT_TRUE(less != nullptr && more != nullptr) << figure;
        EXPECT_LT(less->summary.median, more->summary.median) << figure;
    };
    expect_less("floors.copy", "160 bytes", "4096 bytes");
    expect_less("floors.word", "release store", "exchange");
}

TEST(MotionFigures, are_complete_and_compare_equal_results) {
    const Result result = run_smoke("motion");
    expect_sound(result);
    EXPECT_EQ(ids_of(result.figures),
              (std::vector<std::string>{"motion.kinematics", "motion.dynamics", "motion.inverse",
                                        "motion.cascade.robot", "motion.cascade.axis", "motion.sine",
                                        "motion.trajectory", "motion.control"}));
    std::vector<double> limits;
    for (const Goal& goal : result.goals) limits.push_back(goal.limit);
    EXPECT_EQ(limits, (std::vector<double>{0.25, 0.33, 1.2, 1.2, 100, 250}));
    ASSERT_EQ(result.statements.size(), 2u);
    for (const Statement& each : result.statements) EXPECT_TRUE(each.held) << each.text << each.measured;
}

TEST(ReactionFigures, stand_beside_bare_programs_and_judge_each_goal) {
    const Result result = run_smoke("reaction");
    if (!result.notes.empty() && result.notes.front().starts_with("the reaction path was not measured"))
        GTEST_SKIP() << result.notes.front();
    expect_sound(result);
    ASSERT_EQ(ids_of(result.figures),
              (std::vector<std::string>{"reaction.event.one_core", "reaction.event.two_cores",
                                        "reaction.periodic"}));
    for (const Figure& figure : result.figures) {
        EXPECT_EQ(figure.rows[0].role, Standing::ours);
        EXPECT_EQ(figure.rows[1].role, Standing::floor);
        EXPECT_EQ(figure.rows[0].summary.count, figure.rows[1].summary.count) << "samples come in pairs";
    }
    EXPECT_EQ(result.goals.size(), 4u);
    EXPECT_EQ(result.plots.size(), 3u);
}

TEST(ScaleFigures, measure_a_machine_from_its_source_to_its_step) {
    const Result result = run_smoke("scale");
    const auto expect_between = [&](const char* figure, const char* row, double low, double high) {
        const Row* found = result.find(figure, row);
        ASSERT_NE(found, nullptr) << figure << ": " << row;
        EXPECT_GT(found->summary.median, low) << figure << ": " << row;
        EXPECT_LT(found->summary.median, high) << figure << ": " << row;
    };
    expect_between("scale.compile.time.10", "g++", 0.1, 100);
    expect_between("scale.compile.memory.10", "g++", 50, 2000);
    expect_between("scale.firmware.10", "file", 100, 4000);
    expect_between("scale.memory.10", "all", 16, 1000); // a stack at least, in kB
    expect_between("scale.start.10", "constructed, wired, configured", 0.1, 1e6);
    expect_between("scale.step.10", "engines", 1, 1e5);
    expect_between("scale.system.time.3", "g++", 0.1, 100);
    expect_between("scale.system.memory.3", "g++", 50, 2000);
    for (const char* figure : {"scale.jacquard.can", "scale.jacquard.registers", "scale.step.10"})
        EXPECT_TRUE(std::ranges::any_of(result.figures, [&](const Figure& each) {
            return each.id == figure && rows_of(each, Standing::floor) == 1;
        })) << figure;
    EXPECT_EQ(result.statements.size(), 2u);
}

} // namespace
} // namespace tappet::figures
