// The plant's ends of the wires on any machine: lines as files in a folder, Modbus over the loopback.
#include "apps/carpet_loom/plant/bench/can_wire.hpp"
#include "apps/carpet_loom/plant/bench/line_wire.hpp"
#include "apps/carpet_loom/plant/bench/modbus_wire.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include <unistd.h>

namespace tappet::loom {
namespace {

struct Lines : testing::Test {
    Lines() : chip(std::filesystem::temp_directory_path() / ("tappet-lines-" + std::to_string(getpid()))) {
        for (unsigned i = 0; i < wires::line::chip_lines; ++i) {
            std::filesystem::create_directories(file(i, "").parent_path());
            std::ofstream(file(i, "pull")) << "pull-down";
            std::ofstream(file(i, "value")) << "0\n";
        }
    }
    ~Lines() override { std::filesystem::remove_all(chip); }
    [[nodiscard]] std::filesystem::path file(unsigned line, const char* name) const {
        return chip / ("sim_gpio" + std::to_string(line)) / name;
    }
    [[nodiscard]] std::string pulled(unsigned line) const {
        std::string word;
        std::ifstream(file(line, "pull")) >> word;
        return word;
    }
    std::filesystem::path chip;
};

TEST_F(Lines, carry_edges_both_ways) {
    auto lines = LineWire::open(chip.string());
    ASSERT_TRUE(lines) << lines.error();
    Plant plant(Settings{.operator_present = false}, 1);
    plant.press(Button::emergency_stop, Duration{});
    std::ofstream(file(wires::line::weft_release, "value")) << "1\n";
    lines->read_outputs(plant, at_ns(0), at_ns(200'000));
    EXPECT_EQ(plant.now(), at_ns(200'000)) << "lamps and cutter are read at the present time";
    EXPECT_EQ(plant.report().damage.valve_after_emergency, 1U) << "the valve's edge reached the plant";
    plant.advance(at_ns(50'000'000));
    lines->write_inputs(plant);
    EXPECT_EQ(pulled(wires::line::emergency_stop).substr(0, 7), "pull-up");
    EXPECT_EQ(lines->failures(), 0U);
}

TEST_F(Lines, that_are_missing_are_named) {
    std::filesystem::remove(file(wires::line::brake, "value"));
    const auto lines = LineWire::open(chip.string());
    ASSERT_FALSE(lines);
    EXPECT_NE(lines.error().find("sim_gpio9/value"), std::string::npos) << lines.error();
}

TEST(Can, names_an_interface_that_does_not_exist) {
    const auto can = CanWire::open("no-such-can");
    ASSERT_FALSE(can);
    EXPECT_NE(can.error().find("no-such-can"), std::string::npos);
}

struct ModbusServer : testing::Test {
    ModbusServer() {
        for (port = 15'020; port < 15'060 && !wire; ++port) {
            auto opened = ModbusWire::open("127.0.0.1", port, climate);
            if (opened) wire = std::move(*opened);
        }
        --port;
        master = modbus_new_tcp("127.0.0.1", port);
        modbus_set_slave(master, wires::modbus::unit);
        modbus_set_response_timeout(master, 2, 0);
    }
    ~ModbusServer() override {
        modbus_close(master);
        modbus_free(master);
    }
    Random random{1};
    Climate climate{random};
    std::unique_ptr<ModbusWire> wire;
    modbus_t* master = nullptr;
    int port = 0;
};

TEST_F(ModbusServer, carries_registers_and_refuses_what_the_unit_refuses) {
    ASSERT_NE(wire, nullptr);
    ASSERT_EQ(modbus_connect(master), 0);
    std::uint16_t words[4] = {};
    ASSERT_EQ(modbus_read_input_registers(master, 0, 4, words), 4);
    EXPECT_EQ(words[0], climate.input_register(0).value());
    ASSERT_EQ(modbus_read_registers(master, 0, 2, words), 2);
    EXPECT_EQ(words[0], 650);
    EXPECT_EQ(modbus_write_register(master, 0, 700), 1);
    EXPECT_EQ(modbus_write_bit(master, 0, 1), 1);
    // An exchange is skipped while the server still holds its registers for the answer.
    for (int tries = 0; !climate.pump() && tries < 500; ++tries) {
        wire->exchange(climate);
        usleep(1'000);
    }
    EXPECT_EQ(climate.holding_register(0).value(), 700);
    EXPECT_TRUE(climate.pump());
    EXPECT_EQ(modbus_write_register(master, 0, 100), -1);
    EXPECT_EQ(errno, EMBXILVAL);
    const std::uint16_t one_wrong[2] = {700, 5};
    EXPECT_EQ(modbus_write_registers(master, 0, 2, one_wrong), -1);
    EXPECT_EQ(errno, EMBXILVAL);
    EXPECT_EQ(modbus_read_input_registers(master, 2, 3, words), -1);
    EXPECT_EQ(errno, EMBXILADD);
}

TEST_F(ModbusServer, without_power_is_gone_and_comes_back) {
    ASSERT_NE(wire, nullptr);
    ASSERT_EQ(modbus_connect(master), 0);
    wire->set_power(false);
    std::uint16_t word = 0;
    int tries = 0;
    while (modbus_read_input_registers(master, 0, 1, &word) == 1 && ++tries < 500) usleep(10'000);
    modbus_close(master);
    EXPECT_EQ(modbus_connect(master), -1);
    wire->set_power(true);
    for (tries = 0; modbus_connect(master) != 0 && tries < 500; ++tries) usleep(10'000);
    EXPECT_EQ(modbus_read_input_registers(master, 0, 1, &word), 1);
}

} // namespace
} // namespace tappet::loom
