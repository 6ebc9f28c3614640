// How an interface spells its properties and the bags that hold them (thesis 4.7.1).
//
//     struct Pid {                                            // a bag of its own, used twice below
//         Property<double> p{1.0}, i{0.0};
//         static constexpr auto interface() {
//             return facets(property<&Pid::p>("p", "N/deg", "proportional gain", range(0, 10)),
//                           property<&Pid::i>("i", "N/(deg s)", "integral gain", range(0, 10)));
//         }
//     };
//     struct Arm {
//         Pid roll, pitch;
//         static constexpr auto interface() {
//             return facets(bag("gains", "of the two axes", bag<&Arm::roll>("roll", "of the wrist"),
//                               bag<&Arm::pitch>("pitch", "of the elbow")));
//         }
//     };                                                      // set("gains.roll.p", 2.5)
#pragma once

#include "kernel/component/facet.hpp"

#include <array>
#include <utility>

namespace tappet {

constexpr Range range(double low, double high) noexcept { return {low, high}; }

namespace detail {

template <auto Member>
struct MemberOf;
template <class C, class M, M C::* Member>
struct MemberOf<Member> {
    using Component = C;
    using Type = M;
    static void* at(void* component, std::size_t) noexcept { return &(static_cast<C*>(component)->*Member); }
};

template <PropertyScalar T>
inline constexpr PropertySetting::Kind property_kind =
    std::same_as<T, bool>       ? PropertySetting::Kind::boolean
    : std::floating_point<T>    ? PropertySetting::Kind::real
    : std::same_as<T, Duration> ? PropertySetting::Kind::duration
    : is_text<T>                ? PropertySetting::Kind::text
    : std::is_enum_v<T>         ? PropertySetting::Kind::enumeration
                                : PropertySetting::Kind::integer;

template <PropertyScalar T>
constexpr void assign(T& target, const PropertySetting& setting) noexcept TAPPET_REALTIME {
    if constexpr (std::floating_point<T>)
        target = static_cast<T>(setting.kind == PropertySetting::Kind::real
                                    ? setting.real
                                    : static_cast<double>(setting.integer));
    else if constexpr (std::same_as<T, bool>)
        target = setting.integer != 0;
    else if constexpr (is_text<T>)
        static_cast<void>(target.assign(setting.text));
    else
        target = static_cast<T>(setting.integer);
}

template <PropertyScalar T>
constexpr double number_of(const T& value) noexcept TAPPET_REALTIME {
    if constexpr (std::same_as<T, Duration>)
        return to_seconds(value);
    else if constexpr (is_text<T>)
        return 0;
    else
        return static_cast<double>(value);
}

template <class T>
constexpr void add_limits(PropertyOperations& operations) noexcept {
    if constexpr (std::integral<T> && !std::same_as<T, bool>) {
        operations.least =
            std::signed_integral<T> ? static_cast<std::int64_t>(std::numeric_limits<T>::min()) : 0;
        operations.most = static_cast<std::int64_t>(
            std::min<std::uint64_t>(std::numeric_limits<T>::max(), std::numeric_limits<std::int64_t>::max()));
    }
    if constexpr (is_text<T>) operations.most_characters = sizeof(T::characters);
}

template <PropertyValue T>
struct PropertyAccess {
    static constexpr bool is_list = !PropertyScalar<T>;
    using Element = std::conditional_t<is_list, typename ListElement<T>::Type, T>;
    static T& value(std::byte* bytes) noexcept TAPPET_REALTIME { return *reinterpret_cast<T*>(bytes); }
    static const T& value(const std::byte* bytes) noexcept TAPPET_REALTIME {
        return *reinterpret_cast<const T*>(bytes);
    }
    static std::size_t size(const std::byte* bytes) noexcept TAPPET_REALTIME {
        if constexpr (is_sequence<T>)
            return std::min(value(bytes).used, T::capacity());
        else if constexpr (is_list)
            return static_cast<std::size_t>(T::SizeAtCompileTime);
        else
            return 1;
    }
    static bool resize(std::byte* bytes, std::size_t size) noexcept TAPPET_REALTIME {
        if constexpr (is_sequence<T>) {
            if (size > T::capacity()) return false;
            for (std::size_t i = size; i < T::capacity(); ++i) value(bytes).items[i] = Element{};
            value(bytes).used = size;
            return true;
        } else {
            return size == PropertyAccess::size(bytes);
        }
    }
    static std::byte* at(std::byte* bytes, std::size_t i) noexcept TAPPET_REALTIME {
        if constexpr (is_sequence<T>)
            return reinterpret_cast<std::byte*>(&value(bytes).items[i]);
        else
            return bytes + i * sizeof(Element);
    }
    static double number(const std::byte* bytes, std::size_t i) noexcept TAPPET_REALTIME {
        return number_of(*reinterpret_cast<const Element*>(at(const_cast<std::byte*>(bytes), i)));
    }
    static void set(std::byte* bytes, const PropertySetting& setting) noexcept {
        if constexpr (is_list) {
            static_cast<void>(resize(bytes, setting.list->size));
            for (std::size_t i = 0; i < size(bytes); ++i)
                assign(*reinterpret_cast<Element*>(at(bytes, i)), setting.list->at(i));
        } else {
            assign(value(bytes), setting);
        }
    }
    static constexpr PropertyOperations operations = [] {
        PropertyOperations o{.kind = property_kind<Element>,
                             .is_list = is_list,
                             .element = type_id<Element>,
                             .set = &set,
                             .size = &size,
                             .resize = &resize,
                             .at = &at,
                             .number = &number};
        if constexpr (is_sequence<T>)
            o.least_size = 0, o.most_size = T::capacity();
        else if constexpr (is_list)
            o.least_size = o.most_size = static_cast<std::size_t>(T::SizeAtCompileTime);
        add_limits<Element>(o);
        return o;
    }();
    static_assert(copied_as_bytes<T> && sizeof(Property<T>) == sizeof(T));
};

constexpr void apply(Facet& facet, Range within) noexcept { facet.range = within; }

/// The number of facets in one item of a list of facets: a facet, or a bag of them.
template <class F>
inline constexpr std::size_t facet_count = 1;
template <std::size_t N>
inline constexpr std::size_t facet_count<std::array<Facet, N>> = N;

template <std::size_t N>
constexpr void put(std::array<Facet, N>& into, std::size_t& at, const Facet& each) noexcept {
    into[at++] = each;
}
template <std::size_t N, std::size_t M>
constexpr void put(std::array<Facet, N>& into, std::size_t& at, const std::array<Facet, M>& each) noexcept {
    for (const Facet& facet : each) into[at++] = facet;
}

/// The facets as the component spells them: a facet in a bag only by its own name.
template <class T>
inline constexpr auto spelled_facets = T::interface();

/// The names of facets in bags, "gains.roll.p", as text that lives as long as the program.
template <class T>
struct BagNames {
    static constexpr std::size_t max_depth = 8;
    static constexpr auto& spelled = spelled_facets<T>;

    struct Walk {
        std::array<std::string_view, max_depth> open{}; ///< the bags around the facet
        std::array<std::size_t, max_depth> left{};
        std::size_t depth = 0;
        constexpr void close_full() noexcept {
            while (depth != 0 && left[depth - 1] == 0) --depth;
        }
        /// Deeper than max_depth does not compile.
        constexpr void pass(const Facet& facet) noexcept {
            for (std::size_t i = 0; i < depth; ++i) --left[i];
            if (facet.kind == FacetKind::bag) open[depth] = facet.name, left[depth++] = facet.members;
            close_full();
        }
    };
    static constexpr std::size_t characters_needed = [] {
        std::size_t needed = 0;
        Walk walk;
        for (const Facet& facet : spelled) {
            if (walk.depth != 0) {
                needed += facet.name.size();
                for (std::size_t i = 0; i < walk.depth; ++i) needed += walk.open[i].size() + 1;
            }
            walk.pass(facet);
        }
        return needed;
    }();
    static constexpr auto characters = [] {
        std::array<char, characters_needed> text{};
        std::size_t at = 0;
        const auto add = [&](std::string_view piece) {
            for (const char character : piece) text[at++] = character;
        };
        Walk walk;
        for (const Facet& facet : spelled) {
            if (walk.depth != 0) {
                for (std::size_t i = 0; i < walk.depth; ++i) add(walk.open[i]), add(".");
                add(facet.name);
            }
            walk.pass(facet);
        }
        return text;
    }();
    static constexpr auto facets = [] {
        auto named = spelled;
        std::size_t at = 0;
        Walk walk;
        for (Facet& facet : named) {
            const Facet own = facet;
            if (walk.depth != 0) {
                std::size_t length = own.name.size();
                for (std::size_t i = 0; i < walk.depth; ++i) length += walk.open[i].size() + 1;
                facet.name = {characters.data() + at, length};
                at += length;
            }
            walk.pass(own);
        }
        return named;
    }();
};

template <std::size_t N>
consteval bool has_bags(const std::array<Facet, N>& facets) {
    for (const Facet& facet : facets)
        if (facet.kind == FacetKind::bag) return true;
    return false;
}

template <class T>
constexpr const auto& full_facets() noexcept {
    if constexpr (has_bags(spelled_facets<T>))
        return BagNames<T>::facets;
    else
        return spelled_facets<T>;
}

/// The facets of a member that is a struct of properties, reached through that member.
template <auto Member>
struct BagMember {
    using Struct = typename MemberOf<Member>::Type;
    template <std::size_t I>
    static void* at(void* component, std::size_t index) noexcept {
        return spelled_facets<Struct>[I].at(MemberOf<Member>::at(component, 0), index);
    }
    template <std::size_t... I>
    static constexpr auto facets(std::index_sequence<I...>) {
        auto inner = spelled_facets<Struct>;
        ((inner[I].at = inner[I].at == nullptr ? nullptr : &at<I>), ...);
        return inner;
    }
};

} // namespace detail

template <auto Member, class... Options>
constexpr Facet property(std::string_view name, std::string_view unit, std::string_view doc,
                         Options... options) {
    using M = detail::MemberOf<Member>;
    using T = typename M::Type::Value;
    Facet facet{.name = name,
                .unit = unit,
                .doc = doc,
                .kind = FacetKind::property,
                .type = type_id<T>,
                .at = &M::at,
                .property = &detail::PropertyAccess<T>::operations};
    (detail::apply(facet, options), ...);
    return facet;
}

/// A bag of properties and bags; their names are prefixed by its own and a dot.
template <class... Members>
constexpr auto bag(std::string_view name, std::string_view doc, const Members&... members) {
    constexpr std::size_t count = (std::size_t{0} + ... + detail::facet_count<Members>);
    std::array<Facet, count + 1> all{};
    all[0] = {
        .name = name, .doc = doc, .kind = FacetKind::bag, .type = type_id<Arguments<>>, .members = count};
    std::size_t at = 1;
    (detail::put(all, at, members), ...);
    return all;
}

/// A bag that is a struct of properties with an interface of its own, as a member of the component.
template <auto Member>
constexpr auto bag(std::string_view name, std::string_view doc) {
    using Struct = typename detail::MemberOf<Member>::Type;
    constexpr std::size_t count = detail::spelled_facets<Struct>.size();
    return bag(name, doc, detail::BagMember<Member>::facets(std::make_index_sequence<count>{}));
}

} // namespace tappet
