// The check of a whole table, on mutated copies of two machines: the small one of the golden tests, and the
// carpet loom.
#include "apps/carpet_loom/bindings.hpp"
#include "apps/carpet_loom/machine.hpp"
#include "board/bench/board.hpp"
#include "tests/diagnostics/mutations.hpp"
#include "tests/diagnostics/small_machine.hpp"

#include <string>
#include <vector>

#include <gmock/gmock.h>

namespace {

using namespace tappet;
using testing::UnorderedElementsAreArray;

constexpr auto small_loom =
    small::loom(small::good_components, small::good_activities, small::good_connections,
                small::good_reactions, small::good_behaviours);

diagnostics::Tally mutate(const MachineView& table, const Board& board, const Binding& binding) {
    const diagnostics::Tally tally = diagnostics::Mutations{table, board, binding}.run();
    std::cout << table.name << ": " << tally << '\n';
    return tally;
}

TEST(Check, accepts_the_unmutated_machines) {
    EXPECT_EQ(diagnostics::refusal_of(small_loom.view(), small::good_board, small::good_binding), "");
    EXPECT_EQ(diagnostics::refusal_of(carpet::table.view(), board::bench, carpet::bindings::bench), "");
}

TEST(Check, refuses_every_mutation_of_the_small_machine_and_names_its_row) {
    const diagnostics::Tally tally = mutate(small_loom.view(), small::good_board, small::good_binding);
    EXPECT_GT(tally.all(), 1000u);
    for (const auto& each : tally.wrong) ADD_FAILURE() << each;
}

TEST(Check, refuses_every_mutation_of_the_carpet_loom_and_names_its_row) {
    const diagnostics::Tally tally = mutate(carpet::table.view(), board::bench, carpet::bindings::bench);
    EXPECT_GT(tally.all(), 5000u);
    for (const auto& each : tally.wrong) ADD_FAILURE() << each;
}

TEST(Check, requires_every_row_of_the_carpet_loom) {
    EXPECT_THAT(mutate(carpet::table.view(), board::bench, carpet::bindings::bench).may_be_dropped,
                testing::IsEmpty());
}

TEST(Check, requires_all_rows_of_the_small_machine_but_these) {
    EXPECT_THAT(mutate(small_loom.view(), small::good_board, small::good_binding).may_be_dropped,
                UnorderedElementsAreArray<std::string>({
                    R"(connection "weft.reference" -> "shaft.reference")", // the input is optional
                    // None of these operations is required.
                    R"(reaction "shaft.window" -> "tension.pre_tension")",
                    R"(reaction "weft.inserted" -> "lamps.green")",
                    R"(reaction "weft.broken" -> "shaft.clear")",
                    R"(reaction "weft.broken" -> "tension.relax")",
                }));
}

// Faults that depend only on the sizes of a table, so that no single row can contain them.

TEST(Check, refuses_a_memory_size_that_overflows_its_sum) {
    Board board = small::good_board;
    board.heap_bytes = ~std::size_t{0};
    EXPECT_THAT(diagnostics::refusal_of(small_loom.view(), board, small::good_binding),
                testing::StartsWith("loom: board \"bench\": the machine takes 18446744073709551615 bytes"));
}

TEST(Check, refuses_more_buffers_than_a_port_has_room_for) {
    std::vector<ComponentRow> components{component<small::Shaft>("shaft")};
    std::vector<std::string> names;
    for (std::size_t i = 0; i <= max_buffer_rows; ++i) names.push_back("encoder_" + std::to_string(i));
    std::vector<std::string> paths;
    for (const auto& name : names) paths.push_back(name + ".samples");
    for (const auto& name : names) components.push_back(component<small::Encoder>(name, device(name)));
    std::vector<ActivityRow> activities{activity("all", every(1ms), budget(1us), runs("shaft"))};
    for (const auto& name : names) ASSERT_TRUE(activities[0].runs.push(name));
    std::vector<ConnectionRow> connections;
    for (const auto& path : paths) connections.push_back(buffer<4>(path, "shaft.samples"));
    const MachineView table{"many", components, activities, connections, {}, {}};
    EXPECT_EQ(diagnostics::refusal_of(table, small::good_board),
              "many: connection \"encoder_8.samples\" -> \"shaft.samples\" exceeds the 8 buffer rows that a "
              "port may have; merge some");
}

TEST(Check, names_the_whole_path_of_a_data_flow_cycle) {
    const std::vector<ComponentRow> components{component<small::Shaft>("a"), component<small::Shaft>("b"),
                                               component<small::Shaft>("c"), component<small::Shaft>("led"),
                                               component<small::Shaft>("leading")};
    const std::vector<ActivityRow> activities{
        activity("all", every(1ms), budget(1us), runs("led", "c", "b", "a", "leading"))};
    const std::vector<ConnectionRow> connections{
        data("leading.speed", "a.reference"), data("a.speed", "b.measured"),
        data("b.speed", "c.measured"),        data("c.speed", "a.measured"),
        data("c.speed", "led.measured"),      data("led.speed", "leading.measured", delayed)};
    const MachineView table{"ring", components, activities, connections, {}, {}};
    EXPECT_EQ(
        diagnostics::refusal_of(table, small::good_board),
        "ring: connection \"c.speed\" -> \"a.measured\" closes a data-flow cycle inside activity \"all\" "
        "(a -> b -> c -> a); add delayed to the row whose reader may use the last cycle's value");
}

TEST(Check, orders_the_components_of_an_activity_by_data_flow) {
    const std::vector<ComponentRow> components{component<small::Tension>("last"),
                                               component<small::Shaft>("middle"),
                                               component<small::Shaft>("first")};
    const std::vector<ActivityRow> activities{
        activity("all", every(1ms), budget(1us), runs("last", "middle", "first"))};
    const std::vector<ConnectionRow> connections{data("middle.speed", "last.speed"),
                                                 data("first.speed", "middle.measured"),
                                                 data("last.torque", "first.measured", delayed)};
    const std::vector<ReactionRow> reactions{};
    TableIndex<3, 1, 3, 0> index;
    const MachineView table{"row", components, activities, connections, reactions, {}};
    ASSERT_EQ(checks::check_components(table, index.view()).view(), "");
    ASSERT_EQ(checks::check_activities(table, index.view()).view(), "");
    ASSERT_EQ(checks::check_connections(table, index.view()).view(), "");
    ASSERT_EQ(checks::order_components(table, index.view()).view(), "");
    // last, middle, first; the delayed row lets its reader run first.
    EXPECT_THAT(index.kept.position, testing::ElementsAre(2, 1, 0));
    EXPECT_THAT(index.in_order, testing::ElementsAre(2, 1, 0));
}

} // namespace
