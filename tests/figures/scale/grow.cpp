// Generates, compiles, links and runs machines, and plots the costs over their size.
#include "tests/figures/scale/scale.hpp"

#include "tests/diagnostics/large_system.hpp"
#include "tests/figures/scale/child.hpp"
#include "tests/figures/scale/generate.hpp"
#include "tests/figures/scale/probe.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <optional>
#include <sstream>

#include <unistd.h>

namespace tappet::figures {

namespace {

using Words = std::vector<std::string>;
using Fault = std::optional<std::string>;

constexpr const char* clang = "clang++-22";

/// From this size on the same share of connections leads to other activities; 10 components are one activity.
constexpr std::size_t wired_alike = 50;

/// The quantities that are measured for each size.
enum class What : std::uint8_t {
    gcc_seconds,
    gcc_memory,
    clang_seconds,
    clang_memory,
    firmware,
    memory,
    stacks,
    configured,
    armed,
    started,
    step,
    bare
};

struct Column {
    What what;
    const char* row;
    Standing role;
};
struct Subject {
    const char* id;
    const char* title;
    const char* unit;
    const char* how;
    std::vector<Column> columns;
};

Row row_of(std::string name, Standing role, const Summary& summary, std::optional<double> instructions = {}) {
    return {.name = std::move(name), .role = role, .summary = summary, .instructions = instructions};
}

/// A temporary folder, removed with it.
struct Workshop {
    std::filesystem::path folder =
        std::filesystem::temp_directory_path() / ("tappet-scale-" + std::to_string(::getpid()));
    Workshop() { std::filesystem::create_directories(folder); }
    ~Workshop() {
        std::error_code ignored;
        std::filesystem::remove_all(folder, ignored);
    }
    Workshop(const Workshop&) = delete;
    Workshop& operator=(const Workshop&) = delete;
    [[nodiscard]] std::string file(const std::string& name) const { return (folder / name).string(); }
};

void add(Words& words, const Words& more) { words.insert(words.end(), more.begin(), more.end()); }

/// The sizes for each compiler.
struct Growth {
    std::vector<std::size_t> sizes;          ///< by the tree's own compiler, linked and run
    std::vector<std::size_t> sizes_of_clang; ///< compiled by clang as well
};
Growth growth(const Options& options) {
    if (options.setting == "smoke") return {{10}, {}};
    if (options.setting == "long") return {{10, 50, 100, 250, 500, 1000}, {10, 50, 100, 250, 500, 1000}};
    return {{10, wired_alike, 100, 1000}, {10, 100}};
}

/// Machines of every size, one after the other.
class Growing {
public:
    Growing(const Options& options, const Toolset& tools, Result& result)
        : options_{options}, tools_{tools}, result_{result} {}

    void run() {
        const Growth plan = growth(options_);
        for (const std::size_t size : plan.sizes) {
            const bool by_clang = std::ranges::find(plan.sizes_of_clang, size) != plan.sizes_of_clang.end();
            if (const Fault fault = grow(size, by_clang))
                result_.notes.push_back(std::to_string(size) + " components: " + *fault);
        }
        report();
    }
    /// One machine's firmware of a system: the compile time that each of its boxes needs.
    void compile_system(const diagnostics::SystemSize& size) {
        const std::string source = shop_.file("system.cpp"), count = std::to_string(size.machines);
        const std::string title =
            ", one machine of " + count + " with " + std::to_string(size.crossings()) + " rows across";
        {
            std::ofstream file{source};
            diagnostics::write_system(file, size);
            if (!file.flush()) return result_.notes.push_back(source + " cannot be written");
        }
        const std::string how =
            "processor time of one compilation of one translation unit that holds the system's table, "
            "its frames, the proof of its wire and the machine's end of it";
        Figure time{
            .id = "scale.system.time." + count, .title = "compiling" + title, .unit = "s", .how = how};
        Figure memory{.id = "scale.system.memory." + count,
                      .title = "memory of the compiler" + title,
                      .unit = "MB",
                      .how = "its largest resident size"};
        for (auto& [name, words] :
             {std::pair{std::string{"g++"}, gcc_words()}, {std::string{clang}, clang_words()}}) {
            if (options_.setting == "smoke" && name == clang) continue;
            const auto used = compile(words, source, shop_.file("system.o"));
            if (!used) {
                result_.notes.push_back("a system of " + count + " machines: " + used.error());
                continue;
            }
            time.rows.push_back(row_of(name, Standing::ours, single(used->processor_s)));
            memory.rows.push_back(row_of(name, Standing::ours, single(used->memory_mb)));
        }
        if (time.rows.empty()) return;
        result_.figures.push_back(std::move(time));
        result_.figures.push_back(std::move(memory));
    }

private:
    std::map<What, Summary>& at(std::size_t size) { return measured_[size]; }

    Fault grow(std::size_t size, bool by_clang) {
        const std::string source = shop_.file("machine_" + std::to_string(size) + ".cpp");
        const std::string object = shop_.file("machine_" + std::to_string(size) + ".o");
        {
            std::ofstream file{source};
            write_machine(file, {size});
            if (!file.flush()) return source + " cannot be written";
        }
        if (by_clang)
            if (const Fault fault = compile(size, clang_words(), source, shop_.file("by_clang.o"),
                                            What::clang_seconds, What::clang_memory))
                result_.notes.push_back(std::to_string(size) + " components: " + *fault);
        if (const Fault fault =
                compile(size, gcc_words(), source, object, What::gcc_seconds, What::gcc_memory))
            return fault;
        if (const Fault fault = probe(size, object)) return fault;
        return arm(size, object);
    }

    [[nodiscard]] Words gcc_words() const {
        Words words = tools_.at("compiler");
        add(words, tools_.at("flags"));
        return words;
    }
    /// The flags of that compiler's own tree; flags that only the other compiler knows are left out.
    [[nodiscard]] Words clang_words() const {
        Words words{clang, "-fconstexpr-steps=2000000000", "-fconstexpr-depth=2000", "-Wfunction-effects",
                    "-Wno-c++26-extensions"};
        for (const std::string& flag : tools_.at("flags"))
            if (!flag.starts_with("-fconstexpr")) words.push_back(flag);
        return words;
    }
    [[nodiscard]] std::expected<Used, std::string> compile(Words words, const std::string& source,
                                                           const std::string& object) {
        add(words, {"-I" + tools_.at("source").front(), "-c", source, "-o", object});
        return run_child(words, shop_.file("log"));
    }
    Fault compile(std::size_t size, Words words, const std::string& source, const std::string& object,
                  What seconds, What memory) {
        const auto used = compile(std::move(words), source, object);
        if (!used) return used.error();
        at(size)[seconds] = single(used->processor_s);
        at(size)[memory] = single(used->memory_mb);
        return {};
    }
    Fault link(const std::string& object, const char* with, const Words& options,
               const std::string& program) {
        Words words = tools_.at("compiler");
        add(words, {"-o", program, object, "-Wl,--start-group"});
        add(words, tools_.at(with));
        add(words, tools_.at("archives"));
        words.emplace_back("-Wl,--end-group");
        add(words, options);
        const auto linked = run_child(words, shop_.file("log"));
        return linked ? Fault{} : Fault{linked.error()};
    }

    Fault probe(std::size_t size, const std::string& object) {
        const std::string program = shop_.file("probe"), json = shop_.file("probe.json");
        if (Fault fault = link(object, "probe", {"-pthread"}, program)) return fault;
        Words words{program, "--json", json};
        if (options_.setting != "short") words.push_back("--" + options_.setting);
        if (!options_.counts) words.emplace_back("--no-counts");
        const auto ran = run_child(words, shop_.file("log"));
        if (!ran) return ran.error();
        const auto read = read_result(json);
        if (!read) return read.error();
        const Row* engines = read->find("probe.step", probe_engines);
        const Row* steps = read->find("probe.step", probe_steps);
        const Row* memory = read->find("probe.memory", "all");
        const Row* stacks = read->find("probe.memory", "stacks");
        const Row* configured = read->find("probe.start", "configure");
        if (engines == nullptr || steps == nullptr || memory == nullptr || stacks == nullptr ||
            configured == nullptr)
            return "its probe wrote a result without the figures that were asked for";
        at(size)[What::step] = engines->summary;
        at(size)[What::bare] = steps->summary;
        instructions_[size] = {engines->instructions, steps->instructions};
        at(size)[What::memory] = single(memory->summary.median / 1000);
        at(size)[What::stacks] = single(stacks->summary.median / 1000);
        at(size)[What::configured] = single(configured->summary.median / 1000);
        return {};
    }

    /// Runs the same machine with real threads, as a static firmware.
    Fault arm(std::size_t size, const std::string& object) {
        const std::string program = shop_.file("real");
        if (Fault fault = link(object, "real", {"-static", "-s", "-Wl,--gc-sections", "-pthread"}, program))
            return fault;
        std::error_code error;
        at(size)[What::firmware] =
            single(static_cast<double>(std::filesystem::file_size(program, error)) / 1000);
        const auto ran = run_child({program}, shop_.file("log"));
        if (!ran) return "it did not arm: " + ran.error();
        std::ifstream log{shop_.file("log")};
        for (std::string line; std::getline(log, line);)
            for (const auto& [word, what] : {std::pair{"armed ", What::armed}, {"started ", What::started}})
                if (line.starts_with(word))
                    at(size)[what] = single(
                        (std::atof(line.c_str() + std::string_view{word}.size()) - ran->started_ns) / 1000);
        return {};
    }

    void report();
    void report_subject(const Subject& subject);
    void judge_step();

    const Options& options_;
    const Toolset& tools_;
    Result& result_;
    Workshop shop_{};
    std::map<std::size_t, std::map<What, Summary>> measured_{};
    std::map<std::size_t, std::pair<std::optional<double>, std::optional<double>>> instructions_{};
};

const std::vector<Subject> subjects{
    {"compile.time",
     "compiling the table",
     "s",
     "processor time of one compilation of one translation unit that holds types, table, checks, plan and "
     "code",
     {{What::gcc_seconds, "g++", Standing::ours}, {What::clang_seconds, clang, Standing::ours}}},
    {"compile.memory",
     "memory of the compiler",
     "MB",
     "its largest resident size",
     {{What::gcc_memory, "g++", Standing::ours}, {What::clang_memory, clang, Standing::ours}}},
    {"firmware",
     "the static firmware, stripped",
     "kB",
     "size of the file: machine, framework and C library",
     {{What::firmware, "file", Standing::ours}}},
    {"memory",
     "static memory of the machine",
     "kB",
     "as planned by the compiler, stacks included",
     {{What::memory, "all", Standing::ours}, {What::stacks, "of it stacks", Standing::ours}}},
    {"start",
     "start-up",
     "us",
     "one start; from exec: of the static firmware, until every thread is there and the box was looked at",
     {{What::configured, "constructed, wired, configured", Standing::ours},
      {What::armed, "from exec to armed", Standing::ours},
      {What::started, "from exec to every activity started", Standing::ours}}},
    {"step",
     "one component's step, all activities due",
     "ns",
     "a whole round of all engines in virtual time (no clock readings), divided by the components",
     {{What::step, probe_engines, Standing::ours}, {What::bare, probe_steps, Standing::floor}}}};

void Growing::report_subject(const Subject& subject) {
    Plot plot{.id = std::string{"scale."} + subject.id,
              .title = subject.title,
              .x = "components",
              .y = subject.unit,
              .log_x = true,
              .log_y = true,
              .series = {}};
    for (const Column& column : subject.columns) plot.series.push_back({column.row, column.role, {}});
    for (auto& [size, values] : measured_) {
        Figure figure{.id = std::string{"scale."} + subject.id + "." + std::to_string(size),
                      .title = std::string{subject.title} + ", " + std::to_string(size) + " components",
                      .unit = subject.unit,
                      .how = subject.how};
        for (std::size_t i = 0; i < subject.columns.size(); ++i) {
            const Column& column = subject.columns[i];
            const auto value = values.find(column.what);
            if (value == values.end()) continue;
            const auto& counted = instructions_[size];
            figure.rows.push_back(row_of(column.row, column.role, value->second,
                                         column.what == What::step   ? counted.first
                                         : column.what == What::bare ? counted.second
                                                                     : std::nullopt));
            plot.series[i].points.emplace_back(static_cast<double>(size), value->second.median);
        }
        if (!figure.rows.empty()) result_.figures.push_back(std::move(figure));
    }
    std::erase_if(plot.series, [](const Series& series) { return series.points.size() < 2; });
    if (!plot.series.empty()) result_.plots.push_back(std::move(plot));
}

// The engines' cost beyond the components' own work, which the bare loop shows; and the whole step, beside
// that of the first machine with the same share of connections to other activities: a single activity reads
// nothing from another.
void Growing::judge_step() {
    const auto judge = [this](std::size_t small, const char* goal, double limit,
                              double (*of)(std::map<What, Summary>&)) {
        const std::size_t large = measured_.rbegin()->first;
        if (small >= large || !measured_.contains(small)) return;
        const double before = of(measured_[small]), after = of(measured_[large]);
        if (before <= 0 || after <= 0) return;
        std::ostringstream detail;
        detail << after << " ns with " << large << " components beside " << before << " ns with " << small
               << ": a round of all engines, divided by the components";
        result_.goals.push_back({goal, limit, after / before, "x", detail.str()});
    };
    judge(measured_.begin()->first,
          "1000 components: engine time per component, without its step, as with 10", 1.05,
          [](auto& values) { return values[What::step].median - values[What::bare].median; });
    judge(wired_alike, "1000 components: a component's step as with 50", 1.5,
          [](auto& values) { return values[What::step].median; });
}

void Growing::report() {
    for (const Subject& subject : subjects) report_subject(subject);
    if (!measured_.empty()) judge_step();
}

} // namespace

std::expected<Toolset, std::string> read_toolset(const std::string& file) {
    std::ifstream lines{file};
    if (!lines) return std::unexpected(file + " is not there; build figures-scale again");
    Toolset tools;
    for (std::string line; std::getline(lines, line);) {
        std::istringstream rest{line};
        std::string name;
        rest >> name;
        for (std::string word; rest >> word;) tools[name].push_back(word);
    }
    for (const char* name : {"source", "compiler", "flags", "archives", "probe", "real"})
        if (tools[name].empty()) return std::unexpected(file + " says nothing of " + name);
    return tools;
}

void measure_growth(const Options& options, const Toolset& tools, Result& result) {
    Growing{options, tools, result}.run();
}

void measure_system(const Options& options, const Toolset& tools, Result& result) {
    Growing{options, tools, result}.compile_system({options.setting == "smoke" ? 3u : 10u});
}

} // namespace tappet::figures
