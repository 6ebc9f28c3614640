// Limits the compile time and memory of a large machine: 400 components of 20 types, 800 connections, 100
// reactions; of one machine of a large system: ten on one wire, with 100 rows across; and of a large script
// with the firmware.
//     large_machine --compiler PATH --flags FLAGS|@FILE --source DIR --build DIR [--what
//     machine|system|script]
// Fails above the limits. Time is the compiler's own processor time: it does not depend on who else uses the
// computer.
#include "tests/diagnostics/large_machine.hpp"
#include "tests/diagnostics/large_script.hpp"
#include "tests/diagnostics/large_system.hpp"

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <iostream>
#include <iterator>
#include <string>
#include <string_view>
#include <sys/resource.h>

namespace {

using namespace tappet::diagnostics;

struct Subject {
    std::string_view what;
    void (*write)(std::ostream& file);
    const char* file;
    const char* text;
    double most_seconds;
    double most_megabytes;
};
constexpr Subject subjects[] = {
    {"machine", [](std::ostream& file) { write_machine(file, {}); }, "large_machine_table",
     "400 components, 800 connections, 100 reactions", 60, 1000},
    {"system", [](std::ostream& file) { write_system(file, {}); }, "large_system_table",
     "one of 10 machines with 100 rows across", 60, 2000},
    {"script", write_script, "large_script_unit", "100 states, 1000 statements", 60, 2000}};

double seconds(const timeval& time) {
    return static_cast<double>(time.tv_sec) + static_cast<double>(time.tv_usec) * 1e-6;
}

} // namespace

int main(int count, char** words) {
    std::string compiler, flags, source, build, what = "machine";
    for (int i = 1; i + 1 < count; i += 2) {
        const std::string_view word = words[i];
        (word == "--compiler" ? compiler
         : word == "--flags"  ? flags
         : word == "--source" ? source
         : word == "--what"   ? what
                              : build) = words[i + 1];
    }
    const auto* const subject = std::ranges::find(subjects, what, &Subject::what);
    if (compiler.empty() || source.empty() || build.empty() || subject == std::end(subjects)) {
        std::cerr << "usage: large_machine --compiler PATH --flags FLAGS|@FILE --source DIR --build DIR "
                     "[--what machine|system|script]\n";
        return 2;
    }
    if (flags.starts_with('@')) {
        std::ifstream file{flags.substr(1)};
        std::getline(file, flags);
    }
    const std::string table = build + "/" + subject->file;
    {
        std::ofstream file{table + ".cpp"};
        subject->write(file);
        if (!file.flush()) {
            std::cerr << table << ".cpp cannot be written\n";
            return 2;
        }
    }
    const std::string command =
        "cd '" + source + "' && '" + compiler + "' " + flags + " -c '" + table + ".cpp' -o '" + table + ".o'";
    if (std::system(command.c_str()) != 0) {
        std::cout << subject->text << ": does not compile\n";
        return 1;
    }
    rusage used{};
    getrusage(RUSAGE_CHILDREN, &used);
    const double time = seconds(used.ru_utime) + seconds(used.ru_stime);
    const double memory = static_cast<double>(used.ru_maxrss) / 1000;
    std::cout << subject->text << ": " << time << " s of processor time, " << memory << " MB (limits "
              << subject->most_seconds << " s, " << subject->most_megabytes << " MB)\n";
    return time < subject->most_seconds && memory < subject->most_megabytes ? 0 : 1;
}
