// The plant's ends of the bench's wires on any machine: lines as files in a folder, Modbus over the loopback.
#include "drivers/can/bench_bus.hpp"
#include "drivers/can/signal_map.hpp"
#include "drivers/gpio/bench_lines.hpp"
#include "drivers/modbus/bench_server.hpp"

#include <gtest/gtest.h>
#include <modbus.h>

#include <array>
#include <filesystem>
#include <fstream>

#include <unistd.h>

namespace tappet {
namespace {

constexpr auto lines = gpio::line_map(gpio::sensor("stop"), gpio::sensor("guard", gpio::active_low),
                                      gpio::actuator("valve", gpio::safe(false)),
                                      gpio::output("lamp", gpio::active_low, gpio::safe(false)));
constexpr std::array bound{line("stop", 0), line("guard", 3), line("valve", 8), line("lamp", 9)};

struct Lines : testing::Test {
    Lines() : chip(std::filesystem::temp_directory_path() / ("tappet-lines-" + std::to_string(getpid()))) {
        for (unsigned i = 0; i < 10; ++i) {
            std::filesystem::create_directories(file(i, "").parent_path());
            std::ofstream(file(i, "pull")) << "pull-nowhere";
            put(i, false);
        }
    }
    ~Lines() override { std::filesystem::remove_all(chip); }
    [[nodiscard]] std::filesystem::path file(unsigned offset, const char* name) const {
        return chip / ("sim_gpio" + std::to_string(offset)) / name;
    }
    void put(unsigned offset, bool high) const {
        std::ofstream(file(offset, "value")) << (high ? "1\n" : "0\n");
    }
    [[nodiscard]] bool is_pulled_up(unsigned offset) const {
        std::string word;
        std::ifstream(file(offset, "pull")) >> word;
        return word.starts_with("pull-up");
    }
    std::filesystem::path chip;
    gpio::BenchLines end;
};

TEST_F(Lines, carry_levels_both_ways_and_invert_active_low_lines) {
    ASSERT_TRUE(end.open_at(chip.string(), lines.rows, bound));
    EXPECT_FALSE(is_pulled_up(0));
    EXPECT_TRUE(is_pulled_up(3)) << "active low, and not active";
    put(8, true);
    end.look(at_ns(200'000));
    EXPECT_EQ(end.outputs(), 0b1100u) << "the valve; and the lamp, whose line is low";
    EXPECT_TRUE(end.drive(0, true, at_ns(200'000)));
    EXPECT_TRUE(end.drive(1, true, at_ns(200'000)));
    EXPECT_TRUE(is_pulled_up(0));
    EXPECT_FALSE(is_pulled_up(3));
    EXPECT_FALSE(end.drive(2, true, at_ns(200'000))) << "an output of the machine";
    EXPECT_EQ(end.failures(), 0u);
}

TEST_F(Lines, drive_an_input_at_its_time) {
    ASSERT_TRUE(end.open_at(chip.string(), lines.rows, bound));
    end.look(at_ns(1'000'000));
    EXPECT_TRUE(end.drive(0, true, at_ns(5'000'000)));
    EXPECT_FALSE(is_pulled_up(0));
    end.look(at_ns(5'000'000));
    EXPECT_TRUE(is_pulled_up(0));
}

TEST_F(Lines, date_an_output_change_midway_between_two_polls) {
    ASSERT_TRUE(end.open_at(chip.string(), lines.rows, bound));
    end.look(at_ns(1'000'000));
    put(8, true);
    end.look(at_ns(1'400'000));
    EXPECT_EQ(end.changed_at(at_ns(1'400'000)), at_ns(1'200'000));
}

TEST_F(Lines, name_missing_lines_and_the_cure) {
    std::filesystem::remove(file(9, "value"));
    const auto opened = end.open_at(chip.string(), lines.rows, bound);
    ASSERT_FALSE(opened);
    const std::string said{opened.error().view()};
    EXPECT_NE(said.find("line \"lamp\""), std::string::npos) << said;
    EXPECT_NE(said.find("sim_gpio9/value"), std::string::npos) << said;
    EXPECT_NE(said.find("more than 9 lines: --gpio-chip NAME:LINES"), std::string::npos) << said;
}

TEST(Can, names_a_missing_interface) {
    can::BenchBus bus;
    const can::Identifiers none{};
    const auto opened = bus.open({.address = "no-such-can", .map = &none});
    ASSERT_FALSE(opened);
    EXPECT_NE(opened.error().view().find("\"no-such-can\" does not exist"), std::string_view::npos);
}

struct Server : testing::Test {
    Server() {
        end.have(modbus::Table::input_registers, 4);
        end.have(modbus::Table::holding_registers, 2);
        end.have(modbus::Table::coils, 1);
        end.accept_only(
            [](modbus::Table, std::size_t, std::uint16_t value) noexcept { return value >= 300; });
        end.set(modbus::Table::input_registers, 0, 231);
        end.set(modbus::Table::holding_registers, 0, 650);
        for (port = 15'020; port < 15'060 && !listens; ++port) {
            const std::string address = "127.0.0.1:" + std::to_string(port);
            listens = end.open({.address = address, .is_on_board = false}) && end.listen();
        }
        --port;
        client = modbus_new_tcp("127.0.0.1", port);
        modbus_set_slave(client, 1);
        modbus_set_response_timeout(client, 2, 0);
    }
    ~Server() override {
        modbus_close(client);
        modbus_free(client);
    }
    modbus::BenchServer end;
    bool listens = false;
    modbus_t* client = nullptr;
    int port = 0;
};

TEST_F(Server, answers_for_its_registers_and_refuses_other_requests) {
    ASSERT_TRUE(listens);
    ASSERT_EQ(modbus_connect(client), 0);
    std::uint16_t words[4] = {};
    ASSERT_EQ(modbus_read_input_registers(client, 0, 4, words), 4);
    EXPECT_EQ(words[0], 231);
    ASSERT_EQ(modbus_read_registers(client, 0, 2, words), 2);
    EXPECT_EQ(words[0], 650);
    EXPECT_EQ(modbus_write_register(client, 0, 700), 1);
    EXPECT_EQ(modbus_write_bit(client, 0, 1), 1);
    EXPECT_EQ(modbus_read_registers(client, 0, 1, words), 1) << "the request after it: those before are done";
    EXPECT_EQ(end.get(modbus::Table::holding_registers, 0), 700);
    EXPECT_EQ(end.get(modbus::Table::coils, 0), 1);
    EXPECT_EQ(modbus_write_register(client, 0, 100), -1);
    EXPECT_EQ(errno, EMBXILVAL);
    const std::uint16_t one_wrong[2] = {700, 5};
    EXPECT_EQ(modbus_write_registers(client, 0, 2, one_wrong), -1);
    EXPECT_EQ(errno, EMBXILVAL);
    EXPECT_EQ(modbus_read_input_registers(client, 2, 3, words), -1);
    EXPECT_EQ(errno, EMBXILADD);
}

TEST_F(Server, disconnects_without_power_and_comes_back) {
    ASSERT_TRUE(listens);
    ASSERT_EQ(modbus_connect(client), 0);
    end.set_power(false);
    std::uint16_t word = 0;
    int tries = 0;
    while (modbus_read_input_registers(client, 0, 1, &word) == 1 && ++tries < 500) usleep(10'000);
    modbus_close(client);
    EXPECT_EQ(modbus_connect(client), -1);
    end.set_power(true);
    for (tries = 0; modbus_connect(client) != 0 && tries < 500; ++tries) usleep(10'000);
    EXPECT_EQ(modbus_read_input_registers(client, 0, 1, &word), 1);
}

} // namespace
} // namespace tappet
