// The layout of decimals, and the syntax that is read; double-conversion computes the digits.
#include "kernel/base/real_text.hpp"

#include <double-conversion/double-to-string.h>
#include <double-conversion/strtod.h>

#include <array>
#include <cmath>
#include <cstring>

namespace tappet {

namespace {

using double_conversion::DoubleToStringConverter;

constexpr int max_digits = 17;

struct Digits {
    char text[max_digits + 1]; // and a terminating zero
    int count = 0;
    int point = 0; // the value is 0.text * 10^point
    bool negative = false;
};

std::size_t put(char* into, std::string_view text) noexcept {
    std::memcpy(into, text.data(), text.size());
    return text.size();
}

std::size_t write_special(char* into, double value) noexcept {
    const std::size_t sign = std::signbit(value) ? put(into, "-") : 0;
    return sign + put(into + sign, std::isnan(value) ? "nan" : "inf");
}

int fixed_length(const Digits& d) noexcept {
    if (d.point <= 0) return 2 - d.point + d.count;    // 0.00ddd
    return d.point >= d.count ? d.point : d.count + 1; // ddd00, dd.d
}
int exponent_digits(int exponent) noexcept { return std::abs(exponent) >= 100 ? 3 : 2; }
int scientific_length(const Digits& d) noexcept {
    return d.count + (d.count > 1 ? 1 : 0) + 2 + exponent_digits(d.point - 1); // d.dde-07
}

std::size_t write_fixed(char* into, const Digits& d) noexcept {
    char* at = into;
    if (d.point <= 0) {
        at += put(at, "0.");
        for (int i = d.point; i < 0; ++i) *at++ = '0';
        at += put(at, {d.text, static_cast<std::size_t>(d.count)});
    } else {
        for (int i = 0; i < d.point; ++i) *at++ = i < d.count ? d.text[i] : '0';
        if (d.count > d.point) *at++ = '.';
        for (int i = d.point; i < d.count; ++i) *at++ = d.text[i];
    }
    return static_cast<std::size_t>(at - into);
}

std::size_t write_scientific(char* into, const Digits& d) noexcept {
    char* at = into;
    *at++ = d.text[0];
    if (d.count > 1) *at++ = '.';
    for (int i = 1; i < d.count; ++i) *at++ = d.text[i];
    const int exponent = d.point - 1;
    *at++ = 'e';
    *at++ = exponent < 0 ? '-' : '+';
    const int size = std::abs(exponent);
    if (size >= 100) *at++ = static_cast<char>('0' + size / 100);
    *at++ = static_cast<char>('0' + size / 10 % 10);
    *at++ = static_cast<char>('0' + size % 10);
    return static_cast<std::size_t>(at - into);
}

Digits digits_of(double value, DoubleToStringConverter::DtoaMode mode, int wanted) noexcept {
    Digits d;
    DoubleToStringConverter::DoubleToAscii(value, mode, wanted, d.text, sizeof d.text, &d.negative, &d.count,
                                           &d.point);
    while (d.count > 1 && d.text[d.count - 1] == '0') --d.count; // when a precision was requested
    return d;
}

std::size_t write_shortest(char* into, double value, DoubleToStringConverter::DtoaMode mode) noexcept {
    if (!std::isfinite(value)) return write_special(into, value);
    const Digits d = digits_of(value, mode, 0);
    const std::size_t sign = d.negative ? put(into, "-") : 0;
    return sign + (fixed_length(d) <= scientific_length(d) ? write_fixed(into + sign, d)
                                                           : write_scientific(into + sign, d));
}

bool is_digit(char character) noexcept { return character >= '0' && character <= '9'; }

std::size_t count_digits(std::string_view text) noexcept {
    std::size_t n = 0;
    while (n < text.size() && is_digit(text[n])) ++n;
    return n;
}

/// The digits before the exponent, without leading zeros, and the exponent that makes them an integer.
struct Written {
    static constexpr std::size_t most = 800; // more digits never decide how a double is rounded
    std::array<char, most> digits;
    std::size_t count = 0;
    int exponent = 0;
    bool cut = false; // some omitted digits were not zero

    void take(char digit, bool after_point) noexcept {
        if (count == 0 && digit == '0') {
            exponent -= after_point ? 1 : 0;
        } else if (count < most - 1) {
            digits[count++] = digit;
            exponent -= after_point ? 1 : 0;
        } else {
            cut |= digit != '0';
            exponent += after_point ? 0 : 1;
        }
    }
};

/// Splits [digits][.digits][e[sign]digits], with at least one digit before the exponent.
bool take_apart(std::string_view text, Written& into) noexcept {
    const std::size_t whole = count_digits(text);
    for (const char digit : text.substr(0, whole)) into.take(digit, false);
    text.remove_prefix(whole);
    std::size_t fraction = 0;
    if (text.starts_with('.')) {
        text.remove_prefix(1);
        fraction = count_digits(text);
        for (const char digit : text.substr(0, fraction)) into.take(digit, true);
        text.remove_prefix(fraction);
    }
    if (into.cut) into.digits[into.count++] = '1', --into.exponent;
    if (whole + fraction == 0) return false;
    if (text.empty()) return true;
    if ((text.front() | 0x20) != 'e') return false;
    text.remove_prefix(1);
    const bool down = text.starts_with('-');
    if (down || text.starts_with('+')) text.remove_prefix(1);
    if (text.empty() || count_digits(text) != text.size()) return false;
    constexpr int far = 100000; // beyond any number, whatever its digits
    int exponent = 0;
    for (const char digit : text)
        if (exponent < far) exponent = exponent * 10 + (digit - '0');
    into.exponent += down ? -exponent : exponent;
    return true;
}

template <class Real>
RealTextFault read(std::string_view text, Real& into) noexcept {
    const bool negative = text.starts_with('-');
    const std::string_view size = text.substr(negative ? 1 : 0);
    Real value = 0;
    Written written;
    if (!take_apart(size, written)) return RealTextFault::not_a_number;
    if (written.count != 0) {
        const double_conversion::Vector<const char> digits{written.digits.data(),
                                                           static_cast<int>(written.count)};
        if constexpr (sizeof(Real) == sizeof(double))
            value = double_conversion::Strtod(digits, written.exponent);
        else
            value = double_conversion::Strtof(digits, written.exponent);
        if (!std::isfinite(value) || value == 0) return RealTextFault::out_of_range;
    }
    into = negative ? -value : value;
    return RealTextFault::none;
}

} // namespace

std::size_t write_shortest(char* into, double value) noexcept {
    return write_shortest(into, value, DoubleToStringConverter::SHORTEST);
}
std::size_t write_shortest(char* into, float value) noexcept {
    return write_shortest(into, static_cast<double>(value), DoubleToStringConverter::SHORTEST_SINGLE);
}

std::size_t write_rounded(char* into, double value, int digits) noexcept {
    if (!std::isfinite(value)) return write_special(into, value);
    const Digits d = digits_of(value, DoubleToStringConverter::PRECISION, digits);
    const std::size_t sign = d.negative ? put(into, "-") : 0;
    const bool fixed = d.point - 1 >= -4 && d.point - 1 < digits;
    return sign + (fixed ? write_fixed(into + sign, d) : write_scientific(into + sign, d));
}

RealTextFault read_real_text(std::string_view text, double& into) noexcept { return read(text, into); }
RealTextFault read_real_text(std::string_view text, float& into) noexcept { return read(text, into); }

} // namespace tappet
