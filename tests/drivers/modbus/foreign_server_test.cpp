// The client and its transport against a foreign device (pymodbus), by TCP on loopback and by RTU on a pair
// of terminals (socat): reading, writing, exceptions, and an outage of the whole process.
#include "drivers/modbus/libmodbus_transport.hpp"
#include "drivers/modbus/session.hpp"
#include "kernel/os/clock.hpp"
#include "tests/drivers/foreign.hpp"
#include "tests/drivers/loopback.hpp"

#include <gtest/gtest.h>

#include <memory>

namespace tappet::modbus {
namespace {

constexpr auto map = register_map(
    read("inputs", input_registers(10, 3), every(20ms), word("a", 0), word("b", 2)),
    read("contacts", discrete_inputs(4, 4), every(20ms), bit("even", 0), bit("odd", 1)),
    read("echo", holding_registers(20, 2), every(20ms), double_word("both", 0).as_signed()),
    write("setpoint", holding_registers(20, 2), every(1s), stale_after(10s),
          double_word("both", 0).as_signed().safe(-2)),
    read("orders", input_registers(40, 16), every(20ms), double_word("abcd", 0).as_signed(),
         float_word("abcd_real", 2), double_word("cdab", 4).as_signed().swapped(),
         float_word("cdab_real", 6).swapped(), double_word("badc", 8).as_signed().bytes_swapped(),
         float_word("badc_real", 10).bytes_swapped(),
         double_word("dcba", 12).as_signed().swapped().bytes_swapped(),
         float_word("dcba_real", 14).swapped().bytes_swapped()),
    read("nowhere", holding_registers(5000, 1), every(100ms), word("w", 0)));
static_assert(map.fault.empty());

Time now() { return os::Clock::monotonic(); }

class ForeignDevice : public testing::TestWithParam<const char*> {
protected:
    ForeignDevice() {
        TransportSettings settings{.unit = 1, .answer_within = 400ms};
        if (std::string{GetParam()} == "tcp") {
            where = std::to_string(free_port(SOCK_STREAM));
            settings.line = Tcp{"127.0.0.1", static_cast<std::uint16_t>(std::stoi(where))};
        } else {
            const std::string base = testing::TempDir() + "modbus_line." + std::to_string(::getpid());
            where = base + ".server";
            ours = base + ".client";
            socat = std::make_unique<Foreign>("socat pty,raw,echo=0,link=" + where +
                                              " pty,raw,echo=0,link=" + ours);
            for (int i = 0; i < 300 && ::access(ours.c_str(), F_OK) != 0; ++i)
                std::this_thread::sleep_for(10ms);
            settings.line = Serial{ours, 19200, 'N', 1}; // a pseudo terminal has no parity
        }
        const auto opened = transport.open(settings);
        EXPECT_TRUE(opened) << (opened ? "" : opened.error().view());
        start();
    }
    void start() {
        // The distribution's interpreter: only it has pymodbus.
        server = std::make_unique<Foreign>(
            std::string{"/usr/bin/python3 -W ignore " TAPPET_FOREIGN_SERVER " "} + GetParam() + " " + where);
        ASSERT_TRUE(server->says("ready"))
            << server->output() << "is python3-pymodbus installed? ci/setup does it";
    }
    template <class Until> bool run_until(Until until) {
        for (const Time end = now() + 15s; now() < end;) {
            const Duration rest = session.step(now()) - now();
            if (until()) return true;
            if (rest > 0ns) std::this_thread::sleep_for(std::min<Duration>(rest, 5ms));
        }
        return false;
    }
    [[nodiscard]] Value value(std::string_view path) const { return session.value(map.value(path)); }

    std::string where, ours;
    std::unique_ptr<Foreign> socat, server;
    LibmodbusTransport transport;
    Session<6, 15> session{map, transport, {.first = 50ms, .most = 200ms}};
};

TEST_P(ForeignDevice, is_read_written_and_recovered_after_an_outage) {
    ASSERT_TRUE(run_until([&] {
        return value("inputs.b").quality == Quality::good && value("contacts.odd").quality == Quality::good;
    })) << server->output();
    EXPECT_EQ(value("inputs.a").value, 1010);
    EXPECT_EQ(value("inputs.b").value, 1012);
    EXPECT_EQ(value("contacts.even").value, 0);
    EXPECT_EQ(value("contacts.odd").value, 1);
    ASSERT_TRUE(run_until([&] { return value("orders.abcd").quality == Quality::good; }));
    for (const std::string order : {"abcd", "cdab", "badc", "dcba"}) {
        EXPECT_EQ(value("orders." + order).value, -305419896) << order;
        EXPECT_EQ(value("orders." + order + "_real").value, -12.625) << order;
    }
    ASSERT_TRUE(run_until([&] { return value("nowhere.w").quality == Quality::exception; }));
    EXPECT_EQ(value("nowhere.w").exception, 2) << "illegal data address";

    ASSERT_TRUE(session.set(map.value("setpoint.both"), -123456, now()));
    EXPECT_TRUE(run_until([&] { return value("echo.both").value == -123456; }));

    server.reset();
    EXPECT_TRUE(run_until([&] { return session.outage(); }));
    const Time last = value("inputs.a").stamp;
    start();
    EXPECT_TRUE(run_until([&] { return value("inputs.a").stamp > last; }));
    EXPECT_EQ(session.counters().outages_survived, session.counters().outages);
    EXPECT_TRUE(run_until([&] { return value("echo.both").value == -123456; }))
        << "repeated to a device that forgot it";
}

INSTANTIATE_TEST_SUITE_P(Modbus, ForeignDevice, testing::Values("tcp", "rtu"),
                         [](const auto& param) { return param.param; });

} // namespace
} // namespace tappet::modbus
