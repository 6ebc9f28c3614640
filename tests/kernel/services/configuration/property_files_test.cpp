// A machine with property files (thesis 4.7.1): read while it is configured, so that a wrong file prevents
// arming; changed while it runs; saved while it runs and after it has stopped.
#include "kernel/services/configuration/property_files.hpp"

#include "kernel/services/configuration/property_saving.hpp"
#include "tests/kernel/machine/virtual_rig.hpp"

#include <gmock/gmock.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <limits>
#include <memory>
#include <string>
#include <vector>

namespace tappet {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::StartsWith;

struct Band {
    Property<double> low{10.0};
    Property<double> high{20.0};
    static constexpr auto interface() {
        return facets(property<&Band::low>("low", "N", "least", range(0, 1000)),
                      property<&Band::high>("high", "N", "greatest", range(0, 1000)));
    }
};

/// Its band must stay in order; it counts how often it was not.
struct Tension {
    Band band;
    Property<double> gain{1.0}, offset{0.0};
    Property<Sequence<double, 4>> taps;
    std::uint64_t steps = 0;
    std::uint64_t out_of_order = 0;
    int changes = 0;
    double gain_when_configured = 0;
    Event<> torn;
    bool in_step = false;
    bool changed_in_a_step = false;

    Sentence accepts(const Proposal& proposal) const noexcept TAPPET_REALTIME {
        if (proposal.of(band.low) < proposal.of(band.high)) return {};
        return Sentence{"band.low is not under band.high; spread them"};
    }
    void changed() noexcept TAPPET_REALTIME { ++changes, changed_in_a_step |= in_step; }
    Sentence configure(Setup&) {
        gain_when_configured = gain.get();
        return {};
    }
    void relax() noexcept TAPPET_REALTIME {}
    void step(const Cycle&) noexcept TAPPET_REALTIME {
        in_step = true;
        ++steps;
        out_of_order += band.low.get() < band.high.get() ? 0u : 1u;
        in_step = false;
    }
    static constexpr auto interface() {
        return facets(bag<&Tension::band>("band", "that is wanted"),
                      property<&Tension::gain>("gain", "", "of the loop", range(0, 10)),
                      property<&Tension::offset>("offset", "N", "of the cell; it has no range"),
                      property<&Tension::taps>("taps", "", "of the filter"),
                      event<&Tension::torn>("torn", "an end broke"),
                      operation<&Tension::relax>("relax", "lets go"));
    }
};

// clang-format off
constexpr auto table = machine("kept",
    components(
        component<Tension>("warp", set("gain", 2.0), properties_file("warp.cpf")),
        component<Tension>("weft", properties_file("weft.cpf", optional)),
        component<Tension>("edge", set("band.low", 15.0)),
        component<Onlooker>("office")),
    activities(
        activity("motion", every(1ms), budget(50us), runs("warp")),
        activity("logic",  on_work(), at_most(4, 1ms), deadline(1ms), budget(50us), runs("weft", "edge")),
        activity("office", every(100ms), not_real_time, runs("office"))),
    connections(), reactions(when("warp.torn", tell("weft.relax"))), behaviours());
constexpr auto refused_table = machine("refused",
    components(component<Tension>("edge", set("band.low", 25.0))),
    activities(activity("motion", every(1ms), budget(50us), runs("edge"))),
    connections(), reactions(), behaviours());
// clang-format on
constexpr std::size_t motion = 0, office = 2;

std::string cpf(const std::string& members) { return "<properties>\n" + members + "\n</properties>\n"; }
std::string real(const std::string& name, const std::string& value) {
    return "<simple name=\"" + name + "\" type=\"double\"><value>" + value + "</value></simple>";
}
std::string band(const std::string& members) {
    return "<struct name=\"band\" type=\"\">" + members + "</struct>";
}

struct PropertyFilesOfAMachine : testing::Test, PlacedRig<table> {
    std::filesystem::path directory;
    std::string directory_name;
    std::unique_ptr<PropertyFiles> files;

    PropertyFilesOfAMachine() {
        std::string pattern = (std::filesystem::temp_directory_path() / "tappet-properties-XXXXXX").string();
        directory_name = mkdtemp(pattern.data());
        directory = directory_name;
        files = std::make_unique<PropertyFiles>(directory_name);
        instance.read_properties_from(files->store());
    }
    ~PropertyFilesOfAMachine() override { std::filesystem::remove_all(directory); }

    void put(const std::string& name, const std::string& text) const {
        std::ofstream{directory / name} << text;
    }
    [[nodiscard]] std::string get(const std::string& name) const {
        std::ifstream file{directory / name};
        return {std::istreambuf_iterator<char>{file}, {}};
    }
    [[nodiscard]] bool there(const std::string& name) const {
        return std::filesystem::exists(directory / name);
    }
    std::string configure() {
        const auto configured = instance.configure({});
        return configured ? "" : std::string{configured.error().view()};
    }
    Tension& tension(std::string_view name) { return the<Tension>(name); }
    void change(PropertyTransaction& in, std::string_view name, double value) {
        std::memcpy(in.change(find_facet(table.view().components[0], name)), &value, sizeof value);
    }
};

TEST_F(PropertyFilesOfAMachine, are_read_before_configure_and_override_the_row) {
    put("warp.cpf", cpf(real("gain", "3.5") + band(real("low", "100") + real("high", "200"))));
    ASSERT_EQ(configure(), "");
    EXPECT_EQ(tension("warp").gain_when_configured, 3.5);
    EXPECT_EQ(tension("warp").band.low.get(), 100.0);
    EXPECT_EQ(tension("warp").band.high.get(), 200.0) << "neither alone would be in order";
    EXPECT_EQ(tension("warp").changes, 1);
    EXPECT_EQ(tension("edge").band.low.get(), 15.0);
}

TEST_F(PropertyFilesOfAMachine, are_told_where_they_differ_from_the_row) {
    put("warp.cpf", cpf(real("gain", "3.5") + band(real("low", "100") + real("high", "200"))));
    testing::internal::CaptureStdout();
    ASSERT_EQ(configure(), "");
    EXPECT_EQ(testing::internal::GetCapturedStdout(),
              "component \"warp\": \"gain\" is 3.5 from its file \"warp.cpf\", not 2 as its row sets; remove "
              "it from the "
              "file, or set the same\n")
        << "no row sets the band";
}

TEST_F(PropertyFilesOfAMachine, are_silent_where_they_repeat_the_row) {
    put("warp.cpf", cpf(real("gain", "2.0")));
    testing::internal::CaptureStdout();
    ASSERT_EQ(configure(), "");
    EXPECT_EQ(testing::internal::GetCapturedStdout(), "");
}

TEST_F(PropertyFilesOfAMachine, leave_unmentioned_properties_to_the_row) {
    put("warp.cpf", cpf(""));
    ASSERT_EQ(configure(), "");
    EXPECT_EQ(tension("warp").gain.get(), 2.0);
}

TEST_F(PropertyFilesOfAMachine, may_be_missing_only_where_the_row_allows_it) {
    const std::string said = configure();
    EXPECT_THAT(said, AllOf(StartsWith(directory_name + "/warp.cpf: component \"warp\""),
                            HasSubstr("is missing"), HasSubstr("--properties")));
}

TEST_F(PropertyFilesOfAMachine, prevent_arming_when_they_are_invalid) {
    put("warp.cpf", cpf("\n" + real("gian", "3.5")));
    EXPECT_THAT(configure(), AllOf(StartsWith(directory_name + "/warp.cpf:3: component \"warp\": "),
                                   HasSubstr("did you mean \"gain\"?")));
    put("warp.cpf", cpf(real("gain", "11")));
    EXPECT_THAT(configure(), HasSubstr("over its greatest value 10"));
    put("warp.cpf", "<properties>");
    EXPECT_THAT(configure(), HasSubstr("malformed"));
    put("warp.cpf", cpf(""));
    put("weft.cpf", cpf(real("gain", "eleven")));
    EXPECT_THAT(configure(), StartsWith(directory_name + "/weft.cpf:2: component \"weft\": "))
        << "one that may be missing may not be wrong";
}

TEST_F(PropertyFilesOfAMachine, prevent_arming_when_the_component_rejects_them) {
    put("warp.cpf", cpf(band(real("low", "30"))));
    EXPECT_THAT(configure(), AllOf(StartsWith("component \"warp\" refuses its properties"),
                                   HasSubstr("warp.cpf"), HasSubstr("band.low is not under band.high")));
}

TEST_F(PropertyFilesOfAMachine, are_required_even_in_a_start_up_that_reads_none) {
    instance.read_properties_from({});
    EXPECT_THAT(configure(), HasSubstr("this start-up reads none"));
}

TEST_F(PropertyFilesOfAMachine, need_a_directory_that_exists) {
    PropertyFiles nowhere{"/nowhere/at/all"};
    instance.read_properties_from(nowhere.store());
    const auto configured = instance.configure({});
    ASSERT_FALSE(configured);
    EXPECT_THAT(std::string{configured.error().view()}, StartsWith("/nowhere/at/all: component \""));
    EXPECT_THAT(
        std::string{configured.error().view()},
        HasSubstr("this directory of its properties file does not exist; make it, or name another one by "
                  "--properties"));
}

TEST_F(PropertyFilesOfAMachine, need_a_directory_unless_all_are_optional) {
    PropertyFiles nowhere_to_lie{""};
    instance.read_properties_from(nowhere_to_lie.store());
    EXPECT_THAT(configure(),
                AllOf(StartsWith("component \"warp\": there is no directory"), HasSubstr("--properties")));
    ComponentRow optional_row{.name = "weft", .type = &component_type<Tension>};
    optional_row.properties = properties_file("weft.cpf", optional);
    PropertyTransaction transaction;
    transaction.begin("weft", component_type<Tension>, &tension("weft"));
    EXPECT_TRUE(nowhere_to_lie.load(optional_row, transaction).empty());
    EXPECT_THAT(std::string{nowhere_to_lie.save(optional_row, transaction).view()},
                HasSubstr("there is no directory"));
}

TEST(PropertiesOfARow, are_validated_by_their_component) {
    const auto configured = PlacedRig<refused_table>{}.instance.configure({});
    ASSERT_FALSE(configured);
    EXPECT_THAT(std::string{configured.error().view()},
                HasSubstr("component \"edge\" refuses its properties: band.low"));
}

TEST_F(PropertyFilesOfAMachine, are_replaced_after_the_machine_has_stopped) {
    put("warp.cpf", cpf(real("gain", "3.5")));
    ASSERT_EQ(configure(), "");
    tension("warp").gain.set(4.5);
    ASSERT_TRUE(instance.save_properties(instance.standing()).empty());
    EXPECT_THAT(get("warp.cpf"), HasSubstr("<value>4.5</value>"));
    EXPECT_TRUE(there("weft.cpf")) << "also the one that was missing";
    EXPECT_FALSE(there("warp.cpf.tappet-new")) << "nothing is left beside it";
    ASSERT_EQ(configure(), "");
    EXPECT_EQ(tension("warp").gain_when_configured, 4.5);
}

TEST_F(PropertyFilesOfAMachine, keep_the_form_of_their_lists) {
    const std::string list = "<struct name=\"taps\" type=\"std::vector&lt;double&gt;\">";
    put("warp.cpf", cpf(list + "<simple name=\"Size\" type=\"long\"><value>1</value></simple>"
                               "<simple name=\"0\" type=\"double\"><value>2</value></simple></struct>"));
    put("weft.cpf", cpf("<sequence name=\"taps\" type=\"array\"/>"));
    ASSERT_EQ(configure(), "");
    ASSERT_EQ(tension("warp").taps.get().size(), 1u);
    ASSERT_TRUE(instance.save_properties(instance.standing()).empty());
    EXPECT_THAT(get("warp.cpf"),
                AllOf(HasSubstr(list), HasSubstr("<simple name=\"Size\" type=\"long\"><value>1</value>"),
                      HasSubstr("<simple name=\"0\" type=\"double\"><value>2</value>")));
    EXPECT_THAT(get("weft.cpf"), HasSubstr("<sequence name=\"taps\" type=\"array\">")) << "each its own";
}

TEST_F(PropertyFilesOfAMachine, stay_unchanged_when_they_cannot_be_replaced) {
    put("warp.cpf", cpf(real("gain", "3.5")));
    ASSERT_EQ(configure(), "");
    std::filesystem::create_directory(directory / "warp.cpf.tappet-new"); // the path of the new file
    const std::string said{instance.save_properties(instance.standing()).view()};
    EXPECT_THAT(said, AllOf(StartsWith(directory_name + "/warp.cpf: component \"warp\""),
                            HasSubstr("the old file remains")));
    EXPECT_THAT(get("warp.cpf"), HasSubstr("3.5"));
    EXPECT_TRUE(there("weft.cpf")) << "the others are saved all the same";
}

TEST_F(PropertyFilesOfAMachine, keep_their_content_when_a_value_could_not_be_read_back) {
    put("warp.cpf", cpf(real("gain", "3.5")));
    ASSERT_EQ(configure(), "");
    const auto saved = [this] { return std::string{instance.save_properties(instance.standing()).view()}; };
    tension("warp").gain.set(10.5); // a component's own changes are not validated
    EXPECT_THAT(saved(),
                AllOf(StartsWith(directory_name + "/warp.cpf: component \"warp\": property \"gain\""),
                      HasSubstr("over its greatest value 10"), HasSubstr("the old file remains")));
    EXPECT_TRUE(there("weft.cpf")) << "the others are saved all the same";
    tension("warp").gain.set(std::numeric_limits<double>::quiet_NaN());
    EXPECT_THAT(saved(), HasSubstr("is not a finite number"));
    tension("warp").gain.set(4.0);
    tension("warp").offset.set(std::numeric_limits<double>::infinity());
    EXPECT_THAT(saved(), AllOf(HasSubstr("property \"offset\": is not a finite number; propose a finite one"),
                               HasSubstr("the old file remains")))
        << "the next start would refuse it, also where no range is declared";
    tension("warp").offset.set(0.0);
    tension("warp").band.low.set(30.0);
    EXPECT_THAT(saved(),
                AllOf(HasSubstr("band.low is not under band.high"), HasSubstr("the old file remains")))
        << "what the component itself would refuse";
    EXPECT_THAT(get("warp.cpf"), HasSubstr("3.5"));
    EXPECT_EQ(configure(), "") << "the next start reads it";
    EXPECT_EQ(tension("warp").gain_when_configured, 3.5);
}

std::vector<std::string> left_out;

struct PropertyFilesOfAnotherVersion : PropertyFilesOfAMachine {
    std::string older = directory_name + "/older";
    PropertyFilesOfAnotherVersion() {
        std::filesystem::create_directory(older);
        left_out.clear();
        files->take_over(older, [](const Sentence& fault) { left_out.emplace_back(fault.view()); });
    }
};

TEST_F(PropertyFilesOfAnotherVersion, override_its_own_as_far_as_they_fit) {
    put("warp.cpf", cpf(real("gain", "3.5") + band(real("low", "100") + real("high", "200"))));
    put("older/warp.cpf", cpf(real("gain", "4.5") + "\n" + real("speed", "7") + "\n" +
                              band(real("low", "-3") + "\n" + real("high", "300"))));
    ASSERT_EQ(configure(), "");
    EXPECT_EQ(tension("warp").gain.get(), 4.5);
    EXPECT_EQ(tension("warp").band.low.get(), 100.0) << "as it was";
    EXPECT_EQ(tension("warp").band.high.get(), 300.0);
    ASSERT_EQ(left_out.size(), 2u);
    EXPECT_THAT(left_out[0],
                AllOf(HasSubstr("older/warp.cpf:3: component \"warp\""), HasSubstr("\"speed\"")));
    EXPECT_THAT(left_out[1], AllOf(HasSubstr("older/warp.cpf:4"), HasSubstr("under its least value 0")));
}

TEST_F(PropertyFilesOfAnotherVersion, leave_to_the_row_properties_that_do_not_fit) {
    put("older/warp.cpf", cpf("<simple name=\"gain\" type=\"string\"><value>much</value></simple>"));
    ASSERT_EQ(configure(), "");
    EXPECT_EQ(tension("warp").gain.get(), 2.0);
    EXPECT_EQ(left_out.size(), 1u);
}

TEST_F(PropertyFilesOfAnotherVersion, stay_unchanged_and_are_saved_to_new_files) {
    const std::string text = cpf(real("gain", "4.5") + real("speed", "7"));
    put("older/warp.cpf", text);
    ASSERT_EQ(configure(), "");
    ASSERT_TRUE(instance.save_properties(instance.standing()).empty());
    EXPECT_THAT(get("warp.cpf"), HasSubstr("<value>4.5</value>"));
    EXPECT_EQ(get("older/warp.cpf"), text);
}

TEST_F(PropertyFilesOfAnotherVersion, are_faulty_when_malformed_and_missing_when_neither_exists) {
    put("older/warp.cpf", "<properties>");
    EXPECT_THAT(configure(), HasSubstr("malformed"));
    std::filesystem::remove(older + "/warp.cpf");
    EXPECT_THAT(configure(), AllOf(StartsWith(directory_name + "/warp.cpf"), HasSubstr("is missing")));
}

using PropertyFilesOfAMachineDeathTest = PropertyFilesOfAMachine;

TEST_F(PropertyFilesOfAMachineDeathTest, cannot_be_set_after_configuration) {
    put("warp.cpf", cpf(real("gain", "3.5")));
    ASSERT_EQ(configure(), "");
    EXPECT_DEATH(instance.read_properties_from(files->store()), "contract 108 wrong-phase");
    EXPECT_DEATH(instance.browse_in(directory_name), "contract 108 wrong-phase");
}

struct PropertiesOfARunningMachine : PropertyFilesOfAMachine {
    PropertySaving& saved() {
        static PropertySaving saving;
        saving.begin(instance, office);
        for (int steps = 0; saving.step() && steps < 100; ++steps) EXPECT_TRUE(run(1ms));
        return saving;
    }
    PropertiesOfARunningMachine() {
        put("warp.cpf", cpf(""));
        EXPECT_EQ(configure(), "");
        world.start();
    }
};

TEST_F(PropertiesOfARunningMachine, cannot_be_saved_like_those_of_a_stopped_one) {
    EXPECT_FALSE(instance.standing());
    EXPECT_THAT(std::string{instance.save_properties(instance.standing()).view()}, HasSubstr("not saved"));
    world.stop();
    EXPECT_TRUE(instance.standing());
}

TEST_F(PropertiesOfARunningMachine, change_together_between_two_steps) {
    static PropertyTransaction transaction;
    EXPECT_TRUE(world.run_until(at_ns(0) + 10ms));
    transaction.begin("warp", component_type<Tension>, &tension("warp"));
    change(transaction, "band.low", 500.0);
    change(transaction, "band.high", 600.0);
    ASSERT_TRUE(instance.requests().post(motion, transaction.commit_message(0)));
    EXPECT_EQ(tension("warp").band.low.get(), 10.0);
    EXPECT_TRUE(world.run_until(at_ns(0) + 20ms));
    EXPECT_EQ(transaction.state(), PropertyTransaction::State::done);
    EXPECT_EQ(tension("warp").band.low.get(), 500.0);
    EXPECT_EQ(tension("warp").band.high.get(), 600.0);
    EXPECT_EQ(tension("warp").out_of_order, 0u);
    EXPECT_FALSE(tension("warp").changed_in_a_step);
}

TEST_F(PropertiesOfARunningMachine, are_not_saved_while_one_is_out_of_range) {
    tension("warp").gain.set(-1.0);
    PropertySaving& saving = saved();
    EXPECT_EQ(saving.saved(), 1u);
    EXPECT_THAT(std::string{saving.fault().view()},
                AllOf(HasSubstr("property \"gain\""), HasSubstr("under its least value 0")));
    EXPECT_EQ(get("warp.cpf"), cpf(""));
}

TEST_F(PropertiesOfARunningMachine, can_be_saved_while_it_runs) {
    tension("warp").gain.set(6.25);
    PropertySaving& saving = saved();
    EXPECT_FALSE(saving.busy());
    EXPECT_EQ(saving.saved(), 2u);
    EXPECT_TRUE(saving.fault().empty()) << saving.fault().view();
    EXPECT_THAT(get("warp.cpf"), HasSubstr("<value>6.25</value>"));
    EXPECT_THAT(get("weft.cpf"), HasSubstr("name=\"band\""));
}

} // namespace
} // namespace tappet
