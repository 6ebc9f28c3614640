// Component rows: what the machine is made of, and the property values it gives to each.
#pragma once

#include "kernel/base/bounded.hpp"
#include "kernel/component/component.hpp"

#include <concepts>
#include <cstdint>
#include <string_view>

namespace tappet {

struct PropertyRow {
    std::string_view name{};
    PropertySetting setting;
};

struct DeviceName {
    std::string_view name{};
};
/// The logical name of the device that a driver component drives; board/ says what stands behind it.
constexpr DeviceName device(std::string_view name) noexcept { return {name}; }

/// A property's value in this machine.
constexpr PropertyRow set(std::string_view name, bool value) {
    return {name, {PropertySetting::Kind::truth, 0, value ? 1 : 0}};
}
template <std::integral T>
constexpr PropertyRow set(std::string_view name, T value) {
    return {name, {PropertySetting::Kind::whole, 0, static_cast<std::int64_t>(value)}};
}
template <std::floating_point T>
constexpr PropertyRow set(std::string_view name, T value) {
    return {name, {PropertySetting::Kind::real, static_cast<double>(value), 0}};
}
template <class Rep, class Period>
constexpr PropertyRow set(std::string_view name, std::chrono::duration<Rep, Period> value) {
    return {name, {PropertySetting::Kind::duration, 0, Duration{value}.count()}};
}

struct ComponentRow {
    static constexpr std::size_t max_settings = 24;
    std::string_view name{};
    const ComponentType* type = nullptr;
    std::string_view device{};
    Bounded<PropertyRow, max_settings> settings{};
    bool too_many_settings = false;
};

namespace detail {

constexpr void apply(ComponentRow& row, DeviceName option) noexcept { row.device = option.name; }
constexpr void apply(ComponentRow& row, const PropertyRow& option) noexcept {
    row.too_many_settings |= !row.settings.push(option);
}

} // namespace detail

template <class T, class... Options>
constexpr ComponentRow component(std::string_view name, const Options&... options) {
    ComponentRow row{.name = name, .type = &component_type<T>};
    (detail::apply(row, options), ...);
    return row;
}

} // namespace tappet
