// Modbus RTU on a pair of pseudo-terminals (socat), between a firmware and foreign programs: pymodbus serves,
// mbpoll reads. tappet-browse shows the machine's view of the device.
#include "tests/bench/processes.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <optional>
#include <random>
#include <thread>

namespace tappet::bench {
namespace {

using testing::HasSubstr;

constexpr const char* ours = "/dev/line"; // as the bench's board has it
constexpr const char* theirs = "/dev/peer";
constexpr const char* summary_file = "/tmp/summary.json";
constexpr auto patience = 20s; // the client's pauses grow to 2 s, and the emulator is slow

const Browser browser{"modbus-line"};

std::string shown(const std::string& name) { return browser.run({"get", name}).text; }
bool shows(const std::string& name, const std::string& text) {
    return soon([&] { return shown(name).find(text) != std::string::npos; }, patience, 50ms);
}
bool is(const std::string& name, double value) {
    return soon([&] { return browser.value_of(name) == value; }, patience, 50ms);
}

/// One line for all cases; each continues where the previous one ended.
class ModbusLine : public testing::Test {
protected:
    static void SetUpTestSuite() {
        wires.emplace(std::string{"socat pty,raw,echo=0,link="} + theirs + " pty,raw,echo=0,link=" + ours);
        soon([] { return ::access(ours, F_OK) == 0 && ::access(theirs, F_OK) == 0; });
        device.emplace(std::string{"python3 -W ignore /bin/foreign_server.py rtu "} + theirs);
        is_ready = soon([] { return device->output().find("ready") != std::string::npos; }, 60s, 50ms);
        start();
    }
    static void TearDownTestSuite() {
        machine.reset();
        device.reset();
        wires.reset();
    }
    static void start() {
        machine.emplace(std::string{"modbus-line --summary "} + summary_file);
        is_ready = machine->says("armed on board \"bench\"") && is_ready;
    }
    void SetUp() override { ASSERT_TRUE(is_ready) << device->output() << machine->output(); }

    static inline std::optional<Foreign> wires, device, machine;
    static inline bool is_ready = false;
};

void expect_every_order() {
    for (const std::string order : {"abcd", "cdab", "badc", "dcba"}) {
        EXPECT_EQ(browser.value_of("unit.orders." + order), -305419896) << order;
        EXPECT_EQ(browser.value_of("unit.orders." + order + "_real"), -12.625) << order;
    }
}

TEST_F(ModbusLine, reads_values_in_each_byte_order) {
    EXPECT_TRUE(is("unit.orders.dcba_real", -12.625)) << shown("unit.reason");
    expect_every_order();
    EXPECT_EQ(browser.value_of("unit.tank.level"), 1010);
}

TEST_F(ModbusLine, writes_the_values_of_the_machine_to_the_device) {
    EXPECT_TRUE(is("unit.kept.flow", -123456));
    EXPECT_TRUE(shows("pump.runs", "true"));
}

TEST_F(ModbusLine, names_a_refused_row_and_continues_with_the_others) {
    EXPECT_TRUE(
        shows("unit.reason", "nowhere\\\": the server refuses it, exception 2 (illegal data address)"))
        << shown("unit.reason");
    EXPECT_THAT(shown("unit.connected"), HasSubstr("true"));
    EXPECT_EQ(browser.value_of("unit.outages"), 0);
}

TEST_F(ModbusLine, waits_while_the_device_is_silent_and_resumes_when_it_is_back) {
    device->signal(SIGSTOP);
    EXPECT_TRUE(shows("pump.runs", "false"));
    EXPECT_TRUE(shows("unit.reason", "no answer in time")) << shown("unit.reason");
    EXPECT_EQ(browser.value_of("unit.outages"), 1);
    EXPECT_EQ(browser.run({"set", "pump.wanted", "4711"}).code, 0);
    device->signal(SIGCONT); // it answers the waiting requests at once
    EXPECT_TRUE(shows("pump.runs", "true")) << shown("unit.reason");
    EXPECT_TRUE(is("unit.kept.flow", 4711)) << shown("unit.reason");
    EXPECT_EQ(browser.value_of("unit.outages_survived"), browser.value_of("unit.outages"));
    expect_every_order();
}

TEST_F(ModbusLine, accepts_no_value_from_a_disturbed_line_and_recovers) {
    const double before = browser.value_of("unit.outages");
    const int line = ::open(theirs, O_WRONLY | O_NOCTTY);
    ASSERT_GE(line, 0);
    {
        // All the time: bytes between two requests are drained and disturb nothing.
        const std::jthread disturber{[line](const std::stop_token& end) {
            std::mt19937 any{1};
            while (!end.stop_requested()) {
                std::array<std::uint8_t, 7> bytes{};
                for (std::uint8_t& byte : bytes) byte = static_cast<std::uint8_t>(any());
                EXPECT_EQ(::write(line, bytes.data(), bytes.size()), static_cast<ssize_t>(bytes.size()));
                std::this_thread::sleep_for(5ms);
            }
        }};
        EXPECT_TRUE(shows("unit.reason", "does not match the request")) << shown("unit.reason");
    }
    ::close(line);
    EXPECT_TRUE(shows("unit.reason", "the server refuses it")) << shown("unit.reason");
    EXPECT_TRUE(shows("pump.runs", "true"));
    EXPECT_GT(browser.value_of("unit.outages"), before);
    EXPECT_EQ(browser.value_of("unit.outages_survived"), browser.value_of("unit.outages"));
    EXPECT_EQ(browser.value_of("unit.tank.level"), 1010);
    expect_every_order();
}

TEST_F(ModbusLine, reports_the_outages_in_its_summary_without_deadline_misses) {
    machine->signal(SIGTERM);
    EXPECT_EQ(machine->wait(), 0) << machine->output();
    const std::string summary = content_of(summary_file);
    EXPECT_GE(number_in(summary, "unit.outages"), 2);
    EXPECT_EQ(number_in(summary, "unit.outages_survived"), number_in(summary, "unit.outages"));
    EXPECT_EQ(number_in(summary, "deadline_misses"), 0);
    EXPECT_EQ(number_in(summary, "heap_allocations_after_arming"), 0);
}

/// The device's registers as a second foreign program reads them: words in its own order.
std::string seen_by_mbpoll() {
    Foreign looks{std::string{"mbpoll -1 -m rtu -b 19200 -P none -a 1 -t 4:int -0 -r 20 -c 1 "} + ours};
    static_cast<void>(looks.wait());
    return looks.output();
}

TEST_F(ModbusLine, writes_the_safe_values_of_its_map_to_the_device) {
    EXPECT_THAT(seen_by_mbpoll(), HasSubstr("[20]: \t-2"));
}

TEST_F(ModbusLine, becomes_safe_over_the_same_line_when_the_machine_is_killed) {
    start();
    ASSERT_TRUE(is_ready) << machine->output();
    ASSERT_TRUE(is("unit.kept.flow", -123456));
    const pid_t process = machine_of(*machine);
    ASSERT_GT(process, 0);
    ::kill(process, SIGKILL);
    EXPECT_NE(machine->wait(), 0);
    EXPECT_THAT(seen_by_mbpoll(), HasSubstr("[20]: \t-2"));
}

} // namespace
} // namespace tappet::bench
