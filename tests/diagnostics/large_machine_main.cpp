// What a large machine costs to compile: 400 components of 20 types, 800 connections, 100 reactions; or one
// machine of a large system: ten on one wire, with 100 rows across.
//     large_machine --compiler PATH --flags FLAGS|@FILE --source DIR --build DIR [--what machine|system]
// Fails above the limits. Time is the compiler's own processor time: it does not depend on who else uses the
// computer.
#include "tests/diagnostics/large_machine.hpp"
#include "tests/diagnostics/large_system.hpp"

#include <cstdlib>
#include <fstream>
#include <iostream>
#include <string>
#include <string_view>
#include <sys/resource.h>

namespace {

struct Subject {
    const char* file;
    const char* text;
    double most_seconds;
    double most_megabytes;
};
constexpr Subject machine{"large_machine_table", "400 components, 800 connections, 100 reactions", 60, 1000};
constexpr Subject of_a_system{"large_system_table", "one of 10 machines with 100 rows across", 60, 2000};

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
    if (compiler.empty() || source.empty() || build.empty() || (what != "machine" && what != "system")) {
        std::cerr << "usage: large_machine --compiler PATH --flags FLAGS|@FILE --source DIR --build DIR "
                     "[--what machine|system]\n";
        return 2;
    }
    if (flags.starts_with('@')) {
        std::ifstream file{flags.substr(1)};
        std::getline(file, flags);
    }
    const Subject& subject = what == "system" ? of_a_system : machine;
    const std::string table = build + "/" + subject.file;
    {
        std::ofstream file{table + ".cpp"};
        if (what == "system")
            tappet::diagnostics::write_system(file, {});
        else
            tappet::diagnostics::write_machine(file, {});
        if (!file.flush()) {
            std::cerr << table << ".cpp cannot be written\n";
            return 2;
        }
    }
    const std::string command =
        "cd '" + source + "' && '" + compiler + "' " + flags + " -c '" + table + ".cpp' -o '" + table + ".o'";
    if (std::system(command.c_str()) != 0) {
        std::cout << subject.text << ": does not compile\n";
        return 1;
    }
    rusage used{};
    getrusage(RUSAGE_CHILDREN, &used);
    const double time = seconds(used.ru_utime) + seconds(used.ru_stime);
    const double memory = static_cast<double>(used.ru_maxrss) / 1000;
    std::cout << subject.text << ": " << time << " s of processor time, " << memory << " MB (limits "
              << subject.most_seconds << " s, " << subject.most_megabytes << " MB)\n";
    return time < subject.most_seconds && memory < subject.most_megabytes ? 0 : 1;
}
