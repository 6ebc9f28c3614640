// The carpet loom's firmware and its plant as processes of the bench, and their observation by a test: their
// output, the levels on the lines, and every frame in the log of a foreign listener.
#pragma once

#include "apps/carpet_loom/wires.hpp"
#include "tests/bench/processes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace tappet::bench {

namespace wires = loom::wires;
using WallTime = std::chrono::system_clock::time_point; ///< candump's time stamps use it
using WallDuration = std::chrono::microseconds;

inline WallTime wall_now() { return std::chrono::system_clock::now(); }

/// The level on a line of the simulated chip, whatever drives it.
inline bool level(unsigned line) {
    return content_of("/sim/io/sim_gpio" + std::to_string(line) + "/value").starts_with('1');
}

/// Sets a line from outside, like a button or a sensor.
inline void pull(unsigned line, bool high) {
    std::ofstream{"/sim/io/sim_gpio" + std::to_string(line) + "/pull"} << (high ? "pull-up" : "pull-down");
}

/// A frame in a log of `candump -L`.
struct Logged {
    WallTime at{};
    std::uint32_t id = 0;
    std::vector<std::uint8_t> data;

    [[nodiscard]] unsigned word() const {
        return data.size() < 2 ? 0u : data[0] | static_cast<unsigned>(data[1]) << 8;
    }
    /// The target in a drive's command.
    [[nodiscard]] std::int32_t target() const {
        std::uint32_t value = 0;
        for (std::size_t i = 2; i < 6 && i < data.size(); ++i)
            value |= static_cast<std::uint32_t>(data[i]) << (8 * (i - 2));
        return static_cast<std::int32_t>(value);
    }
    [[nodiscard]] bool enables_operation() const { return (word() & 0x8Fu) == 0x0Fu; }
};

/// "(1700000000.123456) can0 201#0F0070170000", one a line; other lines are skipped.
inline std::vector<Logged> frames_of(const std::string& log) {
    std::vector<Logged> frames;
    std::istringstream lines{log};
    for (std::string line; std::getline(lines, line);) {
        long long seconds = 0;
        long micros = 0;
        unsigned id = 0;
        int read = 0;
        if (std::sscanf(line.c_str(), "(%lld.%ld) %*s %x#%n", &seconds, &micros, &id, &read) != 3 ||
            read == 0)
            continue;
        Logged frame{WallTime{std::chrono::seconds{seconds} + std::chrono::microseconds{micros}}, id, {}};
        for (std::size_t i = static_cast<std::size_t>(read); i + 1 < line.size(); i += 2)
            frame.data.push_back(static_cast<std::uint8_t>(std::stoul(line.substr(i, 2), nullptr, 16)));
        frames.push_back(frame);
    }
    return frames;
}

/// The loom, weaving or about to. The plant samples the lines each millisecond: the emulator is slow, and no
/// test here needs more. Its priority keeps the test's own work from delaying it.
class Loom {
public:
    static constexpr const char* summary_file = "/tmp/summary.json";
    static constexpr const char* report_file = "/tmp/report.json";

    explicit Loom(const std::string& plant_options = {}, const std::string& options = {})
        : plant{"carpet-loom-plant --period 1ms "
                "--operator-reaction 1s --report " +
                std::string{report_file} + " " + plant_options} {
        ::unlink(summary_file);
        std::this_thread::sleep_for(100ms); // its Modbus server listens
        machine.emplace("carpet_loom --summary " + std::string{summary_file} + " " + options);
    }

    /// Whether the machine wrote `text` after the last match; then the match moves there.
    bool says(std::string_view text, std::chrono::milliseconds patience = 6s) {
        return soon(
            [&] {
                const std::string all = machine->output();
                const std::size_t at = all.find(text, seen_);
                if (at == std::string::npos) return false;
                seen_ = at + text.size();
                return true;
            },
            patience, 20ms); // the console speaks four times a second
    }
    bool weaves() { return says("state=weave"); }
    /// says() ignores all output until now.
    void forget() { seen_ = machine->output().size(); }
    /// The output after the last match.
    [[nodiscard]] std::string since() const { return machine->output().substr(seen_); }
    /// The last value the console printed after "KEY=".
    [[nodiscard]] std::string last(const std::string& key) const {
        const std::string all = machine->output();
        const std::size_t at = all.rfind(" " + key + "=");
        if (at == std::string::npos) return {};
        const std::size_t begin = at + key.size() + 2;
        return all.substr(begin, all.find_first_of(" \n", begin) - begin);
    }
    [[nodiscard]] long picks() const { return std::strtol(last("picks").c_str(), nullptr, 10); }

    /// Sends SIGTERM; returns the exit code.
    int end() {
        machine->signal(SIGTERM);
        const int code = machine->wait();
        summary = content_of(summary_file);
        return code;
    }

    Foreign plant;
    std::optional<Foreign> machine;
    std::string summary;

private:
    std::size_t seen_ = 0;
};

/// The conditions that hold whatever came on the wires.
inline void expect_undisturbed(const Loom& loom) {
    EXPECT_EQ(number_in(loom.summary, "deadline_misses"), 0);
    EXPECT_EQ(number_in(loom.summary, "heap_allocations_after_arming"), 0);
    EXPECT_EQ(number_in(loom.summary, "page_faults_after_arming"), 0);
    EXPECT_EQ(number_in(loom.summary, "emissions_lost"), 0);
}

inline bool is_safe() { return level(wires::line::brake) && !level(wires::line::weft_release); }

/// Everything the machine sends, and error frames, without the frames with which the plant floods the bus.
/// -D: a restart takes the interface down and up, and a listener stays.
inline constexpr const char* listen_to_the_machine =
    "candump -D -L can0,000:7FF,201:7FF,202:7FF,205:7FF,206:7FF,#FFFFFFFF";

} // namespace tappet::bench
