// Runs the lane on the host and reports the result of the boards.
#include "apps/woodworking_lane/host/lane_run.hpp"
#include "kernel/system/resolve.hpp"
#include "toolchain/command_line.hpp"
#include "toolchain/version.hpp"

#include <cstdio>
#include <fstream>

namespace {

using namespace woodworking;

constexpr std::array options{
    Option{.name = "--seed",
           .value = "N",
           .help = "seed of the boards, the clocks and the wire (default 1)",
           .is_number = true},
    Option{.name = "--boards",
           .value = "N",
           .help = "number of boards (default 12)",
           .is_number = true,
           .least = 1,
           .most = 1000},
    Option{"--silence", "NODE", "that machine is killed after 40 s and started again after 50 s"},
    Option{"--browse", "DIR",
           "opens a socket of each machine for tappet-browse in DIR; time then passes at this host's pace"},
    Option{"--picture", "FILE", "draws boards over time and position, as SVG"},
    Option{"--help", "", "this text"}};

int fail(std::string_view why) {
    std::fprintf(stderr, "woodworking_lane: %.*s\n", static_cast<int>(why.size()), why.data());
    return 2;
}

int run_lane(const CommandLine& given) {
    LaneRun lane{given.number("--seed", 1), static_cast<int>(given.number("--boards", 12))};
    const std::string_view silent = given.text("--silence");
    const std::size_t node = silent.empty() ? 0 : tappet::find_node(lane_view(), silent);
    if (!silent.empty() && node >= node_count)
        return fail("--silence: name conveyor, saw, drill, polish or glue");
    if (const std::string_view sockets = given.text("--browse"); !sockets.empty())
        lane.system.browse_in(sockets);
    if (const auto started = lane.start(); !started) return fail(started.error().view());
    if (!silent.empty()) {
        lane.run_for(40s);
        lane.kill(node);
        lane.run_for(10s);
        if (const auto started = lane.system.start(node); !started) return fail(started.error().view());
        lane.run_for(500ms);
        lane.acknowledge();
    }
    const bool all_left = lane.run_through(1000s);
    int missed = 0;
    const Sentence fault = fault_of(lane.hall, missed);
    if (const std::string_view file = given.text("--picture"); !file.empty()) {
        std::ofstream out{std::string{file}};
        out << picture_of(lane);
        if (!out.flush()) return fail(Sentence{"--picture: ", file, " cannot be written"}.view());
    }
    std::printf("{\"boards\": %d, \"left\": %d, \"works_missed\": %d, \"seconds\": %.1f, \"digest\": "
                "\"%016llx\", \"fault\": \"%s\"}\n",
                lane.hall.wanted, lane.hall.left(), missed, to_seconds(lane.system.now() - Time{}),
                static_cast<unsigned long long>(lane.system.digest()),
                fault.empty() ? "" : std::string{fault.view()}.c_str());
    lane.system.stop();
    return all_left && fault.empty() ? 0 : 1;
}

} // namespace

int main(int count, char** words) {
    if (prints_version(count, words, "woodworking_lane")) return 0;
    const std::vector<std::string_view> given{words + 1, words + count};
    const auto line = read_command_line(options, given, Others::refused);
    if (!line) return fail(line.error());
    if (line->has("--help")) {
        std::printf("woodworking_lane: five machines on one wire, in virtual time\n%s",
                    usage_of(options).c_str());
        return 0;
    }
    return run_lane(*line);
}
