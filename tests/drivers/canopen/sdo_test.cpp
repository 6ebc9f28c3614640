// SDO transfers between our client and our server, and each abort.
#include "apps/carpet_loom/nodes/drive.eds.hpp"
#include "drivers/canopen/sdo_client.hpp"
#include "drivers/canopen/simulated_node.hpp"
#include "tests/drivers/canopen/texts.eds.hpp"

#include <gtest/gtest.h>

#include <string>

namespace tappet::canopen {
namespace {

/// A client and a server with nothing between them.
struct Connection : testing::Test {
    Connection() { device.power_on(Time{}); }
    /// Carries frames until the transfer ends.
    SdoAbort carry() {
        for (int i = 0; i < 100; ++i) {
            if (client.next(request, now) && server.serve(request, device, answer)) client.take(answer);
            if (client.state() == SdoClient::State::done) return SdoAbort::none;
            if (client.state() == SdoClient::State::aborted) return client.why();
        }
        return SdoAbort::time_out;
    }
    SdoAbort read(Address at) {
        client.read(at);
        return carry();
    }
    SdoAbort write(Address at, const std::string& value) {
        client.write(at, {reinterpret_cast<const std::uint8_t*>(value.data()), value.size()});
        return carry();
    }
    /// Reads from a server that answers with these frames.
    void read_answered(Address at, const sdo::Payload& with) {
        client.read(at);
        next_answered(with);
    }
    void next_answered(const sdo::Payload& with) {
        ASSERT_TRUE(client.next(request, now));
        client.take(with);
    }
    /// The abort code of our server.
    SdoAbort served(const sdo::Payload& asked) {
        EXPECT_TRUE(server.serve(asked, device, answer));
        return sdo::abort_in(answer);
    }
    [[nodiscard]] std::string text() const { return {client.value().begin(), client.value().end()}; }

    SimulatedDevice<dictionary<files::texts_eds>> device{1};
    SdoClient client;
    SdoServer server;
    Time now{};
    sdo::Payload request{}, answer{}; ///< the last ones
};

TEST_F(Connection, transfers_data_of_every_length) {
    EXPECT_EQ(read(0x1000), SdoAbort::none);
    EXPECT_EQ(from_bytes(client.value()), 1u);
    EXPECT_EQ(read(0x2001), SdoAbort::none);
    EXPECT_EQ(from_bytes(client.value()), 0x1122334455667788u);
    EXPECT_EQ(read(0x2000), SdoAbort::none);
    EXPECT_EQ(text(), "a name that takes three segments");
    EXPECT_EQ(read(0x2003), SdoAbort::none);
    EXPECT_EQ(text(), "");
    for (std::size_t length = 1; length <= sdo::most_bytes; ++length) {
        const std::string value(length, static_cast<char>('a' + length % 26));
        ASSERT_EQ(write(0x2000, value), SdoAbort::none) << length;
        ASSERT_EQ(read(0x2000), SdoAbort::none) << length;
        ASSERT_EQ(text(), value);
    }
}

TEST_F(Connection, aborts_with_the_code_of_the_standard) {
    EXPECT_EQ(read(0x3000), SdoAbort::no_object);
    EXPECT_EQ(read({0x2000, 1}), SdoAbort::no_sub_index);
    EXPECT_EQ(read(0x2002), SdoAbort::write_only);
    EXPECT_EQ(write(0x1000, "abcd"), SdoAbort::read_only);
    EXPECT_EQ(write(0x2002, "ab"), SdoAbort::too_long);
    EXPECT_EQ(write(0x2001, "abc"), SdoAbort::too_short);
    EXPECT_EQ(write(0x2004, "\x06"), SdoAbort::too_high);
    EXPECT_EQ(write(0x2004, "\xFA"), SdoAbort::too_low);
    EXPECT_EQ(write(0x2004, "\xFB"), SdoAbort::none) << "-5";
    device.refuse(0x2004, SdoAbort::hardware);
    EXPECT_EQ(write(0x2004, "\x01"), SdoAbort::hardware);
    EXPECT_EQ(to_text(SdoAbort::hardware), "access failed due to a hardware error");
    EXPECT_EQ(to_text(SdoAbort{0x1234}), "a code of the device's maker");
}

TEST_F(Connection, refuses_more_data_than_its_buffer_holds) {
    EXPECT_EQ(read(0x2005), SdoAbort::none) << "our server gives what fits";
    // A foreign server announces a size beyond the buffer.
    read_answered(0x2005, sdo::with_address(0x41, 0x2005, 65));
    EXPECT_EQ(client.why(), SdoAbort::out_of_memory);
    ASSERT_TRUE(client.next(request, now)) << "and is told so";
    EXPECT_EQ(request, sdo::abort_frame(0x2005, SdoAbort::out_of_memory));
    // A server without an announced size sends without end.
    read_answered(0x2005, sdo::with_address(0x40, 0x2005));
    unsigned toggle = 0;
    for (int i = 0; i < 20 && client.state() == SdoClient::State::busy; ++i) {
        ASSERT_TRUE(client.next(request, now));
        EXPECT_EQ(request[0], 0x60 | toggle << 4);
        sdo::Payload segment{static_cast<std::uint8_t>(toggle << 4)};
        client.take(segment);
        toggle ^= 1u;
    }
    EXPECT_EQ(client.why(), SdoAbort::out_of_memory);
}

TEST_F(Connection, refuses_more_or_less_data_than_announced) {
    read_answered(0x2000, sdo::with_address(0x41, 0x2000, 8));
    next_answered({0x01, 'a', 'b', 'c', 'd', 'e', 'f', 'g'});
    EXPECT_EQ(client.state(), SdoClient::State::aborted);
    EXPECT_EQ(client.why(), SdoAbort::unknown_command);
    ASSERT_TRUE(server.serve(sdo::with_address(0x21, 0x2000, 0), device, answer));
    EXPECT_EQ(served({0x01, 'a', 'b', 'c', 'd', 'e', 'f', 'g'}), SdoAbort::wrong_length);
}

TEST_F(Connection, aborts_on_empty_segments) {
    read_answered(0x2000, sdo::with_address(0x40, 0x2000));
    next_answered({0x0E});
    EXPECT_EQ(client.state(), SdoClient::State::aborted);
}

TEST_F(Connection, reports_a_reason_when_the_server_gives_none) {
    read_answered(0x2000, sdo::abort_frame(0x2000, SdoAbort::none));
    EXPECT_EQ(client.state(), SdoClient::State::aborted);
    EXPECT_EQ(client.why(), SdoAbort::general);
}

TEST_F(Connection, detects_a_missing_answer_a_wrong_toggle_and_a_foreign_answer) {
    client.read(0x1000);
    ASSERT_TRUE(client.next(request, now));
    client.tick(now + 100ms);
    EXPECT_EQ(client.state(), SdoClient::State::busy);
    client.tick(now + 101ms);
    EXPECT_EQ(client.why(), SdoAbort::time_out);
    client.take(sdo::with_address(0x43, 0x1000, 1));
    EXPECT_EQ(client.state(), SdoClient::State::aborted) << "too late";

    read_answered(0x2000, sdo::with_address(0x41, 0x2000, 10));
    next_answered({0x10});
    EXPECT_EQ(client.why(), SdoAbort::toggle_bit);

    read_answered(0x2000, sdo::with_address(0x43, 0x1000, 1));
    EXPECT_EQ(client.state(), SdoClient::State::busy) << "an answer for another object is none";
    client.take(sdo::with_address(0xE0, 0x2000));
    EXPECT_EQ(client.why(), SdoAbort::unknown_command);
}

TEST_F(Connection, ignores_a_late_confirmation_of_an_earlier_transfer) {
    const std::string one{"\x01"}, long_one{"more than four bytes"};
    const auto begin_write = [&](const std::string& value) {
        client.write(0x2000, std::span{reinterpret_cast<const std::uint8_t*>(value.data()), value.size()});
        ASSERT_TRUE(client.next(request, now));
    };
    const sdo::Payload written = sdo::with_address(0x60, 0x2000), read = sdo::with_address(0x43, 0x2000, 7);
    begin_write(long_one);
    client.take(written);
    ASSERT_TRUE(client.next(request, now));
    client.take(written); // a confirmation of the previous, abandoned attempt
    EXPECT_EQ(client.state(), SdoClient::State::busy);
    client.take({0x20});
    EXPECT_EQ(client.state(), SdoClient::State::busy) << "the next segment";

    read_answered(0x2000, written);
    EXPECT_EQ(client.state(), SdoClient::State::busy);
    client.take(read);
    EXPECT_EQ(client.state(), SdoClient::State::done);

    begin_write(one);
    client.take(read);
    EXPECT_EQ(client.state(), SdoClient::State::busy);
    client.take(written);
    EXPECT_EQ(client.state(), SdoClient::State::done);
}

TEST_F(Connection, first_reports_a_time_out_to_the_server) {
    client.read(0x2000);
    ASSERT_TRUE(client.next(request, now));
    client.tick(now + 101ms);
    EXPECT_TRUE(client.has_abort_to_send());
    ASSERT_TRUE(client.next(request, now));
    EXPECT_EQ(request, sdo::abort_frame(0x2000, SdoAbort::time_out));
    EXPECT_FALSE(client.has_abort_to_send());
}

TEST_F(Connection, refuses_segments_out_of_order_on_the_server_side) {
    EXPECT_EQ(served({0x60}), SdoAbort::unknown_command);
    EXPECT_EQ(served({0x00}), SdoAbort::unknown_command);
    EXPECT_EQ(served(sdo::with_address(0xA0, 0x2000)), SdoAbort::unknown_command) << "block transfer";
    ASSERT_TRUE(server.serve(sdo::with_address(0x21, 0x2000, 3), device, answer));
    EXPECT_EQ(answer[0], 0x60);
    EXPECT_EQ(served({0x10}), SdoAbort::toggle_bit);
    ASSERT_TRUE(server.serve(sdo::with_address(0x21, 0x2000, 3), device, answer));
    EXPECT_EQ(served({0x01, 'a', 'b', 'c', 'd', 'e', 'f', 'g'}), SdoAbort::wrong_length);
    EXPECT_FALSE(server.serve(sdo::abort_frame(0x2000, SdoAbort::general), device, answer));
}

} // namespace
} // namespace tappet::canopen
