// What a large machine costs to compile: 400 components of 20 types, 800 connections, 100 reactions.
//     large_machine --compiler PATH --flags FLAGS|@FILE --source DIR --build DIR
// Fails above the limits. Time is the compiler's own processor time: it does not depend on who else uses the
// computer.
#include "tests/diagnostics/large_machine.hpp"

#include <cstdlib>
#include <fstream>
#include <iostream>
#include <string>
#include <string_view>
#include <sys/resource.h>

namespace {

constexpr double most_seconds = 60;
constexpr double most_megabytes = 1000;

double seconds(const timeval& time) {
    return static_cast<double>(time.tv_sec) + static_cast<double>(time.tv_usec) * 1e-6;
}

} // namespace

int main(int count, char** words) {
    std::string compiler, flags, source, build;
    for (int i = 1; i + 1 < count; i += 2) {
        const std::string_view word = words[i];
        (word == "--compiler" ? compiler
         : word == "--flags"  ? flags
         : word == "--source" ? source
                              : build) = words[i + 1];
    }
    if (compiler.empty() || source.empty() || build.empty()) {
        std::cerr << "usage: large_machine --compiler PATH --flags FLAGS|@FILE --source DIR --build DIR\n";
        return 2;
    }
    if (flags.starts_with('@')) {
        std::ifstream file{flags.substr(1)};
        std::getline(file, flags);
    }
    const std::string machine = build + "/large_machine_table.cpp";
    {
        std::ofstream file{machine};
        tappet::diagnostics::write_machine(file, {});
        if (!file.flush()) {
            std::cerr << machine << " cannot be written\n";
            return 2;
        }
    }
    const std::string command = "cd '" + source + "' && '" + compiler + "' " + flags + " -c '" + machine +
                                "' -o '" + build + "/large_machine_table.o'";
    if (std::system(command.c_str()) != 0) {
        std::cout << "the large machine does not compile\n";
        return 1;
    }
    rusage used{};
    getrusage(RUSAGE_CHILDREN, &used);
    const double time = seconds(used.ru_utime) + seconds(used.ru_stime);
    const double memory = static_cast<double>(used.ru_maxrss) / 1000;
    std::cout << "400 components, 800 connections, 100 reactions: " << time << " s of processor time, "
              << memory << " MB (limits " << most_seconds << " s, " << most_megabytes << " MB)\n";
    return time < most_seconds && memory < most_megabytes ? 0 : 1;
}
