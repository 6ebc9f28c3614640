// Checks of the properties that component rows set: names, types, ranges, bags, and the file they come from.
#pragma once

#include "kernel/base/decimal.hpp"
#include "kernel/component/property_transaction.hpp"
#include "kernel/machine/table/index.hpp"

#include <limits>

namespace tappet::checks {

/// Begins a fault with the component it is about.
template <class... Pieces> constexpr Sentence of_component(std::string_view name, const Pieces&... fault) {
    return Sentence{"component \"", name, "\"", fault...};
}
template <class... Pieces> constexpr Sentence of_activity(std::string_view name, const Pieces&... fault) {
    return Sentence{"activity \"", name, "\"", fault...};
}

/// Whether the value is of the property's kind; a whole number is also a real number.
constexpr bool of_kind(const PropertyOperations& wanted, const PropertySetting& setting,
                       TypeId element) noexcept {
    using Kind = PropertySetting::Kind;
    if (wanted.kind == Kind::enumeration) return setting.kind == Kind::enumeration && setting.type == element;
    return wanted.kind == setting.kind || (wanted.kind == Kind::real && setting.kind == Kind::integer);
}

constexpr bool fits(const Facet& property, const PropertySetting& setting) {
    const PropertyOperations& wanted = *property.property;
    if (!wanted.is_list) return of_kind(wanted, setting, wanted.element);
    if (setting.kind != PropertySetting::Kind::list) return false;
    for (std::size_t i = 0; i < setting.list->size; ++i)
        if (!of_kind(wanted, setting.list->at(i), wanted.element)) return false;
    return true;
}

/// Returns the value in the unit of a range: seconds for a time.
constexpr double value_of(const PropertySetting& setting) noexcept {
    if (setting.kind == PropertySetting::Kind::real) return setting.real;
    const auto integer = static_cast<double>(setting.integer);
    return setting.kind == PropertySetting::Kind::duration ? integer * 1e-9 : integer;
}

/// Returns a value in the spelling of its row.
constexpr Sentence value_text(const PropertySetting& setting) {
    using Kind = PropertySetting::Kind;
    switch (setting.kind) {
    case Kind::real: return decimal(setting.real);
    case Kind::duration: return decimal(value_of(setting)).add(" s");
    case Kind::boolean: return Sentence{setting.integer != 0 ? "true" : "false"};
    case Kind::text: return Sentence{"\"", setting.text, "\""};
    case Kind::enumeration: return Sentence{setting.type->name, " ", setting.integer};
    case Kind::list: return Sentence{"a list of ", setting.list->size};
    case Kind::integer: break;
    }
    return Sentence{setting.integer};
}

constexpr std::string_view kind_text(PropertySetting::Kind kind) noexcept {
    using Kind = PropertySetting::Kind;
    switch (kind) {
    case Kind::real: return "a number";
    case Kind::integer: return "a whole number";
    case Kind::boolean: return "true or false";
    case Kind::text: return "a text";
    case Kind::enumeration: return "an enumeration";
    case Kind::duration:
    case Kind::list: break;
    }
    return "a time";
}

/// Says what the property is, and how to write its row.
constexpr Sentence wanted_text(const PropertyOperations& wanted) {
    using Kind = PropertySetting::Kind;
    if (wanted.is_list) {
        Sentence text{"a list"};
        if (wanted.least_size == wanted.most_size) text.add(" of ").add(wanted.most_size);
        return text.add(", each ")
            .add(kind_text(wanted.kind))
            .add("; write set<values>(...) with a constant array of them at namespace scope");
    }
    Sentence text{kind_text(wanted.kind)};
    switch (wanted.kind) {
    case Kind::real: return text.add("; write it like 2.5");
    case Kind::integer: return text.add("; write it like 2");
    case Kind::boolean: return text.add("; write true or false");
    case Kind::text: return text.add("; write it in quotes, like \"left\"");
    case Kind::enumeration: return text.add("; write a value of ").add(wanted.element->name);
    case Kind::duration:
    case Kind::list: break;
    }
    return text.add("; write it with its unit, like 2ms");
}

constexpr Sentence unknown_property(const ComponentRow& row, std::string_view name) {
    Nearest nearest{name};
    for (const auto& facet : row.type->facets)
        if (facet.kind == FacetKind::property) nearest.consider(facet.name);
    Sentence text = of_component(row.name, " has no property \"", name, "\"");
    detail::add_suggestion(text, nearest, "add it to the component's interface");
    return text;
}

/// Whether a port or a property of that type can hold the number exactly, except for the rounding of a float.
constexpr bool holds(const TypeTag& type, double number) noexcept {
    if (type.kind == ValueKind::real) {
        constexpr double most = std::numeric_limits<float>::max();
        return is_number(number) && (type.size == sizeof number || (number >= -most && number <= most));
    }
    if (type.kind == ValueKind::boolean) return number == 0 || number == 1;
    if (!type.arithmetic || type.size > 8) return false;
    double past = type.kind == ValueKind::integer ? 128 : 256; // the first number beyond one byte
    for (std::size_t bytes = 1; bytes < type.size; ++bytes) past *= 256;
    const double least = type.kind == ValueKind::integer ? -past : 0;
    if (!(number >= least && number < past)) return false;
    return number >= 0 ? number == static_cast<double>(static_cast<std::uint64_t>(number))
                       : number == static_cast<double>(static_cast<std::int64_t>(number));
}

/// Checks one value of the wanted kind: too large, too small or too long.
constexpr Sentence check_value(const ComponentRow& row, std::string_view name, const Facet& facet,
                               const PropertySetting& setting) {
    using Kind = PropertySetting::Kind;
    const PropertyOperations& wanted = *facet.property;
    const auto sets = [&] {
        return of_component(row.name, " sets property \"", name, "\" to ", value_text(setting),
                            ", which is ");
    };
    if (wanted.kind == Kind::text)
        return setting.text.size() <= wanted.most_characters ? Sentence{}
                                                             : sets()
                                                                   .add("longer than its ")
                                                                   .add(wanted.most_characters)
                                                                   .add(" characters; shorten it");
    if (wanted.kind == Kind::integer && (setting.integer < wanted.least || setting.integer > wanted.most))
        return sets().add("more than ").add(wanted.element->name).add(" holds; set a value it can hold");
    if (const std::size_t names = wanted.element->names.size();
        wanted.kind == Kind::enumeration && names != 0)
        if (setting.integer < 0 || static_cast<std::uint64_t>(setting.integer) >= names)
            return sets()
                .add("not one of the ")
                .add(names)
                .add(" named values of ")
                .add(wanted.element->name)
                .add("; set one of them");
    double value = value_of(setting);
    if (!is_number(value)) return sets().add("not a finite number; set a finite one");
    if (wanted.kind == Kind::real && !holds(*wanted.element, value))
        return sets().add("more than ").add(wanted.element->name).add(" holds; set a value it can hold");
    if (wanted.kind == Kind::real && wanted.element->size == sizeof(float)) value = static_cast<float>(value);
    if (range_of(facet).holds(value)) return {};
    Sentence text = sets();
    if (value < facet.range.low)
        text.add("under its least value ").add(decimal(facet.range.low));
    else
        text.add("over its greatest value ").add(decimal(facet.range.high));
    if (wanted.kind == Kind::duration) text.add(" s");
    return text.add("; set a value in its range, or widen range(...) in the interface of ")
        .add(row.type->tag->name);
}

constexpr Sentence check_setting(const ComponentRow& row, const PropertyRow& setting) {
    const std::size_t found = find_facet(row, setting.name);
    if (found == nowhere) return unknown_property(row, setting.name);
    const Facet& facet = row.type->facets[found];
    if (facet.kind == FacetKind::bag)
        return of_component(row.name, " sets \"", setting.name,
                            "\", which is a bag; set its properties, each by its full name");
    if (facet.kind != FacetKind::property)
        return of_component(row.name, " sets \"", setting.name, "\", which is ", to_text(facet.kind),
                            ", not a property; set one of its properties");
    const PropertyOperations& wanted = *facet.property;
    if (!fits(facet, setting.setting))
        return of_component(row.name, " sets property \"", setting.name, "\" to ",
                            value_text(setting.setting), ", but it is ", wanted_text(wanted));
    if (!wanted.is_list) return check_value(row, setting.name, facet, setting.setting);
    const ListSetting& list = *setting.setting.list;
    if (list.size < wanted.least_size || list.size > wanted.most_size)
        return of_component(row.name, " sets property \"", setting.name, "\" to a list of ", list.size,
                            wanted.least_size == wanted.most_size ? ", but it has " : ", but it has at most ",
                            wanted.most_size, "; correct the number of elements");
    for (std::size_t i = 0; i < list.size; ++i)
        if (Sentence fault = check_value(row, setting.name, facet, list.at(i)); !fault.empty()) return fault;
    return {};
}

constexpr Sentence check_settings(const ComponentRow& row) {
    if (row.too_many_settings)
        return of_component(row.name, " sets more than ", ComponentRow::max_settings,
                            " properties; give the others their default in the component");
    for (std::size_t i = 0; i < row.settings.size(); ++i) {
        const PropertyRow& setting = row.settings[i];
        for (std::size_t j = 0; j < i; ++j)
            if (same_text(row.settings[j].name, setting.name))
                return of_component(row.name, " sets property \"", setting.name, "\" twice; keep one");
        if (Sentence fault = check_setting(row, setting); !fault.empty()) return fault;
    }
    return {};
}

/// A setter and a getter are of a property of this component, and each property stands in its interface once:
/// otherwise nothing would say whose range counts.
constexpr Sentence check_setters(const ComponentRow& row) {
    const auto& facets = row.type->facets;
    const auto is_of = [&](std::size_t f, void* (*at)(void*, std::size_t) noexcept, std::size_t index) {
        return facets[f].kind == FacetKind::property && facets[f].at == at && facets[f].index == index;
    };
    for (std::size_t f = 0; f < facets.size(); ++f) {
        const Facet& facet = facets[f];
        if (facet.kind == FacetKind::property)
            for (std::size_t other = 0; other < f; ++other)
                if (is_of(other, facet.at, facet.index))
                    return of_component(row.name, ": its properties \"", facets[other].name, "\" and \"",
                                        facet.name,
                                        "\" use the same member; remove one of them from the interface of ",
                                        row.type->tag->name);
        if (facet.kind != FacetKind::command || facet.command->property == nullptr) continue;
        bool found = false;
        for (std::size_t other = 0; other < facets.size(); ++other)
            found = found || is_of(other, facet.command->property, 0);
        if (!found)
            return of_component(
                row.name, ": its command \"", facet.name,
                "\" sets or gets a member that is not one of its properties; add property<..>(..) to "
                "the interface of ",
                row.type->tag->name);
    }
    return {};
}

/// Checks that only bags put dots into a property's name, and that all properties together fit one
/// transaction.
constexpr Sentence check_bags(const ComponentRow& row) {
    std::size_t properties = 0;
    std::size_t bytes = 0;
    std::string_view bag{};
    std::size_t bag_ends = 0;
    for (std::size_t f = 0; f < row.type->facets.size(); ++f) {
        const Facet& facet = row.type->facets[f];
        if (facet.kind == FacetKind::bag && f >= bag_ends) bag = facet.name, bag_ends = f + 1 + facet.members;
        if (facet.kind != FacetKind::property) {
            if (f < bag_ends && facet.kind != FacetKind::bag)
                return of_component(row.name, ": its bag \"", bag, "\" holds \"", facet.name, "\", which is ",
                                    to_text(facet.kind), "; a bag holds properties and bags");
            continue;
        }
        if (f >= bag_ends && find_character(facet.name, '.') != std::string_view::npos)
            return of_component(row.name, ": its property \"", facet.name,
                                "\" has a dot in its name; put it into a bag(...) in ", row.type->tag->name);
        ++properties;
        bytes += PropertyTransaction::bytes_for(facet);
    }
    if (properties > PropertyTransaction::max_values || bytes > PropertyTransaction::max_bytes)
        return of_component(row.name, " has ", properties, " properties of ", bytes,
                            " bytes, but a transaction holds ", PropertyTransaction::max_values, " of ",
                            PropertyTransaction::max_bytes, "; divide the component");
    return {};
}

constexpr Sentence check_properties_file(const MachineView& m, const ComponentRow& row) {
    if (!row.has_properties_file) return {};
    const std::string_view name = row.properties.name;
    if (name.empty() || name.find('/') != std::string_view::npos || name == "." || name == "..")
        return of_component(row.name, ": its properties file \"", name,
                            "\" is not a plain file name; write one without a directory, which is the "
                            "board's properties_directory");
    bool has_properties = false;
    for (const Facet& facet : row.type->facets) has_properties |= facet.kind == FacetKind::property;
    if (!has_properties)
        return of_component(row.name, " has no properties but a properties file \"", name,
                            "\"; remove properties_file(...)");
    for (const ComponentRow& other : m.components) {
        if (&other == &row) break;
        if (other.has_properties_file && other.properties.name == name)
            return of_component(row.name, " has the properties file \"", name, "\" of component \"",
                                other.name, "\"; each needs a file of its own");
    }
    return {};
}

} // namespace tappet::checks
