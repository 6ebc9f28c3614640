// Draws the state machines, programs and table of a machine, exports SCXML and models, and verifies the
// models.
#include "toolchain/tools/chart/program.hpp"

#include "drivers/can/dbc/writer.hpp"
#include "drivers/can/kind.hpp"
#include "toolchain/tools/chart/bus.hpp"
#include "toolchain/tools/chart/options.hpp"
#include "toolchain/tools/chart/plantuml.hpp"
#include "toolchain/tools/chart/promela.hpp"
#include "toolchain/tools/chart/scxml.hpp"
#include "toolchain/tools/chart/spin.hpp"
#include "toolchain/version.hpp"

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <string>
#include <vector>

namespace tappet::chart {

namespace {

namespace fs = std::filesystem;
using Paths = std::vector<std::string>;

bool write(const std::string& path, const std::string& text) {
    std::ofstream file{path};
    file << text;
    file.close();
    if (file)
        std::cout << path << "\n";
    else
        std::cerr << path << " cannot be written; check the folder's rights and the disk\n";
    return static_cast<bool>(file);
}

/// Draws all pictures with one call: starting a tool takes longer than drawing.
bool draw(const char* tool, const std::string& options, const Paths& paths) {
    std::string command = tool + options;
    for (const std::string& path : paths) command += " '" + path + "'";
    const bool good = std::system(command.c_str()) == 0; // NOLINT: a tool of the host, and names of tables
    if (!good) std::cerr << tool << " did not draw; is it installed? apt-get install plantuml graphviz\n";
    for (const std::string& path : paths)
        if (good) std::cout << fs::path{path}.replace_extension("svg").string() << "\n";
    return good;
}

bool verify(const std::string& name, const std::string& model) {
    bool good = true;
    for (const char* const define : {"REQUESTS", "FAILURES", "STOP"}) {
        const SpinSearch found = search(model, {define});
        std::cout << name << " " << define << ": " << found.states << " states, " << found.errors
                  << " errors " << found.error << "\n";
        for (const std::string& step : found.trail) std::cout << "    " << step << "\n";
        for (const std::string& mark : found.unreached)
            if (std::string{define} == "REQUESTS") std::cout << "    never: " << mark << "\n";
        good = good && found.ran && found.complete && found.errors == 0;
    }
    return good;
}

class Program {
public:
    Program(const AcceptedMachine& machine, std::span<const ModelRow> model, std::string_view to,
            std::uint32_t bit_rate, std::uint32_t data_bit_rate)
        : machine_{machine},
          bit_rate_{bit_rate},
          data_bit_rate_{data_bit_rate},
          all_{charts_of(machine.table), machine.table, model},
          stem_{std::string{to} + "/" + identifier(machine.table.name)} {}

    bool make(std::string_view what) {
        if (what == "svg") return draw_all();
        if (what == "bus") return draw_buses();
        if (what == "dbc") return write_buses();
        if (what == "dot") return write(stem_ + ".dot", to_dot(machine_));
        if (what == "plantuml") return !write_pictures().empty() || all_.charts.empty();
        bool good = true;
        for (const Chart& chart : all_.charts) {
            if (chart.machine.states.empty()) continue;
            if (what == "scxml")
                good = write(stem_of(chart) + ".scxml", to_scxml(chart)) && good;
            else
                good = export_model(what, stem_of(chart), chart.name, to_promela(chart)) && good;
        }
        if (what == "scxml" || all_.charts.empty()) return good;
        return export_model(what, stem_, std::string{machine_.table.name}, to_promela(all_)) && good;
    }

private:
    [[nodiscard]] std::string stem_of(const Chart& chart) const {
        return stem_ + "." + identifier(chart.name);
    }

    bool draw_all() {
        const bool written = write(stem_ + ".dot", to_dot(machine_));
        const bool drawn = written && draw("dot", " -Tsvg -o '" + stem_ + ".svg'", {stem_ + ".dot"});
        if (all_.charts.empty()) return drawn;
        const Paths pictures = write_pictures();
        return !pictures.empty() && draw("plantuml", " -tsvg", pictures) && drawn;
    }

    bool draw_buses() {
        bool good = true;
        for (std::size_t c = 0; c < machine_.table.components.size(); ++c) {
            const ComponentRow& row = machine_.table.components[c];
            if (row.type->device_traffic.rows == 0) continue;
            good = write(stem_ + "." + identifier(row.name) + ".svg",
                         draw_bus(machine_, c, bit_rate_, data_bit_rate_)) &&
                   good;
        }
        return good;
    }

    bool write_buses() {
        bool good = true;
        for (const ComponentRow& row : machine_.table.components) {
            const DeviceKind* kind = row.type->device_kind;
            if (kind == nullptr || kind->name != can::device_kind.name || row.type->device_map == nullptr)
                continue;
            const auto& map = *static_cast<const can::Identifiers*>(row.type->device_map);
            good = write(stem_ + "." + identifier(row.name) + ".dbc",
                         can::dbc::to_dbc(machine_.table.name, map.frames, map.signals)) &&
                   good;
        }
        return good;
    }

    /// Writes the pictures' sources. Returns empty when one could not be written, or when there is none.
    Paths write_pictures() {
        Paths paths;
        bool good = true;
        const auto picture = [&](const std::string& path, const std::string& text) {
            good = write(path, text) && good;
            paths.push_back(path);
        };
        for (const Chart& chart : all_.charts) {
            picture(stem_of(chart) + ".puml", to_plantuml(chart));
            for (std::size_t p = 0; chart.programs != nullptr && p < chart.programs->programs.size(); ++p)
                picture(stem_of(chart) + "." + identifier(chart.programs->programs[p].name) + ".puml",
                        program_to_plantuml(chart, static_cast<ProgramIndex>(p)));
        }
        return good ? paths : Paths{};
    }

    static bool export_model(std::string_view what, const std::string& stem, const std::string& name,
                             const PromelaModel& model) {
        if (!model.fault.empty()) {
            std::cerr << name << ": " << model.fault << "\n";
            return false;
        }
        return what == "verify" ? verify(name, model.text) : write(stem + ".pml", model.text);
    }

    const AcceptedMachine& machine_;
    std::uint32_t bit_rate_;
    std::uint32_t data_bit_rate_;
    Composition all_;
    std::string stem_;
};

} // namespace

int run_chart(const AcceptedMachine& machine, std::span<const ModelRow> model, int count, char** words) {
    if (prints_version(count, words, machine.table.name)) return 0;
    const std::vector<std::string_view> all(words + 1, words + count);
    auto line = read_command_line(chart_options, all, Others::words, chart_words);
    if (!line) {
        std::cerr << machine.table.name << ": " << line.error() << "\n";
        return 2;
    }
    if (line->has("--help")) {
        std::cout << "charts of the machine \"" << machine.table.name << "\": [OPTION...] [WHAT...]\n"
                  << usage_of(chart_options) << usage_of(chart_words);
        return 0;
    }
    if (line->words.empty()) line->words.emplace_back("svg");
    const std::string to{line->text("--to", ".")};
    std::error_code error;
    fs::create_directories(to, error);
    Program program{machine, model, to, static_cast<std::uint32_t>(line->number("--bit-rate", 1'000'000)),
                    static_cast<std::uint32_t>(line->number("--data-bit-rate", 2'000'000))};
    bool good = true;
    for (const std::string_view what : line->words) good = program.make(what) && good;
    return good ? 0 : 1;
}

} // namespace tappet::chart
