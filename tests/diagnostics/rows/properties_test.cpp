// Properties: their values in rows, their declarations in interfaces, and their files.
#include "tests/diagnostics/rows/fault.hpp"
#include "tests/diagnostics/small_machine.hpp"

using namespace small;
using namespace tappet::diagnostics;

/// Outside of any namespace: a sentence contains its name.
struct Named : Tension {
    static constexpr auto interface() {
        return facets(input<&Tension::speed>("speed", "rpm", "of the shaft"),
                      property<&Tension::wanted_n>("wanted.n", "N", "of the warp"));
    }
};

enum class Gate { open, shut };
template <> inline constexpr auto tappet::names_of<Gate> = std::array<std::string_view, 2>{"open", "shut"};
struct Gated : Tension {
    Property<Gate> gate{Gate::shut};
    static constexpr auto interface() {
        return facets(input<&Tension::speed>("speed", "rpm", "of the shaft"),
                      property<&Gated::gate>("gate", "", "of the warp"));
    }
};
struct Twice : Tension {
    static constexpr auto interface() {
        return facets(input<&Tension::speed>("speed", "rpm", "of the shaft"),
                      property<&Tension::wanted_n>("wanted", "N", "of the warp"),
                      property<&Tension::wanted_n>("wish", "N", "of the warp"));
    }
};

struct Peerless : Tension {
    static constexpr auto interface() {
        return facets(input<&Tension::speed>("speed", "rpm", "of the shaft"),
                      setter<&Tension::wanted_n>("set_wanted", "by a peer"));
    }
};

namespace {

struct Noted : Tension {
    Property<Sequence<double, 256>> notes;
    static constexpr auto interface() {
        return facets(input<&Tension::speed>("speed", "rpm", "of the shaft"),
                      property<&Noted::notes>("notes", "", "of the shift"));
    }
};

/// Its properties have no range.
struct Open : Tension {
    Property<double> wanted{1.0};
    Property<float> share{1.0f};
    Property<Sequence<double, 3>> few;
    static constexpr auto interface() {
        return facets(input<&Tension::speed>("speed", "rpm", "of the shaft"),
                      property<&Open::wanted>("wanted", "N", "of the warp"),
                      property<&Open::share>("share", "", "of the warp"),
                      property<&Open::few>("few", "N", "of its ends"));
    }
};

struct Deeds : Tension {
    static constexpr auto interface() {
        return facets(input<&Tension::speed>("speed", "rpm", "of the shaft"),
                      bag("deeds", "what it does", operation<&Tension::relax>("stop", "lets go")));
    }
};

constexpr std::array<double, 2> endless{0.5, std::numeric_limits<double>::infinity()};
constexpr std::array<double, 2> one_too_low{0.5, -2.0};
constexpr std::array<double, 4> four_halves{0.5, 0.5, 0.5, 0.5};

constexpr Fault setting_faults[] = {
    {"property_unknown", [](Table& m) { m.put(component<Shaft>("shaft", set("gian", 2.0))); },
     R"(loom: component "shaft" has no property "gian"; did you mean "gain"?)"},
    {"property_twice", [](Table& m) { m.put(component<Shaft>("shaft", set("gain", 2.0), set("gain", 3.0))); },
     R"(loom: component "shaft" sets property "gain" twice; keep one)"},
    {"property_is_a_port", [](Table& m) { m.put(component<Shaft>("shaft", set("speed", 2.5))); },
     R"(loom: component "shaft" sets "speed", which is an output, not a property; set one of its properties)"},
    {"property_type", [](Table& m) { m.put(component<Shaft>("shaft", set("reversed", 2.5))); },
     R"(loom: component "shaft" sets property "reversed" to 2.5, but it is true or false; write true or false)"},
    {"property_number", [](Table& m) { m.put(component<Shaft>("shaft", set("gain", true))); },
     R"(loom: component "shaft" sets property "gain" to true, but it is a number; write it like 2.5)"},
    {"property_whole_number", [](Table& m) { m.put(component<Shaft>("shaft", set("teeth", 2.5))); },
     R"(loom: component "shaft" sets property "teeth" to 2.5, but it is a whole number; write it like 2)"},
    {"property_text", [](Table& m) { m.put(component<Shaft>("shaft", set("label", 3))); },
     R"(loom: component "shaft" sets property "label" to 3, but it is a text; write it in quotes, like "left")"},
    {"properties_too_many_in_a_row", [](Table& m) { m.components[1].too_many_settings = true; },
     R"(loom: component "shaft" sets more than 24 properties; give the others their default in the component)"},
    {"property_duration", [](Table& m) { m.put(component<Shaft>("shaft", set("filter", 2))); },
     R"(loom: component "shaft" sets property "filter" to 2, but it is a time; write it with its unit, like 2ms)"},
    {"property_enumerator",
     [](Table& m) { m.put(component<Gated>("tension", set("gate", static_cast<Gate>(7)))); },
     R"(loom: component "tension" sets property "gate" to Gate 7, which is not one of the 2 named values of Gate; set one of them)"},
    {"property_enumeration", [](Table& m) { m.put(component<Shaft>("shaft", set("turn", 1))); },
     R"(loom: component "shaft" sets property "turn" to 1, but it is an enumeration; write a value of small::Turn)"},
    {"property_range", [](Table& m) { m.put(component<Shaft>("shaft", set("gain", 12.5))); },
     R"(loom: component "shaft" sets property "gain" to 12.5, which is over its greatest value 10; set a value in its range, or widen range(...) in the interface of small::Shaft)"},
    {"property_no_number",
     [](Table& m) {
         m.put(component<Open>("tension", set("wanted", std::numeric_limits<double>::infinity())));
     },
     R"(loom: component "tension" sets property "wanted" to infinity, which is not a finite number; set a finite one)"},
    {"property_not_a_number",
     [](Table& m) {
         m.put(component<Open>("tension", set("wanted", std::numeric_limits<double>::quiet_NaN())));
     },
     R"(loom: component "tension" sets property "wanted" to NaN, which is not a finite number; set a finite one)"},
    {"property_float_without_end", [](Table& m) { m.put(component<Open>("tension", set("share", 1e300))); },
     R"(loom: component "tension" sets property "share" to more than 1e15, which is more than float holds; set a value it can hold)"},
    {"property_list_no_number", [](Table& m) { m.put(component<Open>("tension", set<endless>("few"))); },
     R"(loom: component "tension" sets property "few" to infinity, which is not a finite number; set a finite one)"},
    {"property_too_large", [](Table& m) { m.put(component<Shaft>("shaft", set("teeth", 128))); },
     R"(loom: component "shaft" sets property "teeth" to 128, which is more than signed char holds; set a value it can hold)"},
    {"property_text_too_long", [](Table& m) { m.put(component<Shaft>("shaft", set("label", "main shaft"))); },
     R"(loom: component "shaft" sets property "label" to "main shaft", which is longer than its 8 characters; shorten it)"},
    {"property_list_range", [](Table& m) { m.put(component<Shaft>("shaft", set<one_too_low>("offsets"))); },
     R"(loom: component "shaft" sets property "offsets" to -2, which is under its least value -1; set a value in its range, or widen range(...) in the interface of small::Shaft)"},
    {"property_list_too_long",
     [](Table& m) { m.put(component<Shaft>("shaft", set<four_halves>("offsets"))); },
     R"(loom: component "shaft" sets property "offsets" to a list of 4, but it has at most 3; correct the number of elements)"},
    {"property_bag", [](Table& m) { m.put(component<Shaft>("shaft", set("angles.window", 2.0))); },
     R"(loom: component "shaft" sets "angles.window", which is a bag; set its properties, each by its full name)"},
    {"property_in_bag_unknown",
     [](Table& m) { m.put(component<Shaft>("shaft", set("angles.window.hihg", 2.0))); },
     R"(loom: component "shaft" has no property "angles.window.hihg"; did you mean "angles.window.high"?)"},
    {"property_in_bag_range",
     [](Table& m) { m.put(component<Shaft>("shaft", set("angles.window.high", 361))); },
     R"(loom: component "shaft" sets property "angles.window.high" to 361, which is over its greatest value 360; set a value in its range, or widen range(...) in the interface of small::Shaft)"},
};
INSTANTIATE_TEST_SUITE_P(settings, Refusal, planted_into(small_loom, setting_faults), name_of);

constexpr Fault declaration_faults[] = {
    {"property_dotted", [](Table& m) { m.put(component<Named>("tension")); },
     R"(loom: component "tension": its property "wanted.n" has a dot in its name; put it into a bag(...) in Named)"},
    {"properties_too_many", [](Table& m) { m.put(component<Noted>("tension")); },
     R"(loom: component "tension" has 1 properties of 2064 bytes, but a transaction holds 64 of 2048; divide the component)"},
    {"property_under_two_names", [](Table& m) { m.put(component<Twice>("tension")); },
     R"(loom: component "tension": its properties "wanted" and "wish" use the same member; remove one of them from the interface of Twice)"},
    {"setter_of_no_property", [](Table& m) { m.put(component<Peerless>("tension")); },
     R"(loom: component "tension": its command "set_wanted" sets or gets a member that is not one of its properties; add property<..>(..) to the interface of Peerless)"},
    {"bag_of_an_operation", [](Table& m) { m.put(component<Deeds>("tension")); },
     R"(loom: component "tension": its bag "deeds" holds "deeds.stop", which is an operation; a bag holds properties and bags)"},
};
INSTANTIATE_TEST_SUITE_P(declarations, Refusal, planted_into(small_loom, declaration_faults), name_of);

constexpr Fault file_faults[] = {
    {"properties_file_of_nothing",
     [](Table& m) { m.put(component<Weft>("weft", properties_file("weft.cpf"))); },
     R"(loom: component "weft" has no properties but a properties file "weft.cpf"; remove properties_file(...))"},
    {"properties_file_path",
     [](Table& m) { m.put(component<Shaft>("shaft", properties_file("/etc/shaft.cpf"))); },
     R"(loom: component "shaft": its properties file "/etc/shaft.cpf" is not a plain file name; write one without a directory, which is the board's properties_directory)"},
    {"properties_file_shared",
     [](Table& m) {
         m.put(component<Shaft>("shaft", properties_file("shaft.cpf")));
         m.put(component<Tension>("tension", properties_file("shaft.cpf")));
     },
     R"(loom: component "tension" has the properties file "shaft.cpf" of component "shaft"; each needs a file of its own)"},
};
INSTANTIATE_TEST_SUITE_P(files, Refusal, planted_into(small_loom, file_faults), name_of);

} // namespace
