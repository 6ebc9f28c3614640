// A signal's values by their names in the DBC file (VAL_) or in the list of named(): constants from which a
// machine makes its enumerations.
//
//     enum class Gear : std::int64_t {
//         neutral = can::value_of<gearbox_signals, "gearbox.gear", "Neutral">,
//         reverse = can::value_of<gearbox_signals, "gearbox.gear", "Reverse gear">,
//     };
//     static_assert(can::values_called<gearbox_signals, "gearbox.gear"> == 2); // the file has no others
//     ...
//     if (Gear{gear.get()} == Gear::reverse) ...
#pragma once

#include "drivers/can/signal_map.hpp"

namespace tappet::can {

namespace detail {

template <std::size_t F, std::size_t S>
constexpr Sentence path_fault(const SignalMap<F, S>& map, std::string_view path) noexcept {
    if (!map.fault.empty() || map.signal(path) != no_such) return map.fault;
    Nearest nearest{path};
    std::array<Sentence, S> all{};
    for (std::size_t s = 0; s < S; ++s) {
        all[s] = Sentence{map.name_of(s).of, ".", map.name_of(s).name};
        nearest.consider(all[s].view());
    }
    return Sentence{"the map has no signal \"", path, "\"", or_meant(nearest, "; write it as frame.signal")};
}
template <std::size_t F, std::size_t S>
constexpr Sentence value_fault(const SignalMap<F, S>& map, std::string_view path,
                               std::string_view name) noexcept {
    if (const Sentence fault = path_fault(map, path); !fault.empty()) return fault;
    const std::size_t s = map.signal(path);
    return name_fault(map.name_of(s).of, map.signals[s], name);
}

template <const auto& map, text path, text name> struct CalledValue {
    static constexpr Sentence fault = value_fault(map, path.view(), name.view());
    TAPPET_ACCEPTED(fault);

    static constexpr auto get() {
        if constexpr (!fault.empty()) {
            return std::int64_t{0};
        } else {
            constexpr const Signal& signal = map.signals[map.signal(path.view())];
            constexpr const ValueName& value = *value_called(signal, name.view());
            if constexpr (is_integer(signal))
                return value.value;
            else
                return physical_of(signal, value);
        }
    }
};

template <const auto& map, text path> struct CalledValues {
    static constexpr Sentence fault = path_fault(map, path.view());
    TAPPET_ACCEPTED(fault);
    static constexpr std::size_t count =
        fault.empty() ? map.signals[map.signal(path.view())].names.size() : 0;
};

} // namespace detail

/// The value with this name of signal "frame.signal", as in its facet: an std::int64_t, or a double where the
/// signal has a factor, an offset or is a float. An unknown name does not compile.
template <const auto& map, text path, text name>
inline constexpr auto value_of = detail::CalledValue<map, path, name>::get();

/// Number of its values that have a name.
template <const auto& map, text path>
inline constexpr std::size_t values_called = detail::CalledValues<map, path>::count;

} // namespace tappet::can
