// Values that the bus did not send as they were written: by signal, and all together.
#include "tests/drivers/components/can_machine.hpp"

#include <limits>
#include <string>
#include <vector>

namespace tappet::test {
namespace {

using CanUnsent = CanMachine;

TEST_F(CanUnsent, counts_by_signal_what_it_did_not_send_as_it_was_written) {
    const auto seen = [this] {
        std::vector<std::string> rows;
        instance.each_unsent([&](std::string_view component, const Facet& row, const Unsent& each) {
            rows.push_back(std::string{component} + "." + std::string{row.name} +
                           (each.clamped != 0 ? " clamped" : "") + (each.no_number != 0 ? " no number" : ""));
        });
        return rows;
    };
    run_until(20ms);
    EXPECT_TRUE(seen().empty());
    master->rpm = 1e9;
    run_until(40ms);
    EXPECT_EQ(seen(), std::vector<std::string>{"can.drive_command.velocity clamped"});
    master->rpm = std::numeric_limits<double>::quiet_NaN();
    run_until(60ms);
    EXPECT_EQ(seen(), std::vector<std::string>{"can.drive_command.velocity clamped no number"});
}

TEST_F(CanUnsent, counts_a_clamped_value_only_when_it_was_sent) {
    const auto of = [this](std::string_view input) {
        Unsent found;
        instance.each_unsent([&](std::string_view, const Facet& row, const Unsent& each) {
            if (row.name == input) found = each;
        });
        return found;
    };
    run_until(20ms);
    master->word = 100'000; // 16 bits
    master->rpm = std::numeric_limits<double>::quiet_NaN();
    run_until(40ms);
    EXPECT_LE(heard_of(0x201).back().stamp, Time{22ms});
    EXPECT_EQ(of("drive_command.controlword").clamped, 0u) << "its frame was held back by the other signal";
    EXPECT_GT(of("drive_command.velocity").no_number, 0u);
    const std::size_t sent = heard_of(0x201).size();
    master->rpm = 50;
    run_until(61ms);
    EXPECT_EQ(of("drive_command.controlword").clamped, heard_of(0x201).size() - sent) << "in each frame";
}

TEST_F(CanUnsent, counts_values_out_of_range_since_the_machines_start) {
    run_until(20ms);
    master->rpm = 1e9;
    run_until(40ms);
    master->rpm = 50;
    run_until(60ms);
    const std::int64_t before = bus->out_of_range.last();
    EXPECT_GT(before, 0);
    change(0, LifeChange::stop);
    change(0, LifeChange::start);
    EXPECT_EQ(bus->out_of_range.last(), before);
    run(20ms);
    EXPECT_EQ(bus->out_of_range.last(), before);
}

} // namespace
} // namespace tappet::test
