// Watching without disturbing: each shown value is whole and of one moment, or marked busy (thesis 4.8).
#include "toolchain/tools/browser/observer.hpp"

#include "tests/toolchain/tools/browser/sample_machine.hpp"
#include "toolchain/tools/browser/reading_text.hpp"
#include "toolchain/tools/browser/session.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <thread>

namespace tappet::browser {
namespace {

using namespace std::chrono_literals;

class Watching : public testing::Test {
protected:
    void SetUp() override {
        auto opened = Session::open(machine.socket(), 2s);
        ASSERT_TRUE(opened.has_value()) << opened.error().sentence;
        session = std::move(*opened);
    }
    std::uint32_t facet(std::string_view name) { return session->map().find(name)->index; }
    std::string shown(std::string_view name) {
        return line_of(session->map(), session->observer().read(facet(name)));
    }
    SampleMachine machine;
    std::unique_ptr<Session> session;
};

TEST_F(Watching, a_value_that_was_written_is_seen_without_a_request) {
    const std::size_t asked = machine.requests().size();
    EXPECT_EQ(shown("shaft.angle"), "shaft.angle = 0 deg   never written");
    machine.write("shaft.angle", 12.5);
    EXPECT_EQ(shown("shaft.angle"), "shaft.angle = 12.5 deg");
    EXPECT_EQ(machine.requests().size(), asked);
}

TEST_F(Watching, a_forced_value_is_shown_and_marked) {
    machine.write("shaft.angle", 12.5);
    machine.force("shaft.angle", true, 90.0);
    EXPECT_EQ(shown("shaft.angle"), "shaft.angle = 90 deg   FORCED");
    EXPECT_EQ(session->observer().forced(), 1u);
    machine.force("shaft.angle", false, 90.0);
    EXPECT_EQ(shown("shaft.angle"), "shaft.angle = 12.5 deg");
}

TEST_F(Watching, an_old_value_is_marked_stale_where_its_row_has_a_limit) {
    machine.write("loom.angle", 12.5, 1'000'000);
    machine.set_now("loom.angle", 5'000'000);
    EXPECT_EQ(shown("loom.angle"), "loom.angle = 12.5 deg");
    machine.set_now("loom.angle", 5'000'001);
    EXPECT_EQ(shown("loom.angle"), "loom.angle = 12.5 deg   stale");
}

TEST_F(Watching, the_device_value_is_shown_when_the_read_value_differs) {
    machine.write("loom.angle", 12.5, 1'000'000);
    EXPECT_EQ(shown("loom.angle"), "loom.angle = 12.5 deg") << "the device gave nothing yet";
    machine.write("shaft.angle", 12.5, 1'000'000);
    EXPECT_EQ(shown("loom.angle"), "loom.angle = 12.5 deg");
    machine.write("shaft.angle", 14.0, 3'000'000);
    EXPECT_EQ(shown("loom.angle"), "loom.angle = 12.5 deg   wire 14 deg, 2ms newer");
    machine.force("loom.angle", true, 90.0);
    EXPECT_EQ(shown("loom.angle"), "loom.angle = 90 deg   FORCED, wire 14 deg, 2ms newer");
    EXPECT_EQ(shown("shaft.angle"), "shaft.angle = 14 deg") << "nobody feeds it but its own device";
}

TEST_F(Watching, an_input_that_its_component_never_read_is_not_called_never_written) {
    EXPECT_EQ(shown("loom.angle"), "loom.angle = 0 deg   never written");
    machine.write("shaft.angle", 14.0, 3'000'000);
    EXPECT_EQ(shown("loom.angle"), "loom.angle = 0 deg   unread, wire 14 deg");
    EXPECT_EQ(flow_of(session->map(), session->observer().read(facet("loom.angle"))), "unread");
}

TEST_F(Watching, a_value_forced_at_the_device_is_not_shown_as_the_wire) {
    machine.write("loom.angle", 12.5, 1'000'000);
    machine.write("shaft.angle", 14.0, 3'000'000);
    machine.force("shaft.angle", true, 90.0);
    EXPECT_EQ(shown("loom.angle"), "loom.angle = 12.5 deg");
}

TEST_F(Watching, an_activity_in_its_cycle_makes_a_value_busy_never_torn) {
    machine.hold("shaft.angle", true);
    const Reading reading = session->observer().read(facet("shaft.angle"));
    EXPECT_TRUE(reading.busy);
    EXPECT_TRUE(reading.value.empty());
    EXPECT_FALSE(session->observer().read(facet("loom.lamp")).busy);
    machine.hold("shaft.angle", false);
    EXPECT_FALSE(session->observer().read(facet("shaft.angle")).busy);
}

TEST_F(Watching, while_the_machine_writes_all_the_time_nothing_is_torn) {
    std::atomic<bool> ending{false};
    std::thread writer{[&] {
        for (std::uint64_t n = 0; !ending; ++n) {
            const std::uint64_t pattern = n % 256 * 0x0101010101010101u;
            machine.write("shaft.angle", pattern);
            std::this_thread::sleep_for(1us);
        }
    }};
    int whole = 0;
    for (int i = 0; i < 20'000; ++i) {
        const Reading reading = session->observer().read(facet("shaft.angle"));
        if (reading.busy) continue;
        ++whole;
        ASSERT_EQ(reading.value.size(), 8u);
        for (const std::byte each : reading.value) ASSERT_EQ(each, reading.value[0]);
    }
    ending = true;
    writer.join();
    EXPECT_GT(whole, 0);
}

TEST_F(Watching, values_of_one_activity_are_of_one_moment) {
    const std::vector<std::uint32_t> both{facet("shaft.gains.p"), facet("loom.lamp"), facet("shaft.gains.i")};
    const auto readings = session->observer().read(both);
    ASSERT_EQ(readings.size(), 3u);
    for (std::size_t i = 0; i < both.size(); ++i) EXPECT_EQ(readings[i].facet, both[i]);
}

} // namespace
} // namespace tappet::browser
