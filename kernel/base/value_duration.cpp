// Reads a time with its unit, exactly or not at all.
#include "kernel/base/value_bytes.hpp"

#include <limits>

namespace tappet {

namespace {

std::string_view take_digits(std::string_view& from) noexcept {
    std::size_t count = 0;
    while (count < from.size() && from[count] >= '0' && from[count] <= '9') ++count;
    const std::string_view digits = from.substr(0, count);
    from.remove_prefix(count);
    return digits;
}

Sentence too_long(std::string_view spelled) noexcept {
    return Sentence{"\"", quotable(spelled), "\" is too long; the longest time is 9223372036s"};
}
Sentence too_fine(std::string_view spelled) noexcept {
    return Sentence{"\"", quotable(spelled), "\" is finer than 1ns; write whole nanoseconds"};
}

} // namespace

Sentence parse_duration(std::string_view spelled, std::int64_t& into) noexcept {
    std::string_view unit_name = spelled;
    const bool negative = unit_name.starts_with('-');
    if (negative) unit_name.remove_prefix(1);
    std::string_view whole = take_digits(unit_name);
    std::string_view parts;
    bool is_number = !whole.empty();
    if (unit_name.starts_with('.')) {
        unit_name.remove_prefix(1);
        parts = take_digits(unit_name);
        is_number = is_number && !parts.empty();
    }
    const TimeUnit* unit = nullptr;
    for (const TimeUnit& each : time_units)
        if (unit_name == each.name) unit = &each;
    if (!is_number || (unit == nullptr && !unit_name.empty()))
        return Sentence{"\"", quotable(spelled),
                        "\" is not a time; write a number and its unit, such as 4ms"};
    if (unit == nullptr)
        return Sentence{"\"", quotable(spelled), "\" has no unit; write ns, us, ms, s, min or h after it"};

    while (parts.ends_with('0')) parts.remove_suffix(1);
    while (whole.size() > 1 && whole.starts_with('0')) whole.remove_prefix(1);
    if (whole.size() > 19) return too_long(spelled);
    if (parts.size() > 15) return too_fine(spelled); // 15 digits of an hour are less than 1 ns
    __extension__ using Wide = unsigned __int128;
    Wide ns = 0;
    for (const char digit : whole) ns = ns * 10 + static_cast<unsigned>(digit - '0');
    ns *= static_cast<Wide>(unit->ns);
    Wide part = 0;
    Wide scale = 1;
    for (const char digit : parts) part = part * 10 + static_cast<unsigned>(digit - '0'), scale *= 10;
    part *= static_cast<Wide>(unit->ns);
    if (part % scale != 0) return too_fine(spelled);
    ns += part / scale;
    if (ns > static_cast<Wide>(std::numeric_limits<std::int64_t>::max()) + (negative ? 1 : 0))
        return too_long(spelled);
    const auto magnitude = static_cast<std::uint64_t>(ns);
    into = static_cast<std::int64_t>(negative ? ~magnitude + 1 : magnitude);
    return {};
}

} // namespace tappet
