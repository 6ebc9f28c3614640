// Detection by a protected payload: the standard's examples, every error of one and two bits, and all that a
// faulty channel may do to a sequence of payloads. A twin without one rule of the check shows the purpose of
// that rule.
#include "kernel/base/random.hpp"
#include "kernel/system/protection.hpp"

#include <gtest/gtest.h>

#include <array>
#include <functional>
#include <initializer_list>
#include <vector>

namespace tappet {
namespace {

using Form = Protection::Form;
using Kind = ProtectionVerdict::Kind;

/// The header of a payload of zeros.
template <std::size_t bytes> constexpr auto header(const Protection& by, std::uint8_t counter) {
    std::array<std::uint8_t, bytes> payload{};
    std::array<std::uint8_t, 3> found{};
    if (protect(payload, by, counter))
        for (std::size_t i = 0; i < found.size(); ++i) found[i] = payload[by.at + i];
    return found;
}
using Header = std::array<std::uint8_t, 3>;
static_assert(header<8>({.form = Form::id_both, .id = 0x123}, 0) == Header{0xCC, 0x00});
static_assert(header<8>({.form = Form::id_both, .id = 0x123}, 1) == Header{0x91, 0x01});
static_assert(header<8>({.form = Form::id_low, .id = 0x123}, 0) == Header{0xCE, 0x00});
static_assert(header<8>({.form = Form::id_low, .id = 0x123}, 1) == Header{0x93, 0x01});
static_assert(header<8>({.form = Form::id_nibble, .id = 0x123}, 0) == Header{0x2A, 0x10});
static_assert(header<8>({.form = Form::id_nibble, .id = 0x123}, 1) == Header{0x77, 0x11});
static_assert(header<16>({.form = Form::id_nibble, .id = 0x123, .at = 8}, 0) == Header{0x7D, 0x10});
static_assert(header<8>({.form = Form::wide, .id = 0x1234}, 0) == Header{0x1C, 0xCA, 0x00});
static_assert(header<8>({.form = Form::wide, .id = 0x1234}, 1) == Header{0xCF, 0x8D, 0x01});

static_assert(protection_fault({.form = Form::id_both, .id = 0xFFFF}, 2).empty());
static_assert(protection_fault({.form = Form::id_both}, 1).view() ==
              "a header of 2 bytes at byte 0 does not fit into a payload of 1 byte: move the header or "
              "lengthen the payload");
static_assert(protection_fault({.form = Form::wide, .at = 6}, 8).view() ==
              "a header of 3 bytes at byte 6 does not fit into a payload of 8 bytes: move the header or "
              "lengthen the payload");
static_assert(protection_fault({.form = Form::wide, .at = ~std::size_t{0}}, 8).size() > 0);
static_assert(protection_fault({.form = Form::id_nibble, .id = 0x1000}, 8).view() ==
              "the id 4096 has more than the 12 bits that are sent and summed: give one up to 4095, or take "
              "id_both");
static_assert(protection_fault({.form = Form::id_low, .id = 256}, 8).view() ==
              "the id 256 has more than the 8 bits that are summed: give one up to 255, or take id_both");
static_assert(protection_fault({.form = Form::id_both, .most_steps = 15}, 8).view() ==
              "most_steps is 15: write one from 1 to 14");
static_assert(!protection_fault({.most_steps = 0}, 8).empty());

/// Each form at least once; two of the headers lie behind data.
constexpr std::array forms{
    Protection{.form = Form::id_both, .id = 0x123}, Protection{.form = Form::id_nibble, .id = 0xABC, .at = 3},
    Protection{.form = Form::id_low, .id = 0x7F}, Protection{.form = Form::wide, .id = 0x1234},
    Protection{.form = Form::wide, .id = 0xFFFE, .at = 5}};

template <std::size_t bytes> std::array<std::uint8_t, bytes> any_payload(Random& random) {
    std::array<std::uint8_t, bytes> payload{};
    for (std::uint8_t& byte : payload) byte = static_cast<std::uint8_t>(random.below(256));
    return payload;
}

TEST(Protection, changes_only_its_header) {
    Random random{1};
    for (const Protection& by : forms)
        for (int i = 0; i < 100; ++i) {
            const auto before = any_payload<8>(random);
            auto payload = before;
            ASSERT_TRUE(protect(payload, by, 7));
            for (unsigned bit = 0; bit < 64; ++bit)
                if (bit < 8 * by.at || bit >= 8 * by.at + by.header_bits()) {
                    ASSERT_EQ(payload[bit / 8] >> bit % 8 & 1, before[bit / 8] >> bit % 8 & 1);
                }
        }
}

TEST(Protection, refuses_an_impossible_payload_and_writes_nothing) {
    std::array<std::uint8_t, 8> payload{1, 2, 3, 4, 5, 6, 7, 8};
    const auto before = payload;
    EXPECT_FALSE(protect(payload, {}, 15));
    EXPECT_FALSE(protect(std::span{payload}.first(1), {}, 0));
    EXPECT_FALSE(protect(payload, {.form = Form::wide, .at = 6}, 0));
    EXPECT_FALSE(protect(payload, {.at = ~std::size_t{0}}, 0));
    EXPECT_EQ(payload, before);
    EXPECT_TRUE(protect(payload, {.form = Form::wide}, 255));
}

/// Bits in wire order, the highest of a byte first.
template <std::size_t N> void flip(std::array<std::uint8_t, N>& payload, std::size_t bit) {
    payload[bit / 8] = static_cast<std::uint8_t>(payload[bit / 8] ^ 0x80U >> bit % 8);
}
template <std::size_t N> bool is_found(const std::array<std::uint8_t, N>& payload, const Protection& by) {
    return ProtectionCheck{by}.check(payload).kind == Kind::wrong_crc;
}
template <std::size_t N> void expect_every_error_of_two_bits_found(const Protection& by, Random& random) {
    auto payload = any_payload<N>(random);
    ASSERT_TRUE(protect(payload, by, static_cast<std::uint8_t>(random.below(by.counters()))));
    ASSERT_FALSE(is_found(payload, by));
    for (std::size_t one = 0; one < 8 * N; ++one) {
        flip(payload, one);
        ASSERT_TRUE(is_found(payload, by)) << "bit " << one;
        for (std::size_t other = 0; other < one; ++other) {
            flip(payload, other);
            ASSERT_TRUE(is_found(payload, by)) << "bits " << one << " and " << other;
            flip(payload, other);
        }
        flip(payload, one);
    }
}

TEST(Protection, detects_each_error_of_one_or_two_bits) {
    Random random{1};
    for (const Protection& by : forms)
        for (int i = 0; i < 20; ++i) expect_every_error_of_two_bits_found<8>(by, random);
    expect_every_error_of_two_bits_found<64>({.form = Form::wide, .id = 0x1234}, random);
}

struct Bursts {
    std::size_t missed = 0, all = 0;
};
/// The bursts of that length that begin and end with a wrong bit, in each place.
Bursts bursts(const Protection& by, std::size_t length) {
    std::array<std::uint8_t, 8> payload{};
    EXPECT_TRUE(protect(payload, by, 0));
    Bursts found;
    for (std::size_t from = 0; from + length <= 64; ++from)
        for (std::size_t inner = 0; inner < std::size_t{1} << (length - 2); ++inner) {
            auto spoilt = payload;
            flip(spoilt, from);
            flip(spoilt, from + length - 1);
            for (std::size_t bit = 0; bit + 2 < length; ++bit)
                if ((inner >> bit & 1) != 0) flip(spoilt, from + 1 + bit);
            ++found.all;
            found.missed += is_found(spoilt, by) ? 0U : 1U;
        }
    return found;
}

// The checksum precedes its data, so that a burst across both is outside the polynomial's guarantee: some of
// the longer ones are missed, about as many as of any other error.
TEST(Protection, detects_each_short_burst_and_most_longer_ones) {
    for (const Protection& by : forms) {
        const std::size_t short_ones = by.is_wide() ? 13 : 7;
        for (std::size_t length = 2; length <= 16; ++length) {
            const Bursts found = bursts(by, length);
            if (length <= short_ones) {
                EXPECT_EQ(found.missed, 0u) << length << " bits";
            }
            EXPECT_LT(found.missed * (by.is_wide() ? 30'000 : 128), found.all) << length << " bits";
        }
    }
}

TEST(Protection, detects_a_payload_of_each_other_connection) {
    for (const Form form : {Form::id_both, Form::id_low, Form::id_nibble, Form::wide}) {
        const unsigned most = form == Form::id_low ? 255 : form == Form::id_nibble ? 4095 : 65535;
        const Protection own{.form = form, .id = 0x5A};
        for (unsigned id = 0; id <= most; ++id) {
            std::array<std::uint8_t, 8> payload{1, 2, 3, 4, 5, 6, 7, 8};
            ASSERT_TRUE(protect(payload, {.form = form, .id = static_cast<std::uint16_t>(id)}, 3));
            const Kind kind = ProtectionCheck{own}.check(payload).kind;
            // An 8-bit checksum cannot distinguish all 16-bit identifiers.
            if (form == Form::id_both && id > 255 && kind == Kind::initial) continue;
            ASSERT_EQ(kind, id == own.id ? Kind::initial : Kind::wrong_crc) << "id " << id;
        }
    }
}

/// The verdicts of a check for payloads with these counters.
std::vector<Kind> kinds(const Protection& by, std::initializer_list<std::uint8_t> counters) {
    ProtectionCheck check{by};
    std::vector<Kind> found;
    for (const std::uint8_t counter : counters) {
        std::array<std::uint8_t, 8> payload{};
        EXPECT_TRUE(protect(payload, by, counter));
        found.push_back(check.check(payload).kind);
    }
    return found;
}

TEST(ProtectionCheck, reports_the_order_of_payloads) {
    using enum Kind;
    const Protection by{.id = 0x123, .most_steps = 3};
    EXPECT_EQ(kinds(by, {3, 4, 6, 9, 9, 10}), (std::vector{initial, ok, some_lost, some_lost, repeated, ok}));
    EXPECT_EQ(kinds(by, {13, 14, 0, 1}), (std::vector{initial, ok, ok, ok})) << "15 counters";
    EXPECT_EQ(kinds(by, {5, 4, 5}), (std::vector{initial, wrong_order, ok})) << "an old one";
    EXPECT_EQ(kinds(by, {5, 9, 10}), (std::vector{initial, wrong_order, ok})) << "too many were lost";
    const Protection wide{.form = Form::wide, .id = 0x123, .most_steps = 3};
    EXPECT_EQ(kinds(wide, {254, 255, 0, 3, 7}), (std::vector{initial, ok, ok, some_lost, wrong_order}));
}

TEST(ProtectionCheck, reports_the_number_of_lost_payloads) {
    const Protection by{.id = 0x123, .most_steps = 14};
    for (std::uint8_t steps = 1; steps < 15; ++steps)
        for (std::uint8_t from = 0; from < 15; ++from) {
            ProtectionCheck check{by};
            std::array<std::uint8_t, 8> payload{};
            ASSERT_TRUE(protect(payload, by, from));
            ASSERT_EQ(check.check(payload).kind, Kind::initial);
            ASSERT_TRUE(protect(payload, by, static_cast<std::uint8_t>((from + steps) % 15)));
            const ProtectionVerdict found = check.check(payload);
            EXPECT_EQ(found.kind, steps == 1 ? Kind::ok : Kind::some_lost);
            EXPECT_EQ(found.lost, steps - 1);
            EXPECT_TRUE(found.usable());
        }
}

TEST(ProtectionCheck, rejects_truncated_payloads_and_invalid_counters) {
    const Protection by{.id = 0x123};
    std::array<std::uint8_t, 8> payload{};
    ASSERT_TRUE(protect(payload, by, 3));
    for (std::size_t bytes = 1; bytes < payload.size(); ++bytes)
        EXPECT_EQ(ProtectionCheck{by}.check(std::span{payload}.first(bytes)).kind, Kind::wrong_crc);
    EXPECT_EQ(ProtectionCheck{by}.check({}).kind, Kind::no_new_data);
    payload[1] = 15;
    payload[0] = static_cast<std::uint8_t>(detail::protection_sum(payload, by));
    EXPECT_EQ(ProtectionCheck{by}.check(payload).kind, Kind::wrong_crc);
}

// -- A faulty channel: each verdict is compared with the true number of the payload

using Check = std::function<ProtectionVerdict(std::span<const std::uint8_t>, bool begins_anew)>;

/// The rule that a check omits.
enum class Without {
    nothing,
    the_turn_at_fifteen,
    the_id_beside,
    the_counter_fifteen,
    the_end_of_losses,
    what_is_out_of_order_as_the_last,
    the_first_one,
    a_new_beginning,
    the_sum,
    keeping_the_counter_of_what_is_spoilt_out,
    counting_what_is_between_only
};

/// The rules again, each of which can be omitted.
struct Twin {
    Protection by{};
    Without without = Without::nothing;
    bool known = false;
    unsigned last = 0;

    ProtectionVerdict operator()(std::span<const std::uint8_t> bytes, bool begins_anew) {
        if (begins_anew && without != Without::a_new_beginning) known = false;
        if (bytes.empty()) return {Kind::no_new_data};
        const unsigned beside = bytes[by.at + by.checksum_bytes()];
        const unsigned counter = by.is_wide() ? beside : beside & 15U;
        bool wrong = detail::checksum_in(bytes, by) != detail::protection_sum(bytes, by);
        if (without == Without::the_sum) wrong = false;
        if (by.form == Form::id_nibble && without != Without::the_id_beside)
            wrong |= beside >> 4 != (by.id >> 8 & 15U);
        if (without != Without::the_counter_fifteen) wrong |= !by.is_wide() && counter == 15;
        if (wrong) {
            if (without == Without::keeping_the_counter_of_what_is_spoilt_out) last = counter;
            return {Kind::wrong_crc};
        }
        const unsigned turn = by.is_wide() ? 256 : without == Without::the_turn_at_fifteen ? 16 : 15;
        const unsigned steps = (counter + turn - last) % turn;
        const bool first = !known;
        known = true;
        if (first) last = counter;
        if (first && without != Without::the_first_one) return {Kind::initial};
        const bool disordered = steps > by.most_steps && without != Without::the_end_of_losses;
        if (!disordered || without != Without::what_is_out_of_order_as_the_last) last = counter;
        if (disordered) return {Kind::wrong_order};
        if (steps == 0) return {Kind::repeated};
        const unsigned lost = without == Without::counting_what_is_between_only ? steps : steps - 1;
        return {steps == 1 ? Kind::ok : Kind::some_lost, static_cast<std::uint8_t>(lost)};
    }
};

/// The expected verdict from payload numbers that never wrap.
struct Truth {
    Protection by{};
    std::int64_t last = -1;

    ProtectionVerdict operator()(std::int64_t number) {
        const std::int64_t turn = by.counters();
        const std::int64_t steps = ((number - last) % turn + turn) % turn;
        const bool first = last < 0;
        last = number;
        if (first) return {Kind::initial};
        if (steps == 0) return {Kind::repeated};
        if (steps > by.most_steps) return {Kind::wrong_order};
        return {steps == 1 ? Kind::ok : Kind::some_lost, static_cast<std::uint8_t>(steps - 1)};
    }
};

/// A sender and a channel that loses, repeats, swaps, delays, corrupts and misroutes payloads; returns the
/// number of wrong verdicts.
int wrong_verdicts(const Protection& by, std::uint64_t seed, const Check& check) {
    Random random{seed};
    Truth truth{by};
    Protector sender{by};
    std::vector<std::array<std::uint8_t, 8>> sent;
    int wrong = 0;
    const auto receive = [&](std::size_t number, bool begins_anew) {
        const ProtectionVerdict found = check(sent[number], begins_anew);
        wrong += found == truth(static_cast<std::int64_t>(number)) ? 0 : 1;
    };
    const auto refuse = [&](std::span<const std::uint8_t> bytes, Kind as) {
        wrong += check(bytes, false) == ProtectionVerdict{as} ? 0 : 1;
    };
    while (sent.size() < 600) {
        sent.push_back(any_payload<8>(random));
        EXPECT_TRUE(sender.protect(sent.back()));
        const std::size_t now = sent.size() - 1;
        switch (random.below(16)) {
        case 0: break; // lost
        case 1:
            receive(now, false);
            receive(now, false);
            break;
        case 2: // an old one in between
            receive(now - random.below(std::min<std::size_t>(now + 1, 12)), false);
            receive(now, false);
            break;
        case 3: { // corrupted
            auto spoilt = sent.back();
            flip(spoilt, random.below(64));
            refuse(spoilt, Kind::wrong_crc);
            break;
        }
        case 4: { // of another connection, in the same place
            Protection other = by;
            other.id = static_cast<std::uint16_t>(by.id ^ 1U << random.below(8));
            auto foreign = sent.back();
            EXPECT_TRUE(protect(foreign, other, static_cast<std::uint8_t>(random.below(by.counters()))));
            refuse(foreign, Kind::wrong_crc);
            break;
        }
        case 5: refuse({}, Kind::no_new_data); break;
        case 6:
            truth.last = -1;
            receive(now, true);
            break;
        case 7: // a correct checksum over an invalid header
            if (!by.is_wide()) {
                auto odd = sent.back();
                std::uint8_t& beside = odd[by.at + 1];
                const bool counter = by.form != Form::id_nibble || random.one_in(2);
                beside = static_cast<std::uint8_t>(counter ? beside | 0x0F : beside ^ 0x10);
                odd[by.at] = static_cast<std::uint8_t>(detail::protection_sum(odd, by));
                refuse(odd, Kind::wrong_crc);
            }
            break;
        default: receive(now, false); break;
        }
    }
    return wrong;
}

Check product(const Protection& by) {
    return [check = ProtectionCheck{by}](std::span<const std::uint8_t> bytes, bool begins_anew) mutable {
        if (begins_anew) check.reset();
        return check.check(bytes);
    };
}

TEST(ProtectionCheck, classifies_every_payload_of_a_faulty_channel_correctly) {
    for (const Protection& by : forms)
        for (std::uint64_t seed = 1; seed <= 200; ++seed) {
            ASSERT_EQ(wrong_verdicts(by, seed, product(by)), 0) << "seed " << seed;
            ASSERT_EQ(wrong_verdicts(by, seed, Twin{by}), 0) << "seed " << seed;
        }
}

TEST(ProtectionCheck, needs_each_of_its_rules) {
    const Protection nibble = forms[1];
    for (const Without each :
         {Without::the_turn_at_fifteen, Without::the_id_beside, Without::the_counter_fifteen,
          Without::the_end_of_losses, Without::what_is_out_of_order_as_the_last, Without::the_first_one,
          Without::a_new_beginning, Without::the_sum, Without::keeping_the_counter_of_what_is_spoilt_out,
          Without::counting_what_is_between_only})
        EXPECT_GT(wrong_verdicts(nibble, 1, Twin{nibble, each}), 0) << static_cast<int>(each);
}

} // namespace
} // namespace tappet
