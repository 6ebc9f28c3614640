// Writes block waves as files for public viewers: VCD for GTKWave, a trace for Perfetto.
#include "toolchain/tools/browser/value.hpp"
#include "toolchain/tools/browser/waves.hpp"

#include <algorithm>
#include <cstdio>
#include <map>

namespace tappet::browser {

namespace {

/// A simple identifier of IEEE 1364: characters, digits and underscores.
std::string identifier(std::string_view name) {
    std::string text;
    for (const char character : name) {
        const bool plain = (character >= 'a' && character <= 'z') || (character >= 'A' && character <= 'Z') ||
                           (character >= '0' && character <= '9') || character == '_';
        text += plain ? character : '_';
    }
    if (text.empty() || (text[0] >= '0' && text[0] <= '9')) text.insert(0, "_");
    return text;
}

/// Returns an identifier code: printable characters from '!' to '~', the shortest first.
std::string code_of(std::size_t number) {
    std::string code;
    for (++number; number > 0; number = (number - 1) / 94) code += static_cast<char>('!' + (number - 1) % 94);
    return code;
}

struct Change {
    std::int64_t time = 0;
    std::size_t wire = 0;
    bool value = false;
    std::size_t nth = 0; ///< order of changes at the same time
};

/// The wires of one activity, and their changes.
class Wires {
public:
    explicit Wires(const Waves& waves) : waves_{waves} {
        for (const WaveActivity& activity : waves.activities) declare(activity);
    }
    [[nodiscard]] std::string write() {
        for (const WaveCycle& cycle : waves_.cycles) change(cycle);
        std::ranges::sort(changes_, {}, [](const Change& each) { return std::pair{each.time, each.nth}; });
        std::string text = "$version tappet-browse scope $end\n$comment time 0 is " +
                           std::to_string(waves_.from) + " ns of the machine's clock; each stamp cost " +
                           std::to_string(waves_.stamp_ns) +
                           " ns, which is subtracted $end\n$timescale 1ns $end\n$scope module " +
                           identifier(waves_.machine) + " $end\n" + declarations_ +
                           "$upscope $end\n$enddefinitions $end\n#0\n$dumpvars\n";
        for (std::size_t wire = 0; wire < wires_; ++wire) text += "0" + code_of(wire) + "\n";
        text += "$end\n";
        std::int64_t time = waves_.from;
        for (const Change& each : changes_) {
            if (each.time != time) text += "#" + std::to_string(each.time - waves_.from) + "\n";
            time = each.time;
            text += (each.value ? "1" : "0") + code_of(each.wire) + "\n";
        }
        if (waves_.to > time) text += "#" + std::to_string(waves_.to - waves_.from) + "\n";
        return text;
    }

private:
    struct OfActivity {
        std::size_t runs = 0, due = 0;
        std::int64_t last_end = 0;
        std::map<std::uint32_t, std::size_t> functions{};
    };

    void declare(const WaveActivity& activity) {
        OfActivity wires;
        const auto index = static_cast<std::uint32_t>(of_.size());
        declarations_ += "$scope module " + identifier(activity.name) + " $end\n";
        wires.runs = wire("runs");
        wires.due = wire("due");                   // released, and not begun yet
        std::map<std::uint32_t, std::string> used; // functions, in the order in which components run
        for (const WaveCycle& cycle : waves_.cycles)
            if (cycle.activity == index)
                for (const Block& block : cycle.blocks) used.emplace(block.function, "");
        std::string open;
        for (const auto& [function, unused] : used) {
            const std::string component = activity.component_of(function);
            if (component != open) {
                if (!open.empty()) declarations_ += "$upscope $end\n";
                declarations_ += "$scope module " + identifier(component) + " $end\n";
                open = component;
            }
            wires.functions[function] = wire(WaveActivity::kind_of(function));
        }
        declarations_ += open.empty() ? "$upscope $end\n" : "$upscope $end\n$upscope $end\n";
        of_.push_back(std::move(wires));
    }
    std::size_t wire(std::string_view name) {
        declarations_ += "$var wire 1 " + code_of(wires_) + " " + std::string{name} + " $end\n";
        return wires_++;
    }
    void pulse(std::size_t wire, std::int64_t begin, std::int64_t end) {
        changes_.push_back({std::max(begin, waves_.from), wire, true, changes_.size()});
        changes_.push_back({std::max(end, waves_.from), wire, false, changes_.size()});
    }
    void change(const WaveCycle& cycle) {
        OfActivity& wires = of_[cycle.activity];
        // A release during the previous cycle waited for that cycle's end.
        if (const std::int64_t due = std::max(cycle.release, wires.last_end); due < cycle.begin)
            pulse(wires.due, due, cycle.begin);
        wires.last_end = cycle.end;
        pulse(wires.runs, cycle.begin, cycle.end);
        for (const Block& block : cycle.blocks)
            pulse(wires.functions.at(block.function), block.begin, block.end);
    }

    const Waves& waves_;
    std::string declarations_{};
    std::vector<OfActivity> of_{};
    std::vector<Change> changes_{};
    std::size_t wires_ = 0;
};

/// Returns microseconds, as in the trace format, to the nanosecond.
std::string microseconds(std::int64_t ns) {
    char text[40];
    std::snprintf(text, sizeof text, "%s%lld.%03lld", ns < 0 ? "-" : "",
                  static_cast<long long>(std::abs(ns) / 1000), static_cast<long long>(std::abs(ns) % 1000));
    return text;
}

std::string named(std::string_view what, std::size_t thread, std::string_view value) {
    return R"({"ph": "M", "pid": 1, "tid": )" + std::to_string(thread) + ", \"name\": \"" +
           std::string{what} + R"(", "args": {"name": )" + in_quotes(value) + "}}";
}

} // namespace

std::string as_vcd(const Waves& waves) { return Wires{waves}.write(); }

std::string as_trace(const Waves& waves) {
    std::string text = R"({"displayTimeUnit": "ns", "otherData": {"machine": )" + in_quotes(waves.machine) +
                       ", \"zero_ns\": " + std::to_string(waves.from) +
                       ", \"stamp_ns\": " + std::to_string(waves.stamp_ns) + "}, \"traceEvents\": [\n" +
                       named("process_name", 0, waves.machine);
    for (std::size_t a = 0; a < waves.activities.size(); ++a)
        text += ",\n" + named("thread_name", a + 1, waves.activities[a].name) +
                ",\n{\"ph\": \"M\", \"pid\": 1, \"tid\": " + std::to_string(a + 1) +
                R"(, "name": "thread_sort_index", "args": {"sort_index": )" + std::to_string(a) + "}}";
    const auto slice = [&](std::uint32_t activity, std::string_view name, std::string_view category,
                           std::int64_t begin, std::int64_t end) {
        return ",\n{\"ph\": \"X\", \"pid\": 1, \"tid\": " + std::to_string(activity + 1) +
               ", \"ts\": " + microseconds(begin - waves.from) + ", \"dur\": " + microseconds(end - begin) +
               ", \"name\": " + in_quotes(name) + ", \"cat\": " + in_quotes(category);
    };
    for (const WaveCycle& cycle : waves.cycles) {
        const WaveActivity& activity = waves.activities[cycle.activity];
        text += slice(cycle.activity, activity.name, "cycle", cycle.begin, cycle.end) +
                ", \"args\": {\"late_ns\": " + std::to_string(cycle.begin - cycle.release) +
                ", \"response_ns\": " + std::to_string(cycle.response());
        if (activity.deadline_ns > 0)
            text += ", \"deadline_ns\": " + std::to_string(activity.deadline_ns) +
                    ", \"missed\": " + (cycle.response() > activity.deadline_ns ? "true" : "false");
        if (cycle.left_out > 0) text += ", \"left_out\": " + std::to_string(cycle.left_out);
        text += "}}";
        for (const Block& block : cycle.blocks)
            text +=
                slice(cycle.activity, activity.name_of(block.function), "function", block.begin, block.end) +
                ", \"args\": {\"took_ns\": " + std::to_string(block.took()) + "}}";
    }
    return text + "\n]}\n";
}

} // namespace tappet::browser
