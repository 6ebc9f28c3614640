// The real transport on loopback and on a pair of terminals, against a server of bytes that can answer
// wrongly.
#include "drivers/modbus/libmodbus_transport.hpp"

#include "drivers/modbus/session.hpp"
#include "kernel/os/clock.hpp"
#include "tests/drivers/modbus/raw_server.hpp"

#include <gtest/gtest.h>

#include <array>
#include <dirent.h>
#include <linux/filter.h>
#include <string>
#include <thread>

namespace tappet::modbus {
namespace {

/// For an answer that comes: no host is so busy.
constexpr Duration patience = 30s;

/// A server and its client. On a serial line, the name is the server's.
struct Asked {
    explicit Asked(RawServer::Line line, Duration answer_within = patience,
                   Serial setting = {{}, 115200, 'N', 1})
        : server{line} {
        TransportSettings settings{.unit = 17, .answer_within = answer_within};
        setting.device = server.terminal();
        if (line == RawServer::Line::tcp)
            settings.line = Tcp{"127.0.0.1", server.port()};
        else
            settings.line = setting;
        const auto opened = transport.open(settings);
        EXPECT_TRUE(opened) << (opened ? "" : opened.error().view());
        EXPECT_EQ(transport.connect().outcome, Outcome::ok);
    }
    Answer read(std::uint16_t address = 7) {
        return transport.read(Table::holding_registers, address, words);
    }
    void come_back() {
        if (transport.recover()) return;
        ASSERT_EQ(transport.connect().outcome, Outcome::ok);
    }
    RawServer server;
    LibmodbusTransport transport;
    std::array<std::uint16_t, 3> words{};
};

struct Wire : testing::TestWithParam<RawServer::Line>, Asked {
    explicit Wire(Duration answer_within = patience) : Asked{GetParam(), answer_within} {}
};

/// For answers that never come in time.
struct WireOfASilentServer : Wire {
    WireOfASilentServer() : Wire{100ms} {}
};

TEST_P(Wire, reads_and_writes_all_four_tables) {
    EXPECT_EQ(read().outcome, Outcome::ok);
    EXPECT_EQ(words, (std::array<std::uint16_t, 3>{1007, 1008, 1009}));
    EXPECT_EQ(transport.read(Table::input_registers, 0, words).outcome, Outcome::ok);
    EXPECT_EQ(words[0], 1000);
    for (const Table table : {Table::coils, Table::discrete_inputs}) {
        EXPECT_EQ(transport.read(table, 3, words).outcome, Outcome::ok);
        EXPECT_EQ(words, (std::array<std::uint16_t, 3>{1, 0, 1}));
    }
    words = {1, 0, 0xABCD};
    EXPECT_EQ(transport.write(Table::holding_registers, 7, words).outcome, Outcome::ok);
    const Bytes request = server.last_request();
    const std::size_t pdu = GetParam() == RawServer::Line::tcp ? 7 : 1;
    ASSERT_GT(request.size(), pdu + 11);
    EXPECT_EQ(request[pdu - 1], 17) << "the unit";
    EXPECT_EQ(Bytes(request.begin() + static_cast<std::ptrdiff_t>(pdu),
                    request.begin() + static_cast<std::ptrdiff_t>(pdu) + 12),
              (Bytes{16, 0, 7, 0, 3, 6, 0, 1, 0, 0, 0xAB, 0xCD}));
    EXPECT_EQ(transport.write(Table::coils, 7, words).outcome, Outcome::ok);
    EXPECT_EQ(server.last_request()[pdu], 15);
    EXPECT_EQ(server.last_request()[pdu + 6], 0b101);
}

TEST_P(Wire, returns_an_exception_as_a_value) {
    server.manner = Manner::exception;
    const Answer answer = read();
    EXPECT_EQ(answer.outcome, Outcome::exception);
    EXPECT_EQ(answer.exception, 6);
    server.manner = Manner::right;
    EXPECT_EQ(read().outcome, Outcome::ok) << "the connection still stands";
}

TEST_P(WireOfASilentServer, times_out_after_the_configured_time) {
    server.manner = Manner::silent;
    const Answer answer = read();
    EXPECT_EQ(answer.outcome, Outcome::timeout);
    EXPECT_GE(answer.took, 100ms);
}

TEST_P(WireOfASilentServer, times_out_when_the_rest_of_an_answer_is_missing) {
    server.manner = Manner::drip;
    EXPECT_NE(read().outcome, Outcome::ok);
}

TEST_P(WireOfASilentServer, times_out_when_an_answer_arrives_byte_by_byte) {
    server.manner = Manner::dribble;
    std::array<std::uint16_t, 120> many{}; // twelve seconds' worth of bytes, each within the time-out
    EXPECT_EQ(transport.read(Table::holding_registers, 0, many).outcome, Outcome::timeout);
}

TEST_P(WireOfASilentServer, never_mistakes_a_late_answer_for_the_next_one) {
    server.manner = Manner::late;
    EXPECT_EQ(read(7).outcome, Outcome::timeout);
    server.manner = Manner::right;
    server.let_go();
    Answer answer{.outcome = Outcome::timeout};
    while (answer.outcome == Outcome::timeout) { // a busy host may need more than the time-out
        come_back();
        answer = read(50);
    }
    EXPECT_EQ(answer.outcome, Outcome::ok);
    EXPECT_EQ(words[0], 1050);
}

TEST_P(WireOfASilentServer, never_accepts_a_late_answer_during_the_next_request) {
    for (const bool writes : {false, true}) {
        server.manner = Manner::late;
        EXPECT_EQ(read(7).outcome, Outcome::timeout);
        server.manner = Manner::right;
        std::thread late{[&] {
            std::this_thread::sleep_for(std::chrono::milliseconds{30});
            server.let_go();
        }};
        come_back();
        const std::array<std::uint16_t, 3> to{1, 2, 3};
        Answer answer = writes ? transport.write(Table::holding_registers, 50, to) : read(50);
        late.join();
        if (answer.outcome == Outcome::ok && !writes) {
            EXPECT_EQ(words[0], 1050);
        }
        // A busy host may need more than the time-out.
        for (; answer.outcome == Outcome::timeout; answer = read(50)) {
            come_back();
        }
        EXPECT_EQ(answer.outcome, Outcome::ok);
        EXPECT_EQ(read(60).outcome, Outcome::ok);
        EXPECT_EQ(words[0], 1060) << "nor is one left over for later";
    }
}

TEST_P(Wire, refuses_an_answer_that_is_too_short) {
    server.manner = Manner::short_answer;
    EXPECT_NE(read().outcome, Outcome::ok);
}

constexpr auto name_of = [](const auto& param) {
    return param.param == RawServer::Line::tcp ? "tcp" : "rtu";
};
const auto lines = testing::Values(RawServer::Line::tcp, RawServer::Line::serial);
INSTANTIATE_TEST_SUITE_P(Modbus, Wire, lines, name_of);
INSTANTIATE_TEST_SUITE_P(Modbus, WireOfASilentServer, lines, name_of);

TEST(ModbusTcp, refuses_the_answer_to_another_request) {
    Asked at{RawServer::Line::tcp};
    at.server.manner = Manner::wrong_transaction;
    EXPECT_EQ(at.read(0).outcome, Outcome::garbled);
    at.server.manner = Manner::close;
    EXPECT_FALSE(at.transport.recover());
    ASSERT_EQ(at.transport.connect().outcome, Outcome::ok);
    EXPECT_EQ(at.read(0).outcome, Outcome::disconnected);
}

constexpr Serial even{{}, 19200, 'E', 1};

TEST(ModbusRtu, refuses_an_answer_with_a_wrong_checksum) {
    Asked at{RawServer::Line::serial, 2s, even};
    for (const Manner wrong : {Manner::wrong_checksum, Manner::stray}) {
        at.server.manner = wrong;
        EXPECT_NE(at.read(0).outcome, Outcome::ok);
        at.server.manner = Manner::right;
        EXPECT_TRUE(at.transport.recover());
        EXPECT_EQ(at.read(9).outcome, Outcome::ok);
        EXPECT_EQ(at.words[0], 1009) << "what was garbled leaves nothing behind";
    }
}

/// The network loses the request, and works again after the client has given up.
TEST(ModbusTcp, never_sends_an_abandoned_request_again) {
    const auto [listener, port] = bound_to_loopback(SOCK_STREAM);
    ASSERT_EQ(::listen(listener, 1), 0);
    LibmodbusTransport transport;
    ASSERT_TRUE(transport.open({.line = Tcp{"127.0.0.1", port}, .answer_within = 50ms}));
    ASSERT_EQ(transport.connect().outcome, Outcome::ok);
    const int server = ::accept(listener, nullptr, nullptr);
    sock_filter drop{BPF_RET | BPF_K, 0, 0, 0};
    const sock_fprog all{1, &drop};
    ASSERT_EQ(::setsockopt(server, SOL_SOCKET, SO_ATTACH_FILTER, &all, sizeof all), 0);
    const std::array<std::uint16_t, 1> on{1};
    EXPECT_EQ(transport.write(Table::coils, 0, on).outcome, Outcome::timeout);
    EXPECT_FALSE(transport.recover());
    ASSERT_EQ(::setsockopt(server, SOL_SOCKET, SO_DETACH_FILTER, &drop, sizeof drop), 0);
    pollfd comes{server, POLLIN, 0};
    EXPECT_EQ(::poll(&comes, 1, 1500), 0) << "the kernel tries again after 0.2, 0.6 and 1.4 s";
    for (const int fd : {server, listener}) ::close(fd);
}

TEST(ModbusRtu, refuses_a_write_confirmed_for_another_address) {
    Asked at{RawServer::Line::serial, 2s, even};
    const std::array<std::uint16_t, 3> to{1, 0, 1};
    for (const Table table : {Table::coils, Table::holding_registers}) {
        at.server.manner = Manner::elsewhere;
        EXPECT_EQ(at.transport.write(table, 7, to).outcome, Outcome::garbled);
        at.server.manner = Manner::exception;
        EXPECT_EQ(at.transport.write(table, 7, to).exception, 6);
        at.server.manner = Manner::right;
        EXPECT_EQ(at.transport.write(table, 7, to).outcome, Outcome::ok);
    }
}

TEST(ModbusTcp, is_refused_without_a_listener) {
    std::uint16_t port = 0;
    {
        const RawServer gone{RawServer::Line::tcp};
        port = gone.port();
    }
    LibmodbusTransport transport;
    ASSERT_TRUE(transport.open({.line = Tcp{"127.0.0.1", port}, .answer_within = 100ms}));
    EXPECT_EQ(transport.connect().outcome, Outcome::refused);
    std::array<std::uint16_t, 1> words{};
    EXPECT_EQ(transport.read(Table::holding_registers, 0, words).outcome, Outcome::disconnected);
}

TEST(ModbusRtu, is_refused_on_a_missing_line) {
    LibmodbusTransport transport;
    ASSERT_TRUE(transport.open({.line = Serial{"/dev/ttyS_not_here"}}));
    EXPECT_EQ(transport.connect().outcome, Outcome::refused);
}

std::size_t open_descriptors() {
    std::size_t n = 0;
    DIR* directory = ::opendir("/proc/self/fd");
    while (::readdir(directory) != nullptr) ++n;
    ::closedir(directory);
    return n;
}

TEST(ModbusTcp, leaks_no_descriptor_over_many_outages) {
    Asked at{RawServer::Line::tcp};
    at.server.manner = Manner::close;
    const auto one_outage = [&] {
        at.transport.connect();
        at.read(0);
        at.transport.recover();
    };
    one_outage();
    const std::size_t before = open_descriptors();
    for (int i = 0; i < 20; ++i) one_outage();
    EXPECT_LE(open_descriptors(), before + 1) << "the server may hold one more for a moment";
}

std::string refusal(const TransportSettings& settings) {
    LibmodbusTransport transport;
    const auto opened = transport.open(settings);
    return opened ? "" : std::string{opened.error().view()};
}

TEST(ModbusSettings, refuse_names_instead_of_addresses) {
    EXPECT_EQ(
        refusal({.line = Tcp{"climate.local", 502}}),
        "Modbus server \"climate.local\", port 502: this is not a numeric IPv4 address and port; write it "
        "like \"192.168.0.7\" in the board");
    EXPECT_NE(refusal({.line = Tcp{"10.0.0.300", 502}}), "");
    EXPECT_NE(refusal({.line = Tcp{"10.0.0.3", 0}}), "");
    EXPECT_NE(refusal({.line = Tcp{"", 502}}), "");
}

TEST(ModbusSettings, refuse_impossible_units_lines_and_time_outs) {
    EXPECT_EQ(refusal({.line = Serial{"/dev/ttyS1"}, .unit = 248}),
              "Modbus unit 248 does not exist: choose 1 to 247 in the board");
    EXPECT_NE(refusal({.line = Tcp{"10.0.0.3", 502}, .unit = 0}), "");
    EXPECT_NE(refusal({.line = Serial{"/dev/ttyS1", 9600, 'X', 1}}), "");
    EXPECT_NE(refusal({.line = Serial{"", 9600, 'E', 1}}), "");
    EXPECT_NE(refusal({.line = Serial{"/dev/ttyS1", 9600, 'E', 3}}), "");
    EXPECT_NE(refusal({.line = Tcp{"10.0.0.3", 502}, .answer_within = 0ns}), "");
}

TEST(ModbusSessionOnTheWire, survives_an_outage_in_real_time) {
    static constexpr auto map =
        register_map(read("r", holding_registers(5, 2), every(20ms), word("a", 0), word("b", 1)));
    RawServer server{RawServer::Line::tcp};
    LibmodbusTransport transport;
    ASSERT_TRUE(transport.open({.line = Tcp{"127.0.0.1", server.port()}, .answer_within = 60ms}));
    Session<1, 2> session{map, transport, {.first = 20ms, .most = 100ms}};
    const auto run_until = [&](const auto& is_so) { // eventually it is, however busy the host
        while (!is_so()) {
            const Duration rest = session.step(os::Clock::monotonic()) - os::Clock::monotonic();
            if (rest > 0ns) std::this_thread::sleep_for(std::min<Duration>(rest, 10ms));
        }
    };
    run_until([&] { return session.value(1).quality == Quality::good; });
    EXPECT_EQ(session.value(1).value, 1006);
    server.manner = Manner::silent;
    const Time silent_from = os::Clock::monotonic();
    run_until([&] { return session.outage() && os::Clock::monotonic() - silent_from > 200ms; });
    const Time last = session.value(1).stamp;
    server.manner = Manner::right;
    run_until([&] { return session.value(1).stamp > last && !session.outage(); });
    EXPECT_EQ(session.value(1).value, 1006);
    EXPECT_GE(session.counters().outages_survived, 1u);
    EXPECT_EQ(session.counters().outages_survived, session.counters().outages);
}

} // namespace
} // namespace tappet::modbus
