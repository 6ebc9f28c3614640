// Signals in frames: bits and values against an independent decoder, and tables that must be refused.
#include "drivers/can/signal_store.hpp"

#include "kernel/base/random.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace tappet::can {
namespace {

struct Vector {
    std::uint16_t start;
    std::uint8_t bits;
    Order order;
    bool is_signed;
    Payload data;
    std::int64_t raw;
};

// Decoded by canmatrix 0.9.5 from random payloads; start bits as in a DBC file.
constexpr Vector independent[] = {
    {0, 16, Order::intel, false, {{0x60, 0xbe, 0x31, 0x20, 0x1e, 0x69, 0xfe, 0xda}}, 48736},
    {16, 32, Order::intel, true, {{0xa0, 0xee, 0xe8, 0xb9, 0x99, 0x7f, 0x5c, 0x7c}}, 2140781032},
    {7, 16, Order::motorola, false, {{0x29, 0x99, 0xfd, 0xaf, 0xe5, 0x93, 0x25, 0x3c}}, 10649},
    {55, 12, Order::motorola, true, {{0xd6, 0x54, 0xaf, 0x4d, 0xfa, 0xd7, 0x14, 0x27}}, 322},
    {3, 10, Order::intel, true, {{0xa0, 0xae, 0xb3, 0xfe, 0xe9, 0x23, 0x2f, 0x8a}}, 468},
    {12, 33, Order::intel, false, {{0xf2, 0x21, 0x1f, 0x9e, 0xe4, 0x91, 0xc5, 0xb1}}, 4803125746},
    {2, 5, Order::motorola, false, {{0x0b, 0xec, 0xb5, 0x56, 0x3b, 0xfc, 0x1e, 0x6f}}, 15},
    {10, 40, Order::motorola, true, {{0x93, 0x42, 0x7e, 0xcb, 0xc8, 0xfe, 0x29, 0x55}}, 342951010245},
    {0, 64, Order::intel, true, {{0xe5, 0xcd, 0x8e, 0x46, 0xdc, 0x8e, 0xd4, 0xb7}}, -5200374592978367003},
    {7, 64, Order::motorola, true, {{0xc2, 0x76, 0x4d, 0x2a, 0x5a, 0x4d, 0x76, 0x77}}, -4434271938800683401},
    {63, 1, Order::intel, false, {{0x06, 0xf8, 0x5d, 0x86, 0x90, 0x02, 0x4a, 0xd6}}, 1},
    {60, 3, Order::motorola, true, {{0xbd, 0xa3, 0x40, 0x1b, 0xe9, 0xc8, 0xcb, 0xcc}}, 3},
};

Signal placed(std::uint16_t start, std::uint8_t bits, Order order, bool is_signed) {
    Signal s = signal("s", start, bits);
    if (order == Order::motorola) s = s.big_endian();
    return is_signed ? s.as_signed() : s;
}

TEST(Signals, decode_as_an_independent_decoder_does) {
    for (const Vector& v : independent) {
        const Signal s = placed(v.start, v.bits, v.order, v.is_signed);
        EXPECT_EQ(to_integer(s, extract(v.data, s)), v.raw)
            << "start " << v.start << ", bits " << int{v.bits};
    }
}

/// A signal of any length and order, within the first `end` bits.
Signal any_signal(Random& random, int end) {
    const auto bits = static_cast<std::uint8_t>(random.between(1, 64));
    const bool motorola = random.one_in(2);
    const auto first = static_cast<unsigned>(random.between(0, end - bits));
    // Motorola: `first` counts from the left end of the payload to the most significant bit.
    const unsigned start = motorola ? 8 * (first / 8) + 7 - first % 8 : first;
    return placed(static_cast<std::uint16_t>(start), bits, motorola ? Order::motorola : Order::intel, false);
}

TEST(Signals, decode_as_they_were_encoded_and_touch_no_other_bit) {
    Random random{3};
    for (int round = 0; round < 2000; ++round) {
        const Signal s = any_signal(random, 64);
        const std::uint64_t raw = random.next() >> (64 - s.bits);
        Payload zeros{}, ones{};
        ones.fill(0xFF);
        insert(zeros, s, raw);
        insert(ones, s, raw);
        EXPECT_EQ(extract(zeros, s), raw);
        EXPECT_EQ(extract(ones, s), raw);
        int set = 0;
        for (std::size_t i = 0; i < 8; ++i) set += std::popcount(static_cast<unsigned>(zeros[i] ^ ones[i]));
        EXPECT_EQ(set, 64 - s.bits);
    }
}

// By hand, bit for bit, in all 64 bytes; beyond 57 bits some reach into a ninth byte.
TEST(Signals, may_lie_anywhere_in_64_bytes) {
    Random random{4};
    for (int round = 0; round < 5000; ++round) {
        const Signal s = any_signal(random, 512);
        Payload before{};
        for (auto& each : before) each = static_cast<std::uint8_t>(random.next());
        Payload data = before;
        const std::uint64_t raw = random.next();
        insert(data, s, raw);
        std::uint64_t found = 0;
        for (unsigned i = 0; i < s.bits; ++i) {
            const unsigned at = bit_place(s, i);
            found |= std::uint64_t{data[at / 8] >> at % 8 & 1u} << i;
            const auto mask = static_cast<std::uint8_t>(1u << at % 8);
            data[at / 8] = static_cast<std::uint8_t>((data[at / 8] & ~mask) | (before[at / 8] & mask));
        }
        ASSERT_EQ(found, raw & ~std::uint64_t{0} >> (64 - s.bits))
            << "start " << s.start << ", bits " << int{s.bits};
        ASSERT_EQ(data, before) << "no other bit was touched";
        insert(data, s, raw);
        ASSERT_EQ(extract(data, s), found);
    }
}

TEST(Signals, apply_the_sign_before_factor_and_offset) {
    const Signal s = signal("t", 0, 8).as_signed().times(0.5).plus(10);
    EXPECT_EQ(to_physical(s, 0xFF), 9.5);
    EXPECT_EQ(to_raw(s, 9.5).bits, 0xFFu);
}

TEST(Signals, saturate_integers_and_truncate_only_bits) {
    const Signal number = signal("speed", 16, 16).as_signed().in("rpm"), natural = signal("n", 0, 16),
                 bits = signal("word", 0, 16).as_bits(), wide = signal("w", 0, 64),
                 wide_signed = wide.as_signed();
    constexpr auto least = std::numeric_limits<std::int64_t>::min(),
                   most = std::numeric_limits<std::int64_t>::max();
    const struct {
        const Signal& of;
        std::int64_t value;
        std::uint64_t bits;
        bool saturated;
    } cases[] = {{number, 40000, 0x7FFF, true},
                 {number, -40000, 0x8000, true},
                 {number, -1, 0xFFFF, false},
                 {natural, -1, 0, true},
                 {natural, 65535, 65535, false},
                 {natural, 65536, 65535, true},
                 {bits, -1, 0xFFFF, false},
                 {bits, 0x1F0F0, 0xF0F0, false},
                 {wide, most, 0x7FFF'FFFF'FFFF'FFFF, false},
                 {wide, -1, 0, true},
                 {wide_signed, least, 0x8000'0000'0000'0000, false},
                 {wide_signed, -1, ~std::uint64_t{0}, false}};
    for (const auto& each : cases) {
        const Raw raw = to_raw_integer(each.of, each.value);
        EXPECT_EQ(raw.bits, each.bits) << each.of.name << " " << each.value;
        EXPECT_EQ(raw.saturated, each.saturated) << each.of.name << " " << each.value;
    }
    for (const double none : {std::nan(""), HUGE_VAL, -HUGE_VAL})
        for (const Signal& of : {natural, signal("f", 0, 32).as_float(), signal("d", 0, 64).as_float()})
            EXPECT_TRUE(to_raw(of, none).refused);
}

TEST(Signals, carry_floats) {
    const Signal f = signal("f", 0, 32).as_float();
    const Signal d = signal("d", 0, 64).as_float();
    EXPECT_EQ(to_physical(f, 0x3FC00000), 1.5);
    EXPECT_EQ(to_raw(f, -2.25).bits, 0xC0100000u);
    EXPECT_EQ(to_physical(d, to_raw(d, 0.1).bits), 0.1);
    EXPECT_TRUE(to_raw(f, 1e300).saturated);
}

TEST(Signals, saturate_and_do_not_wrap) {
    const Signal f = signal("f", 0, 32).as_float().times(0.001);
    const Signal s = signal("v", 0, 16).as_signed(), u = signal("v", 0, 16), wide = signal("w", 0, 64);
    const struct {
        Signal of;
        double value;
        std::uint64_t bits;
        bool saturated;
    } cases[] = {{s, 40000, 0x7FFF, true},
                 {s, -40000, 0x8000, true},
                 {s, -32768, 0x8000, false},
                 {s, 32767.4, 0x7FFF, false},
                 {u, -1, 0, true},
                 {u, -0.4, 0, false},
                 {u, 65535.6, 0xFFFF, true},
                 {wide, 1e20, ~std::uint64_t{0}, true},
                 {wide.as_signed(), -1e20, std::uint64_t{1} << 63, true},
                 {signal("one signed bit holds -1 and 0", 0, 1).as_signed(), 1, 0, true},
                 {signal("b", 0, 1).as_signed(), -1, 1, false},
                 {signal("w", 0, 53), 9007199254740991.0, 9007199254740991u, false}};
    for (const auto& each : cases) {
        EXPECT_EQ(to_raw(each.of, each.value).bits, each.bits) << each.of.name << " " << each.value;
        EXPECT_EQ(to_raw(each.of, each.value).saturated, each.saturated) << each.of.name << " " << each.value;
    }
    // A number that overflows to infinity in the unit of the wire.
    for (const double large : {1e306, -1e306}) {
        const bool up = large > 0;
        EXPECT_EQ(to_raw(signal("p", 0, 32).as_signed().times(0.001), large).bits,
                  up ? 0x7FFF'FFFFu : 0x8000'0000u);
        EXPECT_EQ(to_raw(signal("p", 0, 32).times(0.001), large).bits, up ? 0xFFFF'FFFFu : 0u);
        EXPECT_EQ(to_physical(f, to_raw(f, large).bits),
                  up ? 3.4028234663852886e38 * 0.001 : -3.4028234663852886e38 * 0.001);
        EXPECT_TRUE(to_raw(signal("d", 0, 64).as_float().times(0.001), large).saturated);
    }
}

TEST(Signals, round_to_the_nearest) {
    const Signal s = signal("v", 0, 16).as_signed();
    EXPECT_EQ(to_raw(s, 2.5).bits, 3u);
    EXPECT_EQ(to_raw(s, -2.5).bits, 0xFFFDu);
    EXPECT_EQ(to_raw(s, 2.4).bits, 2u);
}

constexpr auto map = signal_map(
    receive(standard(0x181), "drive", bytes(6), every(1ms), signal("statusword", 0, 16),
            signal("velocity", 16, 32).as_signed().times(0.1).in("rpm")),
    receive(extended(0x18FF0102), "climate", bytes(2), every(1ms),
            signal("temperature", 7, 16).big_endian().times(0.01).plus(-40)),
    transmit(standard(0x201), "command", bytes(6), every(1ms), signal("controlword", 0, 16).safe(6),
             signal("target", 16, 32).as_signed().times(0.1).safe(-12.3)));
static_assert(map.fault.empty());
static_assert(map.receives().size() == 2 && map.receives()[1] == extended(0x18FF0102));
static_assert(map.transmits().size() == 1 && map.transmits()[0] == standard(0x201));
static_assert(map.signal("drive.velocity") == 1 && map.signal("drive.torque") == no_such);
static_assert(map.frame("command") == 2 && map.frame(standard(0x201)) == 2 &&
              map.frame(extended(0x201)) == no_such);

static_assert(map.safe_frames().size() == 1 && map.safe_frames()[0].id == 0x201 &&
              map.safe_frames()[0].data == Payload{0x06, 0x00, 0x85, 0xFF, 0xFF, 0xFF});

template <class... Rows> std::string_view fault(const Rows&... rows) {
    static Sentence kept;
    kept = signal_map(rows...).fault;
    return kept.view();
}

/// Fault of a frame "f" with these signals.
template <class... Signals> std::string_view fault_of(Bytes length, const Signals&... signals) {
    return fault(receive(standard(1), "f", length, every(1ms), signals...));
}
template <class... Signals> std::string_view fault_of_sent(const Signals&... signals) {
    return fault(transmit(standard(1), "f", bytes(2), every(1ms), signals...));
}

TEST(SignalMap, sends_cyclic_safe_frames_first_and_omits_rows_safe_by_silence) {
    static constexpr auto all = signal_map(
        transmit(standard(0x000), "nmt", bytes(2), on_demand(10ms), signal("command", 0, 8).safe(128),
                 signal("node", 8, 8).safe(0)),
        transmit(standard(0x201), "command", bytes(2), every(1ms), signal("controlword", 0, 16).safe(2)),
        transmit(standard(0x301), "dobby", bytes(1), every(1ms), signal("pattern", 0, 8)).safe_by_silence());
    static_assert(all.fault.empty());
    ASSERT_EQ(all.safe_frames().size(), 2u);
    EXPECT_EQ(all.safe_frames()[0].id, 0x201u);
    EXPECT_EQ(all.safe_frames()[1].data, (Payload{128, 0}));
}

TEST(SignalMap, refuses_sent_signals_without_a_safe_value) {
    EXPECT_EQ(
        fault_of_sent(signal("speed", 0, 16)),
        "signal \"f.speed\" does not say its safe value: write .safe(..) behind it, or .safe_by_silence() "
        "behind the frame");
    EXPECT_EQ(fault(transmit(standard(1), "f", bytes(2), every(1ms), signal("speed", 0, 16).safe(0))
                        .safe_by_silence()),
              "signal \"f.speed\" has a safe value, but its frame is safe by silence: keep one of the two");
    EXPECT_EQ(fault_of_sent(signal("speed", 0, 16).safe(70000)),
              "signal \"f.speed\" cannot hold its safe value: it is outside of the signal's range");
    EXPECT_EQ(fault_of(bytes(2), signal("speed", 0, 16).safe(0)),
              "signal \"f.speed\" is received and has a safe value: only what is sent has one");
}

constexpr ValueName states[]{{0, "off"}, {1, "on"}, {2, "reserved"}, {3, "reserved"}};

TEST(SignalMap, refuses_a_safe_value_with_an_unknown_name) {
    const auto named = [](const Signal& s) { return fault_of_sent(s); };
    const Signal lamp = signal("lamp", 0, 2).named(states);
    EXPECT_EQ(named(lamp.safe("on")), "");
    EXPECT_EQ(named(lamp.safe("onn")), "signal \"f.lamp\" has no value \"onn\"; did you mean \"on\"?");
    EXPECT_EQ(named(lamp.safe("glowing")),
              "signal \"f.lamp\" has no value \"glowing\"; name it by VAL_ in its file, or by .named(..)");
    EXPECT_EQ(named(signal("lamp", 0, 2).safe("on")),
              "signal \"f.lamp\" has no value \"on\"; name it by VAL_ in its file, or by .named(..)");
    EXPECT_EQ(named(lamp.safe("reserved")), "signal \"f.lamp\" has two values \"reserved\", 2 and 3; give "
                                            "them different names, by VAL_ or by .named(..)");
    EXPECT_EQ(named(lamp.safe(0)), "") << "a number is no name";
}

Frame drive_frame(std::uint8_t length = 6) {
    return {.id = 0x181, .length = length, .data = {0x27, 0x06, 0x18, 0xFC, 0xFF, 0xFF}, .stamp = Time{10ms}};
}

TEST(SignalStore, decodes_a_frame_that_fits) {
    SignalStore store{map};
    EXPECT_EQ(store.decode(drive_frame()), Decoded::yes);
    EXPECT_EQ(store.integer(map.signal("drive.statusword")), 0x627);
    EXPECT_EQ(store.physical(map.signal("drive.velocity")), -100.0);
}

TEST(SignalStore, counts_but_does_not_decode_wrong_lengths_and_unknown_identifiers) {
    SignalStore store{map};
    for (const std::uint8_t length : {std::uint8_t{0}, std::uint8_t{5}, std::uint8_t{7}, std::uint8_t{8}})
        EXPECT_EQ(store.decode(drive_frame(length)), Decoded::wrong_length);
    Frame other = drive_frame(), extended = other, remote = other, ours = other;
    other.id = 0x182;
    extended.extended = true;
    remote.remote = true;
    ours.id = 0x201;
    for (const auto& [what, frame] : {std::pair{"identifier", other},
                                      {"format", extended},
                                      {"remote", remote},
                                      {"ours to send, not to receive", ours}})
        EXPECT_EQ(store.decode(frame), Decoded::unknown_identifier) << what;
    EXPECT_EQ(store.count.wrong_lengths, 4u);
    EXPECT_EQ(store.count.unknown_identifiers, 4u);
    EXPECT_EQ(store.count.decoded, 0u);
    EXPECT_EQ(store.physical(1), 0.0);
}

TEST(SignalStore, encodes_a_row) {
    SignalStore store{map};
    store.set_bits(map.signal("command.controlword"), 0x0F);
    store.set_physical(map.signal("command.target"), -100.0);
    const Frame f = store.encode(map.frame("command"), Time{3ms});
    EXPECT_EQ(f.id, 0x201u);
    EXPECT_EQ(f.length, 6);
    EXPECT_EQ(f.stamp, Time{3ms});
    EXPECT_EQ(f.data, (Payload{0x0F, 0x00, 0x18, 0xFC, 0xFF, 0xFF, 0x00, 0x00}));
}

TEST(SignalStore, keeps_the_last_value_instead_of_nan_and_counts_saturation) {
    SignalStore store{map};
    const std::size_t target = map.signal("command.target");
    store.set_physical(target, 50);
    store.set_physical(target, std::numeric_limits<double>::quiet_NaN());
    EXPECT_EQ(store.physical(target), 50.0);
    EXPECT_EQ(store.count.refused, 1u);
    store.set_physical(target, 1e12);
    EXPECT_EQ(store.integer(target), 2147483647);
    EXPECT_EQ(store.count.saturated, 1u);
}

TEST(SignalStore, survives_random_frames) {
    SignalStore store{map};
    Random random{9};
    for (int i = 0; i < 20000; ++i) {
        Frame f{.id = random.one_in(3) ? 0x181u : static_cast<std::uint32_t>(random.below(0x800)),
                .extended = random.one_in(5),
                .remote = random.one_in(9),
                .length = static_cast<std::uint8_t>(random.below(16))};
        for (auto& byte : f.data) byte = static_cast<std::uint8_t>(random.next());
        store.decode(f);
    }
    EXPECT_EQ(store.count.decoded + store.count.unknown_identifiers + store.count.wrong_lengths, 20000u);
}

TEST(SignalMap, refuses_overlapping_signals) {
    EXPECT_EQ(fault_of(bytes(8), signal("a", 0, 16), signal("b", 15, 8)),
              "signal \"f.b\" overlaps \"a\" at bit 15: move one of them");
    EXPECT_EQ(fault_of(bytes(8), signal("a", 7, 16).big_endian(), signal("b", 8, 8)),
              "signal \"f.b\" overlaps \"a\" at bit 8: move one of them");
    EXPECT_EQ(fault_of(bytes(8), signal("a", 7, 16).big_endian(), signal("b", 16, 8)), "");
}

TEST(SignalMap, refuses_signals_outside_their_frame) {
    EXPECT_EQ(fault_of(bytes(2), signal("a", 8, 9)),
              "signal \"f.a\" reaches outside its frame of 2 bytes: it starts at bit 8 (its lowest) and goes "
              "up 9 bits; move it or "
              "lengthen the frame");
    EXPECT_NE(fault_of(bytes(2), signal("a", 15, 9).big_endian()), "");
    EXPECT_NE(fault_of(bytes(8), signal("a", 60000, 9)), "");
    EXPECT_NE(fault_of(bytes(8), signal("a", 0, 65)), "");
    EXPECT_NE(fault_of(bytes(8), signal("a", 0, 0)), "");
    EXPECT_NE(fault_of(bytes(9), signal("a", 0, 8)), "");
}

TEST(SignalMap, refuses_pages_that_the_range_of_their_multiplexor_lets_nobody_send) {
    constexpr Signal page = signal("page", 0, 8).range(0, 2);
    const auto level = [](const auto&... values) {
        return signal("level", 8, 8).when("page", values...).safe(0);
    };
    EXPECT_EQ(
        fault_of_sent(page.safe(0), level(5)),
        "signal \"f.level\" is selected by the value 5, which \"page\" never has: its range lets 2 be sent "
        "instead; widen its range(..), or correct the value");
    EXPECT_NE(fault_of_sent(page.safe(0), level(between(1, 3))), "");
    EXPECT_EQ(fault_of_sent(page.safe(0), level(between(1, 2))), "");
    static constexpr std::array names{ValueName{5, "service"}};
    EXPECT_EQ(fault_of_sent(page.named(names).safe(0), level(5)), "") << "no range limits a named value";
    EXPECT_EQ(signal_map(receive(standard(1), "f", bytes(4), every(1ms), page,
                                 signal("level", 8, 16).when("page", 5)))
                  .fault.view(),
              "")
        << "no range limits what another node sends";
}

constexpr auto fast = signal_map(
    receive(standard(0x321), "scan", fd_bytes(64), every(5ms), signal("count", 0, 8), signal("first", 8, 16),
            signal("across", 61, 64), signal("last", 487, 32).big_endian().as_signed()),
    transmit(standard(0x322), "pages", fd_bytes(24).in_one_rate(), every(5ms), signal("page", 0, 8).safe(1),
             signal("low", 128, 64).when("page", 0).safe(7),
             signal("high", 128, 32).when("page", 1).as_signed().safe(-1)));
static_assert(fast.fault.empty());

TEST(SignalMap, accepts_can_fd_rows_with_signals_anywhere) {
    SignalStore store{fast};
    Frame f{.id = 0x321, .length = 64};
    set_format(f, Format::flexible_faster);
    insert(f.data, fast.signals[0], 200);
    insert(f.data, fast.signals[2], 0x8877'6655'4433'2211);
    insert(f.data, fast.signals[3], 0xFFFF'FFFE);
    EXPECT_EQ(f.data[60], 0xFF);
    EXPECT_EQ(f.data[63], 0xFE);
    ASSERT_EQ(store.decode(f), Decoded::yes);
    EXPECT_EQ(store.integer(fast.signal("scan.count")), 200);
    EXPECT_EQ(static_cast<std::uint64_t>(store.integer(fast.signal("scan.across"))), 0x8877'6655'4433'2211);
    EXPECT_EQ(store.integer(fast.signal("scan.last")), -2);
}

TEST(SignalMap, refuses_can_fd_frames_of_another_format_or_length) {
    SignalStore store{fast};
    Frame f;
    f.id = 0x321;
    for (const int length : {0, 8, 48, 63})
        for (const Format format : {Format::classical, Format::flexible, Format::flexible_faster}) {
            f.length = static_cast<std::uint8_t>(length);
            set_format(f, format);
            EXPECT_EQ(store.decode(f), Decoded::wrong_length);
        }
    f.length = 64;
    set_format(f, Format::flexible);
    EXPECT_EQ(store.decode(f), Decoded::wrong_length) << "it takes longer on the wire than was proven";
    EXPECT_EQ(store.count.wrong_lengths, 13u);

    SignalStore classical{map};
    Frame drive = drive_frame();
    drive.fd = true;
    EXPECT_EQ(classical.decode(drive), Decoded::wrong_length);
}

TEST(SignalMap, sends_the_pages_of_a_can_fd_row_with_zeros_between_them) {
    SignalStore store{fast};
    store.set_bits(fast.signal("pages.low"), ~std::uint64_t{0});
    store.set_bits(fast.signal("pages.high"), 0x12345678);
    Frame f = store.encode(fast.frame("pages"), {});
    EXPECT_EQ(format_of(f), Format::flexible);
    EXPECT_EQ(f.length, 24);
    Payload expected{};
    for (std::size_t i = 16; i < 24; ++i) expected[i] = 0xFF;
    EXPECT_EQ(f.data, expected);
    store.set_bits(fast.signal("pages.page"), 1);
    f = store.encode(fast.frame("pages"), {});
    expected = {1};
    expected[16] = 0x78, expected[17] = 0x56, expected[18] = 0x34, expected[19] = 0x12;
    EXPECT_EQ(f.data, expected);
    ASSERT_EQ(fast.safe_frames().size(), 2u);
    EXPECT_EQ(fast.safe_frames()[0].data[16], 7);
    EXPECT_EQ(fast.safe_frames()[1].data[19], 0xFF);
    for (const Frame& each : fast.safe_frames()) EXPECT_EQ(format_of(each), Format::flexible);
}

TEST(SignalMap, refuses_lengths_that_do_not_exist) {
    const auto of = [](Bytes length) { return fault_of(length, signal("a", 0, 8)); };
    EXPECT_EQ(of(fd_bytes(13)), "frame \"f\" has 13 bytes: CAN FD has no such length; make it 16, and "
                                "what no signal covers is padding");
    EXPECT_EQ(of(fd_bytes(65)), "frame \"f\" has 65 bytes: a CAN FD frame holds 64 at most; make it two");
    EXPECT_EQ(of(bytes(12)), "frame \"f\" has 12 bytes: a classical frame holds 8 at most; make it CAN "
                             "FD by fd_bytes(..), in a DBC file by VFrameFormat");
    for (const int length : {1, 8, 12, 16, 20, 24, 32, 48, 64})
        EXPECT_EQ(of(fd_bytes(static_cast<std::uint8_t>(length))), "");
}

TEST(SignalMap, refuses_invalid_signals_behind_the_eighth_byte_too) {
    EXPECT_EQ(fault_of(fd_bytes(64), signal("a", 300, 64), signal("b", 363, 8)),
              "signal \"f.b\" overlaps \"a\" at bit 363: move one of them");
    EXPECT_EQ(fault_of(fd_bytes(64), signal("a", 300, 64), signal("b", 364, 8)), "");
    EXPECT_EQ(
        fault_of(fd_bytes(48), signal("a", 376, 9)),
        "signal \"f.a\" reaches outside its frame of 48 bytes: it starts at bit 376 (its lowest) and goes "
        "up 9 bits; move it or lengthen the frame");
    EXPECT_NE(fault_of(fd_bytes(48), signal("a", 383, 9).big_endian()), "");
}

TEST(SignalMap, refuses_duplicate_names_and_identifiers) {
    const auto row = [](std::uint32_t id, std::string_view name) {
        return receive(standard(id), name, bytes(8), every(1ms), signal("a", 0, 8));
    };
    EXPECT_EQ(fault(row(1, "f"), row(2, "f")), "frame \"f\" is there twice: rename one of them");
    EXPECT_EQ(fault(row(1, "f"), row(1, "g")), "frame \"g\" has the identifier of \"f\": give it its own");
    EXPECT_EQ(fault(row(1, "f"), receive(extended(1), "g", bytes(0), every(1ms))), "")
        << "another format, another identifier";
    EXPECT_EQ(fault_of(bytes(8), signal("a", 0, 8), signal("a", 8, 8)),
              "frame \"f\" has two signals \"a\": rename one of them");
    EXPECT_EQ(
        fault(row(0x800, "f")),
        "frame \"f\" has the identifier 2048: a standard one ends at 2047, an extended one at 536870911");
    EXPECT_EQ(fault(row(1, "")), "frame 1 has no name: name it");
}

TEST(SignalMap, refuses_a_factor_of_zero_and_16_bit_floats) {
    EXPECT_EQ(fault_of(bytes(8), signal("a", 0, 8).times(0)),
              "signal \"f.a\" has the factor 0: every value would be the offset; give it another");
    EXPECT_NE(fault_of(bytes(8), signal("a", 0, 16).as_float()), "");
}

} // namespace
} // namespace tappet::can
