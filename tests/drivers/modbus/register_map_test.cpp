// Values in registers, and register tables that must be refused.
#include "drivers/modbus/register_map.hpp"

#include "kernel/base/random.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <limits>

namespace tappet::modbus {
namespace {

TEST(Registers, decode_words_by_their_kind) {
    EXPECT_EQ(to_physical(word("w", 0).times(0.1), {215, 0}), 21.5);
    EXPECT_EQ(to_physical(word("w", 0).as_signed(), {0xFFFF, 0}), -1.0);
    EXPECT_EQ(to_physical(double_word("d", 0), {0x0001, 0x0002}), 65538.0);
    EXPECT_EQ(to_physical(double_word("d", 0).swapped(), {0x0001, 0x0002}), 131073.0);
    EXPECT_EQ(to_physical(double_word("d", 0).as_signed(), {0xFFFF, 0xFFFE}), -2.0);
    EXPECT_EQ(to_physical(float_word("f", 0), {0x3FC0, 0x0000}), 1.5);
    EXPECT_EQ(to_physical(bit("b", 0), {1, 0}), 1.0);
}

// The four byte orders in which devices store 0x12345678.
TEST(Registers, decode_double_words_in_any_byte_order) {
    constexpr double value = 0x12345678;
    const Register d = double_word("d", 0);
    const struct {
        Register order;
        Words words;
    } cases[] = {{d, {0x1234, 0x5678}},
                 {d.swapped(), {0x5678, 0x1234}},
                 {d.bytes_swapped(), {0x3412, 0x7856}},
                 {d.swapped().bytes_swapped(), {0x7856, 0x3412}}};
    for (const auto& each : cases) {
        EXPECT_EQ(to_physical(each.order, each.words), value);
        EXPECT_EQ(to_words(each.order, value).words, each.words);
    }
    EXPECT_EQ(to_physical(word("w", 0).bytes_swapped().as_signed(), {0xFEFF, 0}), -2.0);
    EXPECT_EQ(to_words(float_word("f", 0).bytes_swapped(), 1.5).words, (Words{0xC03F, 0x0000}));
}

TEST(Registers, decode_as_they_were_encoded) {
    Random random{4};
    for (int i = 0; i < 1000; ++i) {
        const double value = static_cast<double>(random.between(-2147483648ll, 2147483647ll));
        const Register d = double_word("d", 0).as_signed();
        for (const Register& r : {d, d.swapped(), d.bytes_swapped(), d.swapped().bytes_swapped()})
            EXPECT_EQ(to_physical(r, to_words(r, value).words), value);
    }
}

TEST(Registers, saturate_and_refuse_nan) {
    EXPECT_EQ(to_words(word("w", 0), 70000).words[0], 65535);
    EXPECT_TRUE(to_words(word("w", 0), 70000).saturated);
    EXPECT_EQ(to_words(word("w", 0), -1).words[0], 0);
    EXPECT_EQ(to_words(word("w", 0).as_signed(), -40000).words[0], 0x8000);
    EXPECT_EQ(to_words(word("w", 0).as_signed(), -2.5).words[0], 0xFFFD);
    EXPECT_EQ(to_words(bit("b", 0), 5).words[0], 1);
    EXPECT_EQ(to_words(word("w", 0).times(0.001), 1e306).words[0], 65535) << "it has no end in that unit";
    EXPECT_EQ(to_words(word("w", 0).times(0.001).as_signed(), -1e306).words[0], 0x8000);
    EXPECT_TRUE(to_words(word("w", 0), std::numeric_limits<double>::quiet_NaN()).refused);
}

constexpr auto map =
    register_map(read("climate", input_registers(0, 4), every(250ms),
                      word("temperature", 0).as_signed().times(0.1).in("degC"), double_word("hours", 2)),
                 write("setpoints", holding_registers(10, 1), every(1s), stale_after(5s),
                       word("temperature", 0).safe(17)));
static_assert(map.fault.empty());
static_assert(map.value("climate.hours") == 1 && map.value("setpoints.temperature") == 2);
static_assert(map.value("climate.pressure") == no_such);

template <class... Rows> std::string_view fault(const Rows&... rows) {
    static Sentence kept;
    kept = register_map(rows...).fault;
    return kept.view();
}
auto row(Run run, Register r) { return read("r", run, every(1s), r); }

TEST(RegisterMap, contains_the_safe_words_of_each_written_row) {
    static constexpr auto all =
        register_map(write("a", holding_registers(10, 3), every(1s), stale_after(5s),
                           double_word("both", 1).safe(65537), word("one", 0).times(0.5).safe(17)),
                     write("b", coils(4, 1), every(1s), stale_after(5s), bit("on", 0)).safe_by_silence(),
                     write("c", coils(7, 1), every(1s), stale_after(5s), bit("on", 0).safe(1)));
    static_assert(all.fault.empty());
    const SafeWrites writes = all.safe_writes();
    ASSERT_EQ(writes.requests.size(), 2u);
    EXPECT_EQ(writes.requests[1].run.address, 7u);
    const std::array<std::uint16_t, 4> words{34, 1, 1, 1};
    EXPECT_TRUE(std::ranges::equal(writes.words.first(4), words));
    EXPECT_EQ(writes.requests[1].first, 3u);
}

TEST(RegisterMap, refuses_written_registers_without_a_safe_value) {
    EXPECT_EQ(fault(write("r", coils(0, 1), every(1s), stale_after(5s), bit("b", 0))),
              "register \"r.b\" does not say its safe value: write .safe(..) behind it, or "
              ".safe_by_silence() behind "
              "the row");
    EXPECT_EQ(
        fault(write("r", coils(0, 1), every(1s), stale_after(5s), bit("b", 0).safe(1)).safe_by_silence()),
        "register \"r.b\" has a safe value, but its row is safe by silence: keep one of the two");
    EXPECT_EQ(fault(row(holding_registers(0, 1), word("w", 0).safe(0))),
              "register \"r.w\" is read and has a safe value: only what is written has one");
    EXPECT_EQ(fault(write("r", holding_registers(0, 1), every(1s), stale_after(5s), word("w", 0).safe(-1))),
              "register \"r.w\" cannot hold its safe value: it is outside of the register's range");
}

TEST(RegisterMap, refuses_rows_longer_than_a_request) {
    EXPECT_EQ(fault(row(holding_registers(0, 126), word("w", 0))),
              "row \"r\" has 126 holding registers: a row carries 1 to 125; split it");
    EXPECT_EQ(fault(write("r", holding_registers(0, 124), every(1s), stale_after(5s), word("w", 0))),
              "row \"r\" has 124 holding registers: a row carries 1 to 123; split it");
    EXPECT_NE(fault(row(holding_registers(0, 0), word("w", 0))), "");
    EXPECT_EQ(fault(row(holding_registers(65535, 2), word("w", 0))),
              "row \"r\" ends at address 65536: the last is 65535");
    EXPECT_EQ(fault(row(holding_registers(65535, 1), word("w", 0))), "");
}

TEST(RegisterMap, refuses_to_write_read_only_tables) {
    EXPECT_EQ(fault(write("r", input_registers(0, 1), every(1s), stale_after(5s), word("w", 0))),
              "row \"r\" writes input registers, which can only be read: write coils or holding registers");
}

TEST(RegisterMap, refuses_to_overwrite_unnamed_registers) {
    EXPECT_EQ(fault(write("r", holding_registers(0, 3), every(1s), stale_after(5s), word("w", 0).safe(0))),
              "row \"r\" writes 3 holding registers and names 1: name all, or what is not named would be "
              "overwritten with 0");
}

TEST(RegisterMap, refuses_to_swap_single_words_and_bits) {
    EXPECT_EQ(fault(row(holding_registers(0, 2), word("w", 1).swapped())),
              "register \"r.w\" is swapped, but has one word; write bytes_swapped(), or take swapped() away");
    EXPECT_EQ(fault(row(coils(0, 2), bit("b", 1).bytes_swapped())),
              "register \"r.b\" is a bit and has no bytes to swap; take bytes_swapped() away");
}

TEST(RegisterMap, refuses_registers_that_exceed_their_row_or_overlap) {
    EXPECT_EQ(fault(row(holding_registers(0, 2), double_word("d", 1))),
              "register \"r.d\" reaches outside its row of 2 holding registers: move it or lengthen the row");
    EXPECT_EQ(fault(read("r", holding_registers(0, 4), every(1s), double_word("d", 0), word("w", 1))),
              "register \"r.w\" overlaps \"d\": move one of them");
}

TEST(RegisterMap, refuses_to_mix_bits_and_words) {
    EXPECT_EQ(fault(row(holding_registers(0, 1), bit("b", 0))),
              "register \"r.b\" is a bit among holding registers: take bit() for coils and discrete inputs, "
              "words elsewhere");
    EXPECT_NE(fault(row(coils(0, 1), word("w", 0))), "");
    EXPECT_EQ(fault(row(discrete_inputs(0, 1), bit("b", 0))), "");
}

TEST(RegisterMap, refuses_duplicate_names_zero_factors_and_impossible_periods) {
    EXPECT_EQ(fault(row(coils(0, 1), bit("b", 0)), row(coils(1, 1), bit("b", 0))),
              "row \"r\" is there twice: rename one of them");
    EXPECT_EQ(fault(read("r", coils(0, 2), every(1s), bit("b", 0), bit("b", 1))),
              "row \"r\" has two registers \"b\": rename one of them");
    EXPECT_NE(fault(row(holding_registers(0, 1), word("w", 0).times(0))), "");
    EXPECT_EQ(fault(read("r", coils(0, 1), every(0s), bit("b", 0))),
              "row \"r\" has no period: give it one, every(250ms)");
    EXPECT_EQ(fault(write("r", coils(0, 1), every(5s), stale_after(1s), bit("b", 0))),
              "row \"r\" is stale before it is due again: choose stale_after at least as long as every");
}

} // namespace
} // namespace tappet::modbus
