// Writes the source of a large machine: its compile time and memory are a figure of the framework.
#pragma once

#include <cstddef>
#include <ostream>
#include <string>

namespace tappet::diagnostics {

struct Size {
    std::size_t types = 20;
    std::size_t components = 400;
    std::size_t activities = 40;
    std::size_t reactions = 100;
};

inline void write_type(std::ostream& out, std::size_t n) {
    out << "struct State" << n << " { double value = 0; int mode = 0; };\n"
        << "struct Unit" << n << " {\n"
        << "    tappet::Input<double> position;\n    tappet::Input<Common> common;\n"
        << "    tappet::Output<double> follow;\n    tappet::Output<Common> state;\n    tappet::Output<State"
        << n << "> own;\n"
        << "    tappet::Event<double, int> reached;\n    tappet::Event<> lost;\n"
        << "    tappet::Property<double> gain{1.0};\n    tappet::Property<std::int64_t> steps{" << n << "};\n"
        << "    double offset = 0;\n"
        << "    void move(double by, int) noexcept TAPPET_REALTIME { offset += by; }\n"
        << "    void home() noexcept TAPPET_REALTIME { offset = 0; }\n"
        << "    void step(const tappet::Cycle&) noexcept TAPPET_REALTIME {\n"
        << "        const double now = position.get() * gain.get() + offset;\n"
        << "        follow.write(now);\n        state.write(common.get());\n        own.write({now, " << n
        << "});\n"
        << "        if (now > 1.0) reached(now, " << n << ");\n    }\n"
        << "    static constexpr auto interface() {\n        using namespace tappet;\n        return "
           "facets(\n"
        << "            input<&Unit" << n
        << "::position>(\"position\", \"deg\", \"where the one before it is\"),\n"
        << "            input<&Unit" << n << "::common>(\"common\", \"\", \"what all agree on\"),\n"
        << "            output<&Unit" << n << "::follow>(\"follow\", \"deg\", \"where it goes\"),\n"
        << "            output<&Unit" << n << "::state>(\"state\", \"\", \"what it passes on\"),\n"
        << "            output<&Unit" << n << "::own>(\"own\", \"\", \"its own state\"),\n"
        << "            event<&Unit" << n << "::reached>(\"reached\", \"it is there\"),\n"
        << "            event<&Unit" << n << "::lost>(\"lost\", \"it is not there\"),\n"
        << "            operation<&Unit" << n << "::move>(\"move\", \"shifts it\"),\n"
        << "            operation<&Unit" << n << "::home>(\"home\", \"to the origin\"),\n"
        << "            property<&Unit" << n << "::gain>(\"gain\", \"\", \"of the way\", range(0, 10)),\n"
        << "            property<&Unit" << n << "::steps>(\"steps\", \"\", \"on the way\"));\n    }\n};\n";
}

/// Every component has two inputs, so there are twice as many connections as components.
inline void write_machine(std::ostream& out, const Size& size) {
    const std::size_t each = size.components / size.activities;
    const auto name = [](std::size_t n) { return "\"unit_" + std::to_string(n) + "\""; };
    const auto path = [](std::size_t n, const char* facet) {
        return "\"unit_" + std::to_string(n) + "." + facet + "\"";
    };
    const auto comma = [&out](bool last) { out << (last ? "\n" : ",\n"); };
    out << "#include \"kernel/machine/firmware.hpp\"\n\nstruct Common { double speed = 0; double load = 0; "
           "int mode = 0; };\n";
    for (std::size_t n = 0; n < size.types; ++n) write_type(out, n);
    out << "\nusing namespace tappet;\nconstexpr auto large = machine(\"large\",\n    components(\n";
    for (std::size_t n = 0; n < size.components; ++n) {
        out << "        component<Unit" << n % size.types << ">(" << name(n)
            << ", set(\"gain\", 0.5), set(\"steps\", " << n << "))";
        comma(n + 1 == size.components);
    }
    out << "    ),\n    activities(\n";
    for (std::size_t a = 0; a < size.activities; ++a) {
        out << "        activity(\"activity_" << a << "\", every(" << a + 1
            << "ms), budget(20us), stack(16384), runs(";
        for (std::size_t n = 0; n < each; ++n) out << (n == 0 ? "" : ", ") << name(a * each + n);
        out << "))";
        comma(a + 1 == size.activities);
    }
    out << "    ),\n    connections(\n";
    for (std::size_t n = 0; n < size.components; ++n) {
        const std::size_t before = (n + size.components - 1) % size.components;
        const std::size_t across = (n + size.components - each) % size.components;
        out << "        data(" << path(before, "follow") << ", " << path(n, "position")
            << ", stale_after(50ms), hold),\n"
            << "        data(" << path(across, "state") << ", " << path(n, "common") << ")";
        comma(n + 1 == size.components);
    }
    out << "    ),\n    reactions(\n";
    for (std::size_t n = 0; n < size.reactions; ++n) {
        const std::size_t from = n * size.components / size.reactions;
        out << "        when(" << path(from, "reached") << ", tell("
            << path((from + 37) % size.components, "move") << "))";
        comma(n + 1 == size.reactions);
    }
    out << "    ),\n    behaviours());\n"
        << "constexpr Board host{.name = \"host\", .world = \"host\", .memory_budget_bytes = 4000000};\n"
        << "AcceptedMachine accepted() { return Firmware<large, host>::machine(); }\n";
}

} // namespace tappet::diagnostics
