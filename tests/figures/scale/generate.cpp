// The text of a generated machine: types, then the table's rows.
#include "tests/figures/scale/generate.hpp"

#include <algorithm>
#include <ostream>
#include <string>

namespace tappet::figures {

namespace {

// The source of one component type; $ stands for its number.
constexpr std::string_view type_text = R"(
struct State$ {
    double value = 0;
    int mode = 0;
};
struct Unit$ {
    tappet::Input<double> position;
    tappet::Input<double> load;
    tappet::Input<Common> common;
    tappet::Input<Common> spare;
    tappet::Output<double> follow;
    tappet::Output<Common> state;
    tappet::Output<State$> own;
    tappet::Event<double, int> reached;
    tappet::Event<> lost;
    tappet::Property<double> gain{1.0};
    tappet::Property<std::int64_t> steps{$};
    double offset = 0;
    void move(double by, int) noexcept TAPPET_REALTIME { offset += by; }
    void home() noexcept TAPPET_REALTIME { offset = 0; }
    void step(const tappet::Cycle&) noexcept TAPPET_REALTIME {
        const double now = position.get() * gain.get() + offset + 0.25 * load.get();
        follow.write(now);
        Common all = common.get();
        all.load += spare.get().speed;
        state.write(all);
        own.write({now, $});
        if (now > 1e6) reached(now, $);
    }
    static constexpr auto interface() {
        using namespace tappet;
        return facets(input<&Unit$::position>("position", "deg", "where the one before it is"),
                      input<&Unit$::load>("load", "deg", "of the one before that"),
                      input<&Unit$::common>("common", "", "what all agree on"),
                      input<&Unit$::spare>("spare", "", "what another says of it"),
                      output<&Unit$::follow>("follow", "deg", "where it goes"),
                      output<&Unit$::state>("state", "", "what it passes on"),
                      output<&Unit$::own>("own", "", "its own state"),
                      event<&Unit$::reached>("reached", "it is there"),
                      event<&Unit$::lost>("lost", "it is not there"),
                      operation<&Unit$::move>("move", "shifts it"),
                      operation<&Unit$::home>("home", "to the origin"),
                      property<&Unit$::gain>("gain", "", "of the way", range(0, 10)),
                      property<&Unit$::steps>("steps", "", "on the way"));
    }
};
)";

constexpr std::size_t most_types = 20;
constexpr std::size_t most_activities = 62; // a table may have 63; one is left for a browser
constexpr std::size_t usual_each = 10;
constexpr std::size_t period_ms = 50;

void write_type(std::ostream& out, std::size_t number) {
    const std::string digits = std::to_string(number);
    for (const char character : type_text)
        if (character == '$')
            out << digits;
        else
            out << character;
}

class Rows {
public:
    Rows(std::ostream& out, const MachineSize& size) : out_{out}, size_{size} {}

    void components() {
        for (std::size_t n = 0; n < size_.components; ++n)
            out_ << "        component<Unit" << n % size_.types() << ">(\"unit_" << n
                 << "\", set(\"gain\", 0.5), set(\"steps\", " << n << "))" << end(n + 1 == size_.components);
    }
    void activities() {
        const std::size_t budget_us = std::max<std::size_t>(period_ms * 1000 / 2 / size_.activities(), 1);
        for (std::size_t a = 0; a < size_.activities(); ++a) {
            out_ << "        activity(\"activity_" << a << "\", every(" << period_ms << "ms), budget("
                 << budget_us << "us), stack(16384), runs(";
            for (std::size_t n = first_of(a); n < first_of(a + 1); ++n)
                out_ << (n == first_of(a) ? "" : ", ") << "\"unit_" << n << '"';
            out_ << "))" << end(a + 1 == size_.activities());
        }
    }
    void connections() {
        const std::size_t count = size_.components;
        const std::size_t each = count / size_.activities();
        for (std::size_t n = 0; n < count; ++n) {
            connect(n, "position", n + count - 1, "follow", ", stale_after(500ms), hold", false);
            connect(n, "load", n + count - 2, "follow", "", false);
            connect(n, "common", n + 3 * count - each - 1, "state", "", false);
            connect(n, "spare", n + 3 * count - 2 * each - 2, "state", "", n + 1 == count);
        }
    }
    void reactions() {
        for (std::size_t n = 0; n < size_.reactions(); ++n)
            out_ << "        when(\"unit_" << 2 * n << ".reached\", tell(\"unit_"
                 << (2 * n + 37) % size_.components << ".move\"))" << end(n + 1 == size_.reactions());
    }

private:
    [[nodiscard]] static const char* end(bool last) { return last ? "\n" : ",\n"; }
    [[nodiscard]] std::size_t first_of(std::size_t activity) const {
        return activity * size_.components / size_.activities();
    }
    [[nodiscard]] std::size_t activity_of(std::size_t component) const {
        std::size_t a = 0;
        while (first_of(a + 1) <= component) ++a;
        return a;
    }
    void connect(std::size_t reader, const char* input, std::size_t from, const char* output,
                 const char* options, bool last) {
        const std::size_t writer = from % size_.components;
        // Inside an activity, data that flows back, or in a ring, flows a cycle later.
        const bool back = activity_of(writer) == activity_of(reader) && writer >= reader;
        out_ << "        data(\"unit_" << writer << '.' << output << "\", \"unit_" << reader << '.' << input
             << '"' << options << (back ? ", delayed" : "") << ')' << end(last);
    }

    std::ostream& out_;
    const MachineSize& size_;
};

} // namespace

std::size_t MachineSize::types() const { return std::min(components, most_types); }
std::size_t MachineSize::activities() const {
    return std::clamp<std::size_t>(components / usual_each, 1, most_activities);
}

void write_machine(std::ostream& out, const MachineSize& size) {
    out << "#include \"tests/figures/scale/probe.hpp\"\n\n#include \"kernel/machine/firmware.hpp\"\n\n"
           "namespace {\n\nstruct Common {\n    double speed = 0;\n    double load = 0;\n    int mode = "
           "0;\n};\n";
    for (std::size_t n = 0; n < size.types(); ++n) write_type(out, n);
    Rows rows{out, size};
    out << "\n} // namespace\n\nnamespace tappet {\n\nconstexpr auto generated = machine(\n    "
           "\"generated\",\n"
           "    components(\n";
    rows.components();
    out << "        ),\n    activities(\n";
    rows.activities();
    out << "        ),\n    connections(\n";
    rows.connections();
    out << "        ),\n    reactions(\n";
    rows.reactions();
    out << "        ),\n    behaviours());\n\n"
           "constexpr Board host{.name = \"host\", .world = \"host\", .memory_budget_bytes = "
           "100'000'000};\n\n"
           "AcceptedMachine figures::accepted() { return Firmware<generated, host>::machine(); }\n\n"
           "} // namespace tappet\n";
}

} // namespace tappet::figures
