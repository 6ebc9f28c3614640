// A line of a candump log (can-utils: candump -L or -l): one frame with its time and interface.
//     (1700000000.123456) can0 123#DEADBEEF    8 digits instead of 3 are an identifier of 29 bits
//     (1700000000.123456) can0 123#R2          a remote frame that requests this many bytes
//     (1700000000.123456) can0 123##1DEADBEEF  CAN FD; flag 1 is the second bit rate, 2 an error
//                                              passive sender, 4 is CAN FD again
#pragma once

#include "drivers/can/frame.hpp"
#include "kernel/base/digits.hpp"
#include "kernel/base/text.hpp"

#include <cstddef>
#include <expected>
#include <string_view>

namespace tappet::can::candump {

struct Logged {
    std::string_view interface{}; ///< in the line
    Frame frame{};                ///< its stamp is of the log's clock, usually wall clock
    bool is_error = false;        ///< an error frame: its contents are the kernel's and are not decoded here
};

/// An error and its cure.
struct Fault {
    std::size_t column = 0; ///< counted from 1
    std::string_view what{};
    bool is_cut = false; ///< the line is the beginning of a right one
};

namespace detail {

constexpr int hex_digit(char c) noexcept {
    if (is_digit(c)) return c - '0';
    if (c >= 'A' && c <= 'F') return c - 'A' + 10;
    return c >= 'a' && c <= 'f' ? c - 'a' + 10 : -1;
}

/// The rest of the line.
struct Rest {
    std::string_view text;
    std::size_t begins = text.size();

    [[nodiscard]] constexpr std::size_t column() const noexcept { return begins - text.size() + 1; }
    [[nodiscard]] constexpr char front() const noexcept { return text.empty() ? '\0' : text.front(); }
    constexpr bool take(char c) noexcept {
        if (text.empty() || text.front() != c) return false;
        text.remove_prefix(1);
        return true;
    }
    /// Takes up to `most` characters of this kind.
    template <class Value>
    constexpr std::string_view take_while(Value is_wanted, std::size_t most) noexcept {
        std::size_t n = 0;
        while (n < most && n < text.size() && is_wanted(text[n])) ++n;
        const std::string_view taken = text.substr(0, n);
        text.remove_prefix(n);
        return taken;
    }
    [[nodiscard]] constexpr std::unexpected<Fault> refuse(std::string_view what) const noexcept {
        return std::unexpected(Fault{column(), what, text.empty()});
    }
};

/// Takes SECONDS.FRACTION; the fraction is optional: candump writes six or nine digits.
constexpr std::expected<Duration, Fault> take_seconds(Rest& rest) noexcept {
    const Rest before = rest;
    std::int64_t ns = 0;
    const std::string_view seconds = rest.take_while(is_digit, 11);
    if (seconds.empty() || seconds.size() > 10)
        return before.refuse("a time is seconds, as in 1700000000.123456");
    for (const char c : seconds) ns = 10 * ns + (c - '0');
    if (ns > 9'000'000'000)
        return before.refuse("a time of more than 9000000000 seconds is not a time of a log");
    ns *= 1'000'000'000;
    if (!rest.take('.')) return Duration{ns};
    const std::string_view fraction = rest.take_while(is_digit, 10);
    if (fraction.empty() || fraction.size() > 9)
        return rest.refuse("expected one to nine digits after the point of the time");
    std::int64_t unit = 100'000'000;
    for (const char c : fraction) {
        ns += unit * (c - '0');
        unit /= 10;
    }
    return Duration{ns};
}

constexpr std::expected<void, Fault> take_identifier(Rest& rest, Logged& logged) noexcept {
    const Rest before = rest;
    const std::string_view digits = rest.take_while([](char c) { return hex_digit(c) >= 0; }, 9);
    std::uint64_t id = 0;
    for (const char c : digits) id = 16 * id + static_cast<unsigned>(hex_digit(c));
    constexpr std::uint64_t error_flag = 0x2000'0000; // as in <linux/can.h>
    if (digits.size() == 8 && (id & error_flag) != 0 && id < 2 * error_flag) {
        logged.is_error = true;
        logged.frame.id = static_cast<std::uint32_t>(id - error_flag);
        return {};
    }
    logged.frame.extended = digits.size() == 8;
    logged.frame.id = static_cast<std::uint32_t>(id);
    if ((digits.size() != 3 && digits.size() != 8) ||
        !valid(Identifier{logged.frame.id, logged.frame.extended}))
        return std::unexpected(Fault{before.column(),
                                     "an identifier is 3 hexadecimal digits up to 7FF, or 8 up to 1FFFFFFF",
                                     rest.text.empty() && digits.size() < 8});
    return {};
}

constexpr std::expected<void, Fault> take_data(Rest& rest, Frame& frame) noexcept {
    const std::size_t most = frame.fd ? 64 : 8;
    while (hex_digit(rest.front()) >= 0) {
        if (frame.length == most)
            return rest.refuse(frame.fd ? "a frame of CAN FD has 64 bytes at most"
                                        : "a classical frame has 8 bytes at most; CAN FD is written with ##");
        const std::string_view pair = rest.take_while([](char c) { return hex_digit(c) >= 0; }, 2);
        if (pair.size() != 2) return rest.refuse("a byte is two hexadecimal digits; the line is cut off");
        frame.data[frame.length++] = static_cast<std::uint8_t>(16 * hex_digit(pair[0]) + hex_digit(pair[1]));
    }
    return {};
}

} // namespace detail

/// Reads a number of seconds and nothing else.
constexpr std::expected<Duration, Fault> read_seconds(std::string_view text) noexcept {
    detail::Rest rest{text};
    const auto time = detail::take_seconds(rest);
    if (time && !rest.text.empty()) return rest.refuse("expected nothing after the seconds");
    return time;
}

/// Reads a line without its end.
constexpr std::expected<Logged, Fault> read(std::string_view line) noexcept {
    detail::Rest rest{line};
    Logged logged;
    Frame& frame = logged.frame;
    if (!rest.take('('))
        return rest.refuse("a line begins with its time, as in (1700000000.123456) can0 123#AABB; "
                           "record with candump -L");
    const auto time = detail::take_seconds(rest);
    if (!time) return std::unexpected(time.error());
    frame.stamp = Time{*time};
    if (!rest.take(')')) return rest.refuse("expected ')' after the time");
    if (!rest.take(' ')) return rest.refuse("expected a blank and the interface after the time");
    logged.interface = rest.take_while([](char c) { return c > ' ' && c != '\x7f'; }, 64);
    if (logged.interface.empty()) return rest.refuse("expected a blank and the interface after the time");
    if (!rest.take(' ')) return rest.refuse("expected a blank and the frame after the interface");
    if (auto taken = detail::take_identifier(rest, logged); !taken) return std::unexpected(taken.error());
    if (!rest.take('#')) return rest.refuse("expected # or, for CAN FD, ## after the identifier");
    if (rest.take('#')) {
        const int flags = detail::hex_digit(rest.front());
        if (flags < 0 || flags > 7)
            return rest.refuse("expected a digit of flags after ##, a sum of 1, 2 and 4");
        rest.text.remove_prefix(1);
        frame.fd = true;
        frame.bit_rate_switch = (flags & 1) != 0;
        frame.error_state_indicator = (flags & 2) != 0;
    } else if (rest.take('R')) {
        frame.remote = true;
        if (rest.front() >= '0' && rest.front() <= '8') {
            frame.length = static_cast<std::uint8_t>(rest.front() - '0');
            rest.text.remove_prefix(1);
        }
    }
    const detail::Rest contents = rest;
    if (!frame.remote)
        if (auto taken = detail::take_data(rest, frame); !taken) return std::unexpected(taken.error());
    if (!valid(frame))
        return std::unexpected(
            Fault{contents.column(), "CAN FD has no frame of this length", rest.text.empty()});
    // Eight bytes with a length code above eight.
    if (!frame.fd && frame.length == 8 && rest.take('_') &&
        (detail::hex_digit(rest.front()) < 9 || !rest.take(rest.front())))
        return rest.refuse("expected a length code from 9 to F after _");
    if (rest.text == " R" || rest.text == " T") rest.text = {}; // candump -x: received, or sent
    if (!rest.text.empty())
        return std::unexpected(
            Fault{rest.column(), "expected nothing after the frame's bytes", rest.text == " "});
    return logged;
}

/// Returns the line, without its end. Characters that Linux does not allow in an interface name become '_',
/// and a name too long is cut, so that canplayer accepts it. A time before 0 becomes 0, and one between two
/// microseconds is rounded up, so that no frame is logged before it happened.
constexpr Sentence write(const Frame& frame, std::string_view interface) noexcept {
    constexpr std::string_view digits = "0123456789ABCDEF";
    Sentence line{"("};
    const auto add = [&line, digits](std::uint64_t value, std::uint64_t highest, unsigned base) {
        for (; highest != 0; highest /= base) {
            line.add(digits.substr(value / highest, 1));
            value %= highest;
        }
    };
    const auto us = static_cast<std::uint64_t>((std::max(to_ns(frame.stamp), std::int64_t{0}) + 999) / 1000);
    add(us / 1'000'000, 1'000'000'000, 10);
    line.add(".");
    add(us % 1'000'000, 100'000, 10);
    line.add(") ");
    for (const char& c : interface.substr(0, 15))
        line.add(c > ' ' && c < '\x7f' ? std::string_view{&c, 1} : "_");
    line.add(" ");
    add(frame.id, frame.extended ? 0x1000'0000 : 0x100, 16);
    line.add("#");
    if (frame.remote) {
        line.add("R");
        if (frame.length != 0) add(frame.length, 1, 16);
        return line;
    }
    if (frame.fd) {
        line.add("#");
        add((frame.bit_rate_switch ? 1u : 0u) + (frame.error_state_indicator ? 2u : 0u), 1, 16);
    }
    for (std::size_t i = 0; i < frame.length; ++i) add(frame.data[i], 16, 16);
    return line;
}

} // namespace tappet::can::candump
