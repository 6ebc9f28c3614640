// Properties, their bags and their transactions (thesis 4.7, 4.7.1): every value type, names in nested bags,
// and several values changed together or not at all.
#include "kernel/base/number.hpp"
#include "tests/kernel/component/every_property.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>
#include <vector>

namespace {

using namespace tappet;

using every::Arm;

const ComponentType& type = component_type<Arm>;

std::size_t index_of(std::string_view name) {
    for (std::size_t f = 0; f < type.facets.size(); ++f)
        if (type.facets[f].name == name) return f;
    throw std::string{"no facet of that name"};
}
const Facet& facet(std::string_view name) { return type.facets[index_of(name)]; }

PropertySetting real_setting(double value) { return {.kind = PropertySetting::Kind::real, .real = value}; }
PropertySetting list_setting(const ListSetting& list) {
    return {.kind = PropertySetting::Kind::list, .list = &list};
}

struct Proposed : testing::Test {
    Arm arm;
    PropertyTransaction transaction;
    Proposed() { transaction.begin("arm", type, &arm); }
    void set(std::string_view name, const PropertySetting& to) {
        std::byte* place = transaction.change(index_of(name));
        ASSERT_NE(place, nullptr) << name;
        facet(name).property->set(place, to);
    }
    void real(std::string_view name, double value) { set(name, real_setting(value)); }
    std::string range_fault(std::string_view name) {
        return std::string{check_range(facet(name), transaction.change(index_of(name))).view()};
    }
};

struct Ends {
    Property<float> share{0.05f};
    Property<Duration> pause{1ms};
    static constexpr auto interface() {
        return facets(property<&Ends::share>("share", "", "of all", range(0.05, 0.1)),
                      property<&Ends::pause>("pause", "s", "between two", range(0.009, 0.018)));
    }
};

TEST(Range, includes_both_ends_despite_rounding) {
    const auto fault = [](std::size_t facet, const auto& value) {
        const auto* const bytes = static_cast<const std::byte*>(static_cast<const void*>(&value));
        return std::string{check_range(component_type<Ends>.facets[facet], bytes).view()};
    };
    EXPECT_EQ(fault(0, 0.1f), "");
    EXPECT_EQ(fault(0, 0.05f), "");
    EXPECT_NE(fault(0, std::nextafter(0.1f, 1.0f)), "");
    EXPECT_EQ(fault(1, Duration{9ms}), "");
    EXPECT_EQ(fault(1, Duration{18ms}), "");
    EXPECT_NE(fault(1, Duration{18ms + 1ns}), "");
    EXPECT_NE(fault(1, Duration{9ms - 1ns}), "");
}

TEST(Bag, qualifies_the_name_of_each_property) {
    std::vector<std::string> names;
    for (const Facet& each : type.facets) names.emplace_back(each.name);
    const std::vector<std::string> expected{
        "angle",         "gains",         "gains.roll", "gains.roll.p", "gains.roll.i", "gains.pitch",
        "gains.pitch.p", "gains.pitch.i", "gains.all",  "limits",       "limits.low",   "limits.high",
        "scale",         "small",         "word",       "steps",        "huge",         "serial",
        "reversed",      "filter",        "label",      "side",         "code",         "offsets",
        "marks",         "axis",          "turn"};
    EXPECT_EQ(names, expected);
}

TEST(Bag, counts_its_facets) {
    EXPECT_EQ(facet("gains").kind, FacetKind::bag);
    EXPECT_EQ(facet("gains").members, 7u);
    EXPECT_EQ(facet("gains.roll").members, 2u);
    EXPECT_EQ(facet("limits").members, 2u);
    EXPECT_EQ(facet("gains.roll").doc, "of the wrist");
    EXPECT_EQ(facet("gains.pitch.i").unit, "N/(deg s)");
}

TEST(Bag, of_one_type_used_twice_reaches_two_members) {
    Arm arm;
    EXPECT_EQ(facet("gains.roll.p").at(&arm, 0), &arm.roll.p);
    EXPECT_EQ(facet("gains.pitch.p").at(&arm, 0), &arm.pitch.p);
    EXPECT_EQ(facet("gains.pitch.i").at(&arm, 0), &arm.pitch.i);
    EXPECT_EQ(facet("gains.all").at(&arm, 0), &arm.gain);
    EXPECT_EQ(facet("limits.high").at(&arm, 0), &arm.limits.high);
}

TEST_F(Proposed, values_of_every_type_arrive_together) {
    using Kind = PropertySetting::Kind;
    static constexpr std::array<double, 3> three{0.5, -0.5, 1.0};
    static constexpr ListSetting list{3, [](std::size_t i) { return real_setting(three[i]); }};
    real("gains.roll.p", 4.25);
    set("gains.pitch.p", {.kind = Kind::integer, .integer = 7}); // a whole number is a number
    real("scale", 0.25);
    set("steps", {.kind = Kind::integer, .integer = -12});
    set("small", {.kind = Kind::integer, .integer = -128});
    set("word", {.kind = Kind::integer, .integer = 65535});
    set("reversed", {.kind = Kind::boolean, .integer = 0});
    set("filter", {.kind = Kind::duration, .integer = 5'000'000});
    set("label", {.kind = Kind::text, .text = "right"});
    set("side", {.kind = Kind::enumeration, .integer = 2});
    set("offsets", list_setting(list));
    set("axis", list_setting(list));
    EXPECT_EQ(arm.roll.p.get(), 1.0) << "nothing takes effect before it is committed";
    transaction.commit();
    EXPECT_EQ(transaction.state(), PropertyTransaction::State::done);
    EXPECT_EQ(arm.roll.p.get(), 4.25);
    EXPECT_EQ(arm.pitch.p.get(), 7.0);
    EXPECT_EQ(arm.scale.get(), 0.25f);
    EXPECT_EQ(arm.steps.get(), -12);
    EXPECT_EQ(arm.small.get(), -128);
    EXPECT_EQ(arm.word.get(), 65535);
    EXPECT_FALSE(arm.reversed.get());
    EXPECT_EQ(arm.filter.get(), 5ms);
    EXPECT_EQ(arm.label.get().view(), "right");
    EXPECT_EQ(arm.side.get(), every::Side::both);
    ASSERT_EQ(arm.offsets.get().size(), 3u);
    EXPECT_EQ(arm.offsets.get()[1], -0.5);
    EXPECT_EQ(arm.axis.get(), (Eigen::Vector3d{0.5, -0.5, 1.0}));
    EXPECT_EQ(arm.roll.i.get(), 0.5) << "what was not proposed stays";
    EXPECT_EQ(arm.changes, 1) << "the component is told once, of all";
}

TEST_F(Proposed, values_are_seen_together_by_the_component_that_is_asked) {
    real("limits.low", 5.0);  // above the present high ...
    real("limits.high", 6.0); // ... and below the proposed one
    transaction.commit();
    EXPECT_EQ(transaction.state(), PropertyTransaction::State::done);
    EXPECT_EQ(arm.limits.low.get(), 5.0);
    EXPECT_EQ(arm.limits.high.get(), 6.0);
}

TEST_F(Proposed, values_change_nothing_when_the_component_refuses) {
    real("gains.roll.p", 9.0);
    real("limits.low", 5.0);
    transaction.commit();
    EXPECT_EQ(transaction.state(), PropertyTransaction::State::refused);
    EXPECT_EQ(transaction.refusal().view(), "low is above high");
    EXPECT_EQ(arm.roll.p.get(), 1.0) << "the good one of two goes with the bad one";
    EXPECT_EQ(arm.limits.low.get(), -1.0);
    EXPECT_EQ(arm.changes, 0);
}

TEST_F(Proposed, value_given_twice_counts_once_with_its_last_value) {
    real("gains.roll.p", 2.0);
    real("gains.roll.p", 3.0);
    EXPECT_EQ(transaction.values().size(), 1u);
    transaction.commit();
    EXPECT_EQ(arm.roll.p.get(), 3.0);
}

TEST_F(Proposed, values_obey_ranges_in_numbers_times_and_every_element) {
    real("gains.roll.p", 10.0);
    EXPECT_EQ(range_fault("gains.roll.p"), "");
    real("gains.roll.p", std::nextafter(10.0, 11.0));
    EXPECT_THAT(range_fault("gains.roll.p"), testing::HasSubstr("over its greatest value 10"));
    real("gains.roll.p", -0.001);
    EXPECT_THAT(range_fault("gains.roll.p"), testing::HasSubstr("under its least value 0"));
    real("gains.roll.p", std::numeric_limits<double>::quiet_NaN());
    EXPECT_THAT(range_fault("gains.roll.p"), testing::HasSubstr("is not a finite number"));
    real("limits.low", std::numeric_limits<double>::quiet_NaN());
    EXPECT_NE(range_fault("limits.low"), "") << "also where every number is allowed";
    set("filter", {.kind = PropertySetting::Kind::duration, .integer = 500'000'001});
    EXPECT_THAT(range_fault("filter"), testing::HasSubstr("over its greatest value 0.5 s"));
    static constexpr ListSetting list{2, [](std::size_t i) { return real_setting(i == 0 ? 5.0 : 5.5); }};
    set("offsets", list_setting(list));
    EXPECT_THAT(range_fault("offsets"), testing::HasSubstr("element 1 is over its greatest value 5"));
}

/// Properties without a range, or with an open one.
struct Free {
    Property<double> gain{1.0}, time{1.0};
    Property<float> scale{1.0f};
    Property<Eigen::Matrix2d> turn{Eigen::Matrix2d::Identity()};
    Property<Sequence<double, 4>> gauges;
    static constexpr auto interface() {
        return facets(property<&Free::gain>("gain", "", "of the loop"),
                      property<&Free::time>("time", "s", "of the filter",
                                            range(0.0, std::numeric_limits<double>::infinity())),
                      property<&Free::scale>("scale", "", "of the drawing"),
                      property<&Free::turn>("turn", "", "of the tool"),
                      property<&Free::gauges>("gauges", "mm", "of the joints"));
    }
};

TEST(PropertyWithoutRange, accepts_only_numbers_in_each_element) {
    using Real = std::numeric_limits<double>;
    static std::array<double, 4> four{};
    static constexpr ListSetting list{4, [](std::size_t i) { return real_setting(four[i]); }};
    Free free;
    PropertyTransaction transaction;
    transaction.begin("free", component_type<Free>, &free);
    for (const double value : {Real::quiet_NaN(), Real::infinity(), -Real::infinity(), 1e300, -2.5})
        for (std::size_t f = 0; f < component_type<Free>.facets.size(); ++f) {
            const Facet& each = component_type<Free>.facets[f];
            if (value < 0.0 && is_number(value) && each.name == "time") continue;
            four = {1.0, 2.0, value, 4.0};
            std::byte* const place = transaction.change(f);
            each.property->set(place, each.property->is_list ? list_setting(list) : real_setting(value));
            const bool is_good = is_number(each.name == "scale" ? static_cast<float>(value) : value);
            const Sentence fault = check_range(each, place);
            EXPECT_EQ(fault.empty(), is_good) << each.name << " = " << value;
            if (is_good) continue;
            EXPECT_EQ(fault.view(),
                      Sentence("property \"", each.name, "\": ", each.property->is_list ? "element 2 " : "",
                               "is not a finite number; propose a finite one")
                          .view());
        }
}

TEST_F(Proposed, transaction_accepts_only_properties) {
    EXPECT_EQ(transaction.change(index_of("angle")), nullptr);
    EXPECT_EQ(transaction.change(index_of("gains")), nullptr);
}

TEST_F(Proposed, transaction_runs_in_the_engine_that_serves_its_message) {
    real("gains.roll.p", 2.5);
    const Message message = transaction.commit_message(3);
    EXPECT_EQ(transaction.state(), PropertyTransaction::State::posted);
    EXPECT_EQ(message.id, 3u);
    EXPECT_FALSE(transaction.finished());
    message.run(message.object, message.arguments.data());
    EXPECT_TRUE(transaction.finished());
    EXPECT_EQ(arm.roll.p.get(), 2.5);
}

TEST_F(Proposed, values_can_capture_every_property) {
    arm.roll.p.set(8.0);
    arm.label.set("both");
    transaction.change_all();
    transaction.capture();
    EXPECT_EQ(transaction.values().size(), 22u);
    Arm other;
    PropertyTransaction copy;
    copy.begin("other", type, &other);
    for (const ProposedValue& each : transaction.values())
        std::memcpy(copy.change(each.facet), each.value, each.size);
    copy.commit();
    EXPECT_EQ(other.roll.p.get(), 8.0);
    EXPECT_EQ(other.label.get().view(), "both");
    EXPECT_EQ(other.axis.get(), arm.axis.get());
}

TEST(Sequence, refuses_more_elements_than_its_capacity) {
    const PropertyOperations& offsets = *facet("offsets").property;
    Sequence<double, 4> value;
    auto* bytes = reinterpret_cast<std::byte*>(&value);
    EXPECT_TRUE(offsets.resize(bytes, 4));
    EXPECT_FALSE(offsets.resize(bytes, 5));
    EXPECT_EQ(value.size(), 4u);
    const PropertyOperations& axis = *facet("axis").property;
    Eigen::Vector3d vector;
    EXPECT_TRUE(axis.resize(reinterpret_cast<std::byte*>(&vector), 3));
    EXPECT_FALSE(axis.resize(reinterpret_cast<std::byte*>(&vector), 2));
}

} // namespace
