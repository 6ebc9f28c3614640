// A component with a property of every kind, for code that reads and writes them.
#pragma once

#include "kernel/component/component.hpp"
#include "kernel/component/property_transaction.hpp"

#include <Eigen/Core>

namespace tappet::every {

enum class Side : std::uint8_t { left, right, both };
enum class Code : std::int16_t {};

} // namespace tappet::every

template <>
inline constexpr auto tappet::names_of<tappet::every::Side> =
    std::array<std::string_view, 3>{"left", "right", "both"};

namespace tappet::every {

struct Pid {
    Property<double> p{1.0};
    Property<double> i{0.5};
    static constexpr auto interface() {
        return facets(property<&Pid::p>("p", "N/deg", "proportional", range(0, 10)),
                      property<&Pid::i>("i", "N/(deg s)", "integral", range(0, 10)));
    }
};

struct Limits {
    Property<double> low{-1.0};
    Property<double> high{1.0};
    static constexpr auto interface() {
        return facets(property<&Limits::low>("low", "N", "least force"),
                      property<&Limits::high>("high", "N", "greatest force"));
    }
};

struct Arm {
    Output<double> angle;
    Pid roll, pitch;
    Limits limits;
    Property<double> gain{1.5};
    Property<float> scale{2.0f};
    Property<std::int8_t> small{4};
    Property<std::uint16_t> word{5};
    Property<std::int32_t> steps{3};
    Property<std::int64_t> huge{-9};
    Property<std::uint64_t> serial{7};
    Property<bool> reversed{true};
    Property<Duration> filter{2ms};
    Property<Text<12>> label{"left"};
    Property<Side> side{Side::right};
    Property<Code> code{Code{12}};
    Property<Sequence<double, 4>> offsets;
    Property<Sequence<Text<4>, 2>> marks;
    Property<Eigen::Vector3d> axis{Eigen::Vector3d{0, 0, 1}};
    Property<Eigen::Matrix2d> turn{Eigen::Matrix2d{{1, 2}, {3, 4}}};

    int changes = 0;
    Sentence accepts(const Proposal& proposal) const noexcept TAPPET_REALTIME {
        if (proposal.of(limits.low) > proposal.of(limits.high)) return Sentence{"low is above high"};
        return {};
    }
    void changed() noexcept TAPPET_REALTIME { ++changes; }

    static constexpr auto interface() {
        return facets(
            output<&Arm::angle>("angle", "deg", "of the arm"),
            bag("gains", "of both axes", bag<&Arm::roll>("roll", "of the wrist"),
                bag<&Arm::pitch>("pitch", "of the elbow"), property<&Arm::gain>("all", "", "of all")),
            bag<&Arm::limits>("limits", "of the force"), property<&Arm::scale>("scale", "", "of the drawing"),
            property<&Arm::small>("small", "", "a byte"), property<&Arm::word>("word", "", "two bytes"),
            property<&Arm::steps>("steps", "", "per turn"),
            property<&Arm::huge>("huge", "", "of eight bytes"),
            property<&Arm::serial>("serial", "", "number"),
            property<&Arm::reversed>("reversed", "", "mounted so"),
            property<&Arm::filter>("filter", "s", "time constant", range(0, 0.5)),
            property<&Arm::label>("label", "", "on the plate, with < and &"),
            property<&Arm::side>("side", "", "where it stands"),
            property<&Arm::code>("code", "", "of the maker"),
            property<&Arm::offsets>("offsets", "mm", "of the joints", range(-5, 5)),
            property<&Arm::marks>("marks", "", "on the case"),
            property<&Arm::axis>("axis", "", "of the tool", range(-1, 1)),
            property<&Arm::turn>("turn", "", "of the base"));
    }
};

/// Whether two components have equal properties, compared by their stored bytes.
inline bool same_properties(Arm& a, Arm& b) {
    PropertyTransaction one, other;
    one.begin("a", component_type<Arm>, &a);
    other.begin("b", component_type<Arm>, &b);
    one.change_all(), other.change_all();
    one.capture(), other.capture();
    for (std::size_t i = 0; i < one.values().size(); ++i)
        if (std::memcmp(one.values()[i].value, other.values()[i].value, one.values()[i].size) != 0)
            return false;
    return one.values().size() == other.values().size();
}

} // namespace tappet::every
