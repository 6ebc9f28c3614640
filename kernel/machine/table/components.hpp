// Component rows: the components of the machine and their property values.
#pragma once

#include "kernel/base/bounded.hpp"
#include "kernel/base/row_option.hpp"
#include "kernel/component/component.hpp"

#include <concepts>
#include <cstdint>
#include <string_view>

namespace tappet {

struct PropertyRow {
    std::string_view name{};
    PropertySetting setting;
};

namespace detail {

template <class T>
constexpr PropertySetting setting_of(const T& value) noexcept {
    using Kind = PropertySetting::Kind;
    if constexpr (std::same_as<T, bool>)
        return {.kind = Kind::boolean, .integer = value ? 1 : 0};
    else if constexpr (std::integral<T>)
        return {.kind = Kind::integer, .integer = static_cast<std::int64_t>(value)};
    else if constexpr (std::floating_point<T>)
        return {.kind = Kind::real, .real = static_cast<double>(value)};
    else if constexpr (std::is_enum_v<T>)
        return {.kind = Kind::enumeration, .integer = static_cast<std::int64_t>(value), .type = type_id<T>};
    else if constexpr (std::is_convertible_v<T, std::string_view>)
        return {.kind = Kind::text, .text = value};
    else if constexpr (is_text<T>)
        return {.kind = Kind::text, .text = value.view()};
    else
        return {.kind = Kind::duration, .integer = Duration{value}.count()};
}

template <const auto& values>
inline constexpr ListSetting list_setting{values.size(), [](std::size_t i) { return setting_of(values[i]); }};

} // namespace detail

/// Sets a property's value in this machine: a boolean, a number, a time with its unit, a text, or a value of
/// an enumeration. A property in a bag is named in full: "gains.roll.p".
template <class T>
constexpr PropertyRow set(std::string_view name, const T& value) {
    return {name, detail::setting_of(value)};
}
constexpr PropertyRow set(std::string_view name, const char* value) {
    return {name, detail::setting_of(std::string_view{value})};
}
/// Sets a list from an array or Sequence that is a constant at namespace scope: set<offsets>("offsets").
template <const auto& values>
constexpr PropertyRow set(std::string_view name) {
    return {name, {.kind = PropertySetting::Kind::list, .list = &detail::list_setting<values>}};
}

struct PropertiesFile {
    std::string_view name{};
    bool may_be_missing = false;
};
/// The component's properties are read from this file during configuration, and saved to it. The file is in
/// the board's properties_directory; a missing file is an error unless `optional`. Its values override those
/// of the row.
constexpr PropertiesFile properties_file(std::string_view name) noexcept { return {name, false}; }
constexpr PropertiesFile properties_file(std::string_view name, Optional) noexcept { return {name, true}; }

struct ComponentRow {
    static constexpr std::size_t max_settings = 24;
    std::string_view name{};
    const ComponentType* type = nullptr;
    std::string_view device{};
    std::string_view watched{};
    std::string_view controlled{};
    Bounded<PropertyRow, max_settings> settings{};
    bool too_many_settings = false;
    bool has_properties_file = false;
    PropertiesFile properties{};
};

/// The logical name of the device that a driver component drives; the binding names the real device.
constexpr RowOption<ComponentRow, std::string_view> device(std::string_view name) noexcept {
    return {&ComponentRow::device, name};
}
/// The target of a watchdog: an activity, or an output that is connected to another activity.
constexpr RowOption<ComponentRow, std::string_view> watches(std::string_view name) noexcept {
    return {&ComponentRow::watched, name};
}
/// The component whose life or behaviour this one controls: a BehaviourTask or a ComponentLife.
constexpr RowOption<ComponentRow, std::string_view> controls(std::string_view component) noexcept {
    return {&ComponentRow::controlled, component};
}

namespace detail {

constexpr void apply(ComponentRow& row, const PropertyRow& option) noexcept {
    row.too_many_settings |= !row.settings.push(option);
}
constexpr void apply(ComponentRow& row, const PropertiesFile& option) noexcept {
    row.has_properties_file = true;
    row.properties = option;
}

} // namespace detail

/// component<Type>("name", ...). The name is the first part of every path to the component, so it has no dot.
template <class T, class... Options>
constexpr ComponentRow component(std::string_view name, const Options&... options) {
    ComponentRow row{.name = name, .type = &component_type<T>};
    (detail::apply(row, options), ...);
    return row;
}

} // namespace tappet
