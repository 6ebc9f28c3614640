// kernel/ and drivers/ use neither the operating system outside kernel/os nor the heap, nor anything that
// lives on it.
#include "tests/house/tree.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>

namespace tappet::house {
namespace {

// ---- the operating system

bool is_of_the_system(std::string_view header) {
    static constexpr std::array standard{
        "csignal",    "thread",    "mutex",   "shared_mutex", "condition_variable",
        "future",     "semaphore", "latch",   "barrier",      "ctime",
        "filesystem", "fstream",   "iostream"};
    if (header.starts_with("Eigen/")) return false;
    return header.ends_with(".h") || header.contains('/') ||
           std::ranges::find(standard, header) != standard.end();
}

Findings system_headers(const Tree& files) {
    // The sanitizer's own header, with which realtime.hpp pauses it; and a library of plain arithmetic.
    static constexpr std::string_view sanitizer = "sanitizer/rtsan_interface.h";
    static constexpr std::string_view decimals = "double-conversion/";
    Findings found;
    for (const File& file : files) {
        if (!file.is_under("kernel") || file.is_under("kernel/os")) continue;
        for (const Include& include : includes(file))
            if (!include.quoted && is_of_the_system(include.name) &&
                !(file.path == "kernel/base/realtime.hpp" && include.name == sanitizer) &&
                !(file.path == "kernel/base/real_text.cpp" && include.name.starts_with(decimals)))
                found.push_back({file.path, include.line,
                                 "<" + include.name + "> belongs to the operating system",
                                 "ask kernel/os, the only door to it"});
    }
    return found;
}

// ---- the heap

constexpr std::array words{"new",
                           "malloc",
                           "calloc",
                           "realloc",
                           "std::string",
                           "std::vector",
                           "std::deque",
                           "std::list",
                           "std::map",
                           "std::set",
                           "std::unordered_map",
                           "std::unordered_set",
                           "std::function",
                           "std::unique_ptr",
                           "std::shared_ptr",
                           "std::make_unique",
                           "std::make_shared",
                           "std::any",
                           "std::mutex",
                           "std::thread",
                           "std::cout",
                           "std::cerr",
                           "std::regex",
                           "throw",
                           "dynamic_cast",
                           "typeid"};

struct Exception {
    std::string_view path; ///< a file, or a folder with a slash at its end
    std::string_view word;
    std::string_view reason;
};

// clang-format off
constexpr std::array exceptions{
    Exception{"kernel/os/heap.cpp",         "malloc",  "the heap itself"},
    Exception{"kernel/os/host_watch.cpp",   "malloc",  "a host's program: notes the call and passes it on"},
    Exception{"kernel/os/host_watch.cpp",   "calloc",  "a host's program: notes the call and passes it on"},
    Exception{"kernel/os/host_watch.cpp",   "realloc", "a host's program: notes the call and passes it on"},
    Exception{"kernel/os/heap_symbols.cpp", "new",     "the heap itself: the program's operators"},
    Exception{"kernel/os/heap_symbols.cpp", "malloc",  "the heap itself: the program's symbols"},
    Exception{"kernel/os/heap_symbols.cpp", "calloc",  "the heap itself: the program's symbols"},
    Exception{"kernel/os/heap_symbols.cpp", "realloc", "the heap itself: the program's symbols"},
    Exception{"kernel/os/terminal.cpp",     "std::mutex", "two threads write, none of them real-time; held for calls that do not wait"},
    Exception{"kernel/machine/accept.hpp", "std::unique_ptr",  "tables accepted while a test or a tool runs; no firmware has it"},
    Exception{"kernel/machine/accept.cpp", "std::make_unique", "the same"},
    Exception{"drivers/gpio/chip.hpp",  "std::unique_ptr", "holds libgpiod's chip, opened while configuring"},
    Exception{"drivers/gpio/chip.cpp",  "std::unique_ptr", "holds libgpiod's objects while configuring"},
    Exception{"drivers/gpio/chip.cpp",  "std::string",     "paths of devices, while configuring"},
    Exception{"drivers/gpio/lines.hpp", "std::unique_ptr", "holds libgpiod's request and its buffer, made while configuring"},
    Exception{"drivers/gpio/lines.cpp", "std::unique_ptr", "holds libgpiod's settings while configuring"},
    Exception{"drivers/gpio/lines.cpp", "std::string",     "the consumer's name, while configuring"},
    Exception{"drivers/can/dbc/writer.hpp", "std::string",     "writes files for people; no firmware has it"},
    Exception{"drivers/can/dbc/writer.cpp", "std::string",     "the same"},
    Exception{"drivers/canopen/eds_faults.hpp", "std::string",      "checks files for people; no firmware has it"},
    Exception{"drivers/canopen/eds_faults.hpp", "std::vector",      "the same"},
    Exception{"drivers/canopen/eds_faults.cpp", "std::string",      "the same"},
    Exception{"drivers/canopen/eds_faults.cpp", "std::vector",      "the same"},
    Exception{"drivers/canopen/eds_reader.hpp", "std::vector",      "the build's program reads by it; no firmware has it"},
    Exception{"drivers/can/dbc/network.hpp",    "std::vector",      "the same"},
    Exception{"drivers/modbus/far_end.hpp", "std::mutex",        "a simulated server's requests and its plant; neither is real-time, no firmware has it"},
    Exception{"drivers/plant/can_log.hpp", "std::string", "logs on the host; no firmware has them"},
    Exception{"drivers/plant/can_log.hpp", "std::map",    "the same"},
    Exception{"drivers/plant/can_log.hpp", "std::deque",  "the same"},
    Exception{"drivers/plant/can_log.cpp", "std::string", "the same"},
    Exception{"drivers/plant/simulation.hpp", "std::string",     "the same: their names"},
    Exception{"drivers/plant/simulation.hpp", "std::function",   "the same: tells what became of them"},
    Exception{"drivers/plant/simulation.cpp", "std::function",   "the same"},
    Exception{"drivers/plant/simulation.hpp", "std::vector",     "the host's twins, as many as the table names; no firmware has them"},
    Exception{"drivers/plant/simulation.hpp", "std::unique_ptr", "the same: they stay where they are"},
    Exception{"drivers/plant/simulation.cpp", "std::vector",     "the same"},
    Exception{"drivers/plant/simulation.cpp", "std::make_unique", "the same"},
    Exception{"drivers/plant/simulation.cpp", "std::unique_ptr", "the same"},
    Exception{"drivers/camera/twin.hpp", "std::vector",          "the host's images, of any size; no firmware has them"},
    Exception{"drivers/camera/video.cpp", "std::string",         "the path of the device, while opening"},
    Exception{"drivers/modbus/libmodbus_transport.hpp", "std::unique_ptr", "holds libmodbus' context, made while configuring"},
    Exception{"drivers/modbus/libmodbus_transport.cpp", "std::string",     "the server's address, while configuring"},
};
// clang-format on

/// A placement new takes no memory: new (place) T.
bool is_placement(std::string_view code, std::size_t at) {
    const std::size_t next = code.find_first_not_of(' ', at + 3);
    return next != code.npos && code[next] == '(';
}

bool says(const std::string& code, std::string_view word) {
    if (code.starts_with("#include")) return false;
    for (std::size_t at = find_word(code, word); at != code.npos; at = find_word(code, word, at + 1))
        if (word != "new" || !is_placement(code, at)) return true;
    return false;
}

bool is_excepted(const Exception& row, const File& file, std::string_view word) {
    const bool place = row.path.ends_with('/') ? file.path.starts_with(row.path) : file.path == row.path;
    return place && row.word == word;
}

struct Uses {
    Findings found;
    std::array<bool, exceptions.size()> needed{};
};

Uses heap_users(const Tree& files) {
    Uses uses;
    for (const File& file : files) {
        if (!file.is_under("kernel") && !file.is_under("drivers")) continue;
        if (file.is_under("drivers") &&
            (file.name().starts_with("bench_") || file.name().starts_with("simulated_")))
            continue; // part of a plant, or a twin of the host: no firmware contains them
        for (std::size_t i = 0; i < file.code.size(); ++i)
            for (const std::string_view word : words) {
                if (!says(file.code[i], word)) continue;
                bool excepted = false;
                for (std::size_t e = 0; e < exceptions.size(); ++e)
                    if (is_excepted(exceptions[e], file, word)) uses.needed[e] = excepted = true;
                if (!excepted)
                    uses.found.push_back({file.path, i + 1, "says " + std::string(word),
                                          "take a bounded container of kernel/base, or state the reason in "
                                          "tests/house/resources_test.cpp"});
            }
    }
    return uses;
}

TEST(Resources, come_from_the_system_through_one_folder_only) { expect_none(system_headers(tree())); }

TEST(Resources, are_static) {
    const Uses uses = heap_users(tree());
    expect_none(uses.found);
    for (std::size_t e = 0; e < exceptions.size(); ++e)
        EXPECT_TRUE(uses.needed[e]) << exceptions[e].path << " does not say " << exceptions[e].word
                                    << " any more: remove its exception";
}

TEST(ResourcesRule, finds_system_headers_outside_their_folder) {
    for (const auto* header : {"unistd.h", "sys/mman.h", "linux/can.h", "pthread.h", "csignal", "thread"}) {
        const std::string line = "#include <" + std::string(header) + ">\n";
        EXPECT_EQ(system_headers({file("kernel/machine/a.cpp", line)}).size(), 1u) << header;
        EXPECT_TRUE(system_headers({file("kernel/os/a.cpp", line)}).empty()) << header;
    }
    for (const auto* header : {"array", "cstring", "Eigen/Dense"})
        EXPECT_TRUE(
            system_headers({file("kernel/cam/a.cpp", "#include <" + std::string(header) + ">\n")}).empty())
            << header;
}

TEST(ResourcesRule, finds_the_heap_in_code_and_not_in_prose) {
    EXPECT_EQ(heap_users({file("kernel/os/a.cpp", "int* a = new int;\n")}).found.size(), 1u);
    EXPECT_EQ(heap_users({file("drivers/can/a.cpp", "std::vector<int> a;\n")}).found.size(), 1u);
    EXPECT_TRUE(heap_users({file("drivers/can/bench_a.cpp", "std::vector<int> a;\n")}).found.empty());
    EXPECT_EQ(heap_users({file("kernel/os/bench_a.cpp", "std::vector<int> a;\n")}).found.size(), 1u);
    EXPECT_TRUE(
        heap_users({file("kernel/os/a.cpp", "// a new one\nsay(\"new std::string\"); new (place) T;\n")})
            .found.empty());
    EXPECT_TRUE(heap_users({file("kernel/os/a.cpp", "std::string_view a; int new_one;\n")}).found.empty());
    EXPECT_TRUE(heap_users({file("apps/a.cpp", "std::string a;\n")}).found.empty());
}

} // namespace
} // namespace tappet::house
