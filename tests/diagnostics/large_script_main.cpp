// What a large script costs to compile with the firmware: 100 states and 1000 statements, as native code.
//     large_script --compiler PATH --flags FLAGS|@FILE --source DIR --build DIR
// Fails above the limits. Time is the compiler's own processor time: it does not depend on who else uses the
// computer.
#include <cstdlib>
#include <fstream>
#include <iostream>
#include <string>
#include <string_view>
#include <sys/resource.h>

namespace {

constexpr double most_seconds = 60;
constexpr double most_megabytes = 2000;
constexpr int states = 100;

double seconds(const timeval& time) {
    return static_cast<double>(time.tv_sec) + static_cast<double>(time.tv_usec) * 1e-6;
}

void write_state(std::ostream& file, int number) {
    const std::string me = std::to_string(number);
    file << "    "
         << (number == 0            ? "initial "
             : number == states - 1 ? "final "
                                    : "")
         << "state S" << me << " {\n        entry { set n = " << me << "; set sum = sum + n; }\n"
         << "        run {\n            set x = x * 0.5 + " << me << ".25;\n"
         << "            if (x > 100.0) then { set x = 0.0; set odd = !odd; }\n"
         << "            set sum = sum % 1000 + n * 2;\n        }\n"
         << "        exit { set sum = sum - n; set odd = sum > 10 && n < 50; }\n";
    if (number != states - 1)
        file << "        transition beat if n == " << me << " then { set sum = sum + 1; } select S"
             << number + 1 << "\n        transitions { if x > 1000.0 then { set x = 1.0; } select S"
             << (number * 7 + 1) % states << " }\n";
    file << "    }\n";
}

void write_source(std::ostream& file) {
    file << "// Written by large_script.\n#include \"kernel/machine/table/compiled.hpp\"\n"
            "#include \"kernel/script/compiled.hpp\"\n\nnamespace tappet {\n\n"
            "struct Large {\n    Event<> beat;\n    static constexpr auto interface() {\n"
            "        return facets(event<&Large::beat>(\"beat\", \"on\"));\n    }\n};\n"
            "inline constexpr ScriptSource large_source{\"large.osd\", R\"osd(StateMachine Large {\n"
            "    var int n = 0;\n    var int sum = 0;\n    var double x = 0.0;\n    var bool odd = false;\n";
    for (int number = 0; number < states; ++number) write_state(file, number);
    file << "}\nRootStateMachine Large large\n)osd\"};\n"
            "inline constexpr auto large_reach = script_reach(reachable<Large>(\"large\"));\n"
            "inline constexpr ScriptUnit large_script = compiled_script<large_source, large_reach>;\n"
            "static_assert(large_script.types[0].machine.states.size() == "
         << states
         << ");\nstatic_assert(large_script.types[0].tables.nodes.size() >= 1000);\n"
            "extern const BehaviourRow row;\n"
            "constexpr BehaviourRow row = behaviour(\"large\", compiled<large_script>);\n\n} // namespace "
            "tappet\n";
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
        std::cerr << "usage: large_script --compiler PATH --flags FLAGS|@FILE --source DIR --build DIR\n";
        return 2;
    }
    if (flags.starts_with('@')) {
        std::ifstream file{flags.substr(1)};
        std::getline(file, flags);
    }
    const std::string script = build + "/large_script_unit.cpp";
    {
        std::ofstream file{script};
        write_source(file);
        if (!file.flush()) {
            std::cerr << script << " cannot be written\n";
            return 2;
        }
    }
    const std::string command = "cd '" + source + "' && '" + compiler + "' " + flags + " -c '" + script +
                                "' -o '" + build + "/large_script_unit.o'";
    if (std::system(command.c_str()) != 0) {
        std::cout << "the large script does not compile\n";
        return 1;
    }
    rusage used{};
    getrusage(RUSAGE_CHILDREN, &used);
    const double time = seconds(used.ru_utime) + seconds(used.ru_stime);
    const double memory = static_cast<double>(used.ru_maxrss) / 1000;
    std::cout << states << " states, 1000 statements: " << time << " s of processor time, " << memory
              << " MB (limits " << most_seconds << " s, " << most_megabytes << " MB)\n";
    return time < most_seconds && memory < most_megabytes ? 0 : 1;
}
