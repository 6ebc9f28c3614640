// tappet-chart: the state machines and programs of a machine as pictures, as SCXML and as models; and their
// verification.
#include "toolchain/tools/chart/machines.hpp"
#include "toolchain/tools/chart/plantuml.hpp"
#include "toolchain/tools/chart/promela.hpp"
#include "toolchain/tools/chart/scxml.hpp"
#include "toolchain/tools/chart/spin.hpp"

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <string>
#include <vector>

namespace tappet::chart {

namespace {

constexpr const char* usage =
    "usage: tappet-chart [--machine NAME] [--to DIRECTORY] WHAT...\n"
    "  plantuml  a UML state chart of each state machine and each program, NAME.puml\n"
    "  svg       the same drawn by the tool plantuml, NAME.svg\n"
    "  scxml     each state machine, NAME.scxml\n"
    "  promela   each state machine alone and the machine's state machines together, NAME.pml\n"
    "  verify    searches those models with spin\n";

struct Options {
    std::string machine;
    std::string to = ".";
    std::vector<std::string> what;
    bool good = true;
};

Options read(int count, char** words) {
    Options options;
    for (int i = 1; i < count; ++i) {
        const std::string word = words[i];
        const bool takes_value = word == "--machine" || word == "--to";
        if (takes_value && i + 1 == count) {
            options.good = false;
        } else if (takes_value) {
            (word == "--machine" ? options.machine : options.to) = words[++i];
        } else if (word == "plantuml" || word == "svg" || word == "scxml" || word == "promela" ||
                   word == "verify") {
            options.what.push_back(word);
        } else {
            std::cerr << "tappet-chart: \"" << word << "\" is no word of it\n";
            options.good = false;
        }
    }
    options.good = options.good && !options.what.empty();
    return options;
}

bool write(const std::string& path, const std::string& text) {
    std::ofstream file{path};
    file << text;
    file.close();
    if (file)
        std::cout << path << "\n";
    else
        std::cerr << "tappet-chart: " << path << " cannot be written; is the directory there?\n";
    return static_cast<bool>(file);
}

/// All at once: the tool takes longer to start than to draw.
bool draw(const std::vector<std::string>& paths) {
    std::string command = "plantuml -tsvg";
    for (const std::string& path : paths) command += " '" + path + "'";
    const bool good = std::system(command.c_str()) == 0; // NOLINT: a tool of the host, and names of tables
    if (!good)
        std::cerr << "tappet-chart: plantuml did not draw everything; is it installed? ci/setup does it\n";
    for (const std::string& path : paths)
        if (good) std::cout << std::filesystem::path{path}.replace_extension("svg").string() << "\n";
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

bool export_model(const std::string& what, const std::string& stem, const std::string& name,
                  const PromelaModel& model) {
    if (!model.fault.empty()) {
        std::cerr << "tappet-chart: " << model.fault << "\n";
        return false;
    }
    return what == "verify" ? verify(name, model.text) : write(stem + ".pml", model.text);
}

bool make(const KnownMachine& known, const Options& options) {
    Composition all{known.charts(), known.machine, known.model};
    bool good = true;
    std::vector<std::string> to_draw;
    for (const std::string& what : options.what) {
        for (const Chart& chart : all.charts) {
            const std::string stem =
                options.to + "/" + identifier(known.machine.name) + "." + identifier(chart.name);
            const auto picture = [&](const std::string& path, const std::string& text) {
                good = write(path, text) && good;
                if (what == "svg") to_draw.push_back(path);
            };
            if (what == "plantuml" || what == "svg") {
                picture(stem + ".puml", to_plantuml(chart));
                for (std::size_t p = 0; chart.programs != nullptr && p < chart.programs->programs.size(); ++p)
                    picture(stem + "." + identifier(chart.programs->programs[p].name) + ".puml",
                            program_to_plantuml(chart, static_cast<ProgramIndex>(p)));
            }
            if (chart.machine.states.empty()) continue;
            if (what == "scxml") good = write(stem + ".scxml", to_scxml(chart)) && good;
            if (what == "promela" || what == "verify")
                good = export_model(what, stem, chart.name, to_promela(chart)) && good;
        }
        if (known.script == nullptr && (what == "promela" || what == "verify"))
            good = export_model(what, options.to + "/" + identifier(known.machine.name),
                                std::string{known.machine.name}, to_promela(all)) &&
                   good;
    }
    return (to_draw.empty() || draw(to_draw)) && good;
}

int run(int count, char** words) {
    const Options options = read(count, words);
    if (!options.good) {
        std::cerr << usage;
        return 2;
    }
    std::error_code ignored;
    std::filesystem::create_directories(options.to, ignored);
    bool good = true;
    bool found = false;
    for (const KnownMachine& known : known_machines()) {
        if (!options.machine.empty() && options.machine != known.machine.name) continue;
        found = true;
        good = make(known, options) && good;
    }
    if (!found) {
        std::cerr << "tappet-chart: there is no machine \"" << options.machine << "\"; there are:";
        for (const KnownMachine& known : known_machines()) std::cerr << " " << known.machine.name;
        std::cerr << "\n";
        return 2;
    }
    return good ? 0 : 1;
}

} // namespace

} // namespace tappet::chart

int main(int count, char** words) { return tappet::chart::run(count, words); }
