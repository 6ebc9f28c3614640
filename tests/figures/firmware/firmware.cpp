// The size of the carpet loom's firmware, its memory, and its time to arm, as its summary reports after
// weaving on the bench. And the size of a station of the lane, which contains its end of a wire.
#include "tests/figures/measure/candidates.hpp"

#include <nlohmann/json.hpp>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <optional>

#include <unistd.h>

namespace {

using namespace tappet::figures;
namespace fs = std::filesystem;

constexpr double megabyte = 1e6;

/// Size of a program as it would be flashed; 0 when it cannot be stripped.
double stripped_bytes(const std::string& program, const fs::path& folder) {
    const fs::path to = folder / "stripped";
    const std::string command = TAPPET_STRIP " -o '" + to.string() + "' '" + program + "'";
    std::error_code none;
    if (std::system(command.c_str()) != 0) return 0; // NOLINT: the words are the build's own
    return static_cast<double>(fs::file_size(to, none));
}

/// The summary of a short run on the bench; nothing when it did not finish.
std::optional<nlohmann::json> weave(const fs::path& folder) {
    const std::string summary = (folder / "summary.json").string(), log = (folder / "log").string();
    const std::string command = "'" TAPPET_DEMO "' --plain --picks 20 --firmware '" TAPPET_FIRMWARE
                                "' --init '" TAPPET_INIT "' --plant '" TAPPET_PLANT
                                "' --browser '" TAPPET_BROWSER "' --behaviours '" TAPPET_BEHAVIOURS
                                "' --summary '" +
                                summary + "' >'" + log + "' 2>&1";
    static_cast<void>(std::system(command.c_str())); // NOLINT: the words are the build's own; a fault of the
                                                     // weaving is no fault of ours
    std::ifstream file{summary};
    auto told = nlohmann::json::parse(file, nullptr, false);
    if (!told.is_discarded()) return told;
    std::cerr << "the loom did not finish on the bench:\n" << std::ifstream{log}.rdbuf() << '\n';
    return std::nullopt;
}

void tell(const nlohmann::json& summary, Result& result) {
    const auto number = [&](const char* key) { return summary.value(key, 0.0); };
    const double resident = number("rss_bytes") / megabyte;
    result.figures.push_back({"firmware.memory",
                              "memory of the loom's firmware, weaving on the bench",
                              "MB",
                              "",
                              "once, at the end of 20 picks",
                              {{"resident", Standing::ours, single(resident)},
                               {"static: the machine with its stacks", Standing::ours,
                                single(number("static_memory_bytes") / megabyte)}}});
    result.goals.push_back({"firmware of the loom: resident memory <= 3.5 MB", 3.5, resident, "MB",
                            "firmware.memory: resident"});
    result.goals.push_back({"firmware of the loom: static memory <= 1.5 MB", 1.5,
                            number("static_memory_bytes") / megabyte, "MB", "firmware.memory: static"});
    if (summary.contains("start_to_armed_ms")) {
        const double armed = number("start_to_armed_ms");
        result.figures.push_back({"firmware.start",
                                  "from the start of the firmware's process to the armed machine",
                                  "ms",
                                  "",
                                  "once, on the bench's emulated processor",
                                  {{"start to armed", Standing::ours, single(armed)}}});
        result.goals.push_back({"firmware of the loom: start to armed <= 50 ms without device time-outs", 50,
                                armed, "ms", "firmware.start; on the bench's emulated processor"});
    } else {
        result.notes.emplace_back(
            "the firmware's summary does not tell the time from its start to the armed machine");
    }
    const auto none = [&](const char* key, const char* what) {
        const auto count = summary.value(key, std::uint64_t{0});
        result.statements.push_back(
            {std::string{"no "} + what + " after arming", count == 0, std::to_string(count)});
    };
    none("heap_allocations_after_arming", "heap allocation");
    none("page_faults_after_arming", "page fault");
    none("deadline_misses", "missed deadline");
}

} // namespace

int main(int argc, char** argv) {
    const Options options = read_options(argc, argv);
    Result result{.program = "firmware", .setting = options.setting};
    const fs::path folder = fs::temp_directory_path() / ("tappet-firmware-" + std::to_string(::getpid()));
    fs::create_directories(folder);
    const auto size_of = [](const char* file) { return static_cast<double>(fs::file_size(file)) / megabyte; };
    const double size = size_of(TAPPET_FIRMWARE);
    result.figures.push_back(
        {"firmware.size",
         "size of firmwares, stripped",
         "MB",
         "",
         "one static binary with kernel, drivers, script compiler and behaviours",
         {{"carpet loom for the bench", Standing::ours, single(size)},
          {"a static program that opens a GPIO chip and a thread", Standing::floor,
           single(stripped_bytes(TAPPET_EMPTY, folder) / megabyte)},
          {"station of the woodworking lane, with its end of the wire", Standing::ours,
           single(size_of(TAPPET_STATION))},
          {"conveyor of the lane, likewise", Standing::ours, single(size_of(TAPPET_CONVEYOR))}}});
    result.goals.push_back({"firmware of the loom: <= 2 MB stripped", 2, size, "MB", "firmware.size"});
    if (!options.only.empty() && std::string{"firmware.size"}.contains(options.only)) {
        result.notes.emplace_back("only the size was asked for");
    } else if (options.setting == "smoke") {
        result.notes.emplace_back("nothing was booted in this setting");
    } else if (const auto summary = weave(folder)) {
        tell(*summary, result);
    } else {
        result.notes.emplace_back(
            "the loom did not weave on the bench here, so that its memory is not known");
    }
    fs::remove_all(folder);
    return finish(options, result);
}
