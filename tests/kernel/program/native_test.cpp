// The compiled form equals the loaded form step by step (thesis 5.1.1 - 5.1.3): the same table, as native
// code and interpreted from the same data, leaves the same data, position and trace.
#include "kernel/program/interpreter.hpp"
#include "kernel/program/native.hpp"
#include "tests/kernel/program/random_tables.hpp"

#include <algorithm>
#include <gtest/gtest.h>
#include <set>
#include <vector>

namespace tappet {
namespace {

using namespace random_tables;

constexpr std::size_t data_bytes = constant(2 * places + 2 + 4);

/// One instance of a program, in one of its forms.
struct Instance {
    Witness witness{};
    alignas(data_alignment) std::array<std::byte, data_bytes> data{};
    ProgramContext context{};
    ProgramReturn said = ProgramReturn::ended;
    std::uint32_t statements = 0;

    Instance(const ProgramTables& tables, std::uint64_t seed) {
        std::ranges::copy(tables.image, data.begin());
        Random random{seed};
        for (std::size_t i = 0; i < 2; ++i)
            store_value(data.data() + kept(i), static_cast<ScriptInt>(random(40)));
        context.component = &witness;
        context.data = data.data();
    }
    Instance(const Instance&) = delete;
    Instance& operator=(const Instance&) = delete;

    void step(const ProgramCode& code, Time now, std::uint32_t allowed) {
        context.now = now;
        statements = allowed;
        said = code.run(*code.tables, context, statements);
    }
    /// The data that outlive the step: everything but scratch.
    [[nodiscard]] std::vector<std::byte> kept_data() const {
        return {data.begin(), data.begin() + scratch(0)};
    }
};

struct Coverage {
    std::set<int> returns;
    std::set<int> nodes;
};

void expect_same(const ProgramCode& compiled, const ProgramCode& loaded, std::uint64_t seed,
                 Coverage& coverage) {
    Random random{seed};
    Instance one{*compiled.tables, seed}, other{*loaded.tables, seed};
    std::int64_t now = 1000;
    one.context.position.node = other.context.position.node =
        loaded.tables->programs[random(loaded.tables->programs.size())].first;
    for (int step = 0; step < 60; ++step) {
        SCOPED_TRACE("seed " + std::to_string(seed) + ", step " + std::to_string(step));
        now += static_cast<std::int64_t>(random(20));
        const auto allowed = static_cast<std::uint32_t>(random(3) == 0 ? random(3) : random(60));
        one.step(compiled, at_ns(now), allowed);
        other.step(loaded, at_ns(now), allowed);
        ASSERT_EQ(one.said, other.said);
        ASSERT_EQ(one.statements, other.statements);
        ASSERT_EQ(one.witness.done, other.witness.done);
        ASSERT_EQ(one.witness.calls, other.witness.calls);
        ASSERT_EQ(one.context.position.node, other.context.position.node);
        ASSERT_EQ(one.kept_data(), other.kept_data());
        if (one.said == ProgramReturn::waits) {
            ASSERT_EQ(one.context.position.acted, other.context.position.acted);
            ASSERT_EQ(one.context.position.entered_at, other.context.position.entered_at);
            ASSERT_EQ(compiled.wakes(*compiled.tables, one.context),
                      loaded.wakes(*loaded.tables, other.context));
        }
        for (ConditionIndex i = 0; i < condition_count; ++i)
            ASSERT_EQ(compiled.test(*compiled.tables, one.context, i),
                      loaded.test(*loaded.tables, other.context, i))
                << "condition " << i;
        coverage.returns.insert(static_cast<int>(one.said));
        coverage.nodes.insert(one.context.position.node);
        if (one.said == ProgramReturn::ended || one.said == ProgramReturn::failed) {
            const auto start = static_cast<NodeIndex>(random(node_count));
            one.context.position = other.context.position = {.node = start};
        }
    }
}

template <std::uint64_t seed> inline constexpr Rows rows = random_rows(seed);
template <std::uint64_t seed> inline constexpr ProgramTables tables = rows<seed>.view();

TEST(Native, code_equals_the_interpreter_step_by_step) {
    Coverage coverage;
    const auto both_ways = [&coverage]<std::uint64_t seed>() {
        for (std::uint64_t run = 0; run < 200; ++run)
            expect_same(native_code<tables<seed>>, interpreted(tables<seed>), seed * 1000 + run, coverage);
    };
    [&]<std::size_t... i>(std::index_sequence<i...>) {
        (both_ways.template operator()<i + 1>(), ...);
    }(std::make_index_sequence<10>{});
    EXPECT_EQ(coverage.returns.size(), 4u) << "a program ended, waited, was left over and failed";
    EXPECT_GT(coverage.nodes.size(), node_count / 2);
}

} // namespace
} // namespace tappet
