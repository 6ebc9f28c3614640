// Compiles each faulty case with the compiler of this build and compares the message with the case's golden
// sentence. There is a case for each way of a refusal into a compiler's message, and for faults that only a
// compiler can see; every other fault is a row of tests/diagnostics/rows, where the same check runs without a
// compiler.
//     diagnostics --compiler PATH --flags FLAGS|@FILE --source DIR --build DIR [--cases DIR --header FILE]
//                 [--lines N] [--only TEXT] [--write]
// The header is included first by every case, and parsed once; N lines may be printed of one. A case states
// in its second line what is expected:
//     // refused: <the sentence, the same from both compilers; # stands for any number>
//     // refused by clang: <a part of the first error, or of the line it points at: the function that is not
//     real-time>
//     // refused by name: <a name that both compilers show beside the faulty line>
//     // and by clang: <what clang shows in addition; in the third line>
//     // accepted
// --write prints the sentences instead of comparing them.
#include <algorithm>
#include <array>
#include <cctype>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <mutex>
#include <sstream>
#include <string>
#include <string_view>
#include <sys/wait.h>
#include <thread>
#include <vector>

namespace {

/// The most lines that a compiler may print for one faulty table, with the sentence.
constexpr std::size_t most_lines = 9;
/// For a script the sentence comes first, then the lines that lead to the compilation.
constexpr std::size_t most_script_lines = 14;
constexpr std::size_t most_named_lines = 16;  // clang shows each call on the way to the fault
constexpr std::size_t most_effect_lines = 28; // and what that function calls in the standard library
constexpr unsigned at_a_time = 2;
constexpr std::size_t most_told = 10;

struct Options {
    std::string compiler, flags, source, build, only;
    std::string cases, header = "tests/diagnostics/small_machine.hpp", lines;
    bool write = false;
    bool clang = false;
};

struct Output {
    int status = -1;
    std::string text;
};

struct Case {
    std::filesystem::path file;
    std::string expected;
    std::string by_clang; ///< the expected text of clang beside the name
    bool effects = false;
    bool named = false;
    bool accepted = false;
    std::string fault; ///< empty: as expected
    std::string sentence;
};

Output run(const std::string& command) {
    Output output;
    FILE* pipe = popen((command + " 2>&1").c_str(), "r");
    if (pipe == nullptr) return output;
    std::array<char, 4096> block{};
    while (const std::size_t n = std::fread(block.data(), 1, block.size(), pipe))
        output.text.append(block.data(), n);
    const int status = pclose(pipe);
    output.status = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
    return output;
}

/// The first error, and the source line that the compiler shows below it.
struct FirstError {
    std::string error, source;
};

FirstError first_error(const std::string& text) {
    FirstError first;
    std::istringstream lines{text};
    for (std::string line; std::getline(lines, line);) {
        if (line.find("error: ") == std::string::npos) continue;
        first.error = line;
        std::getline(lines, first.source);
        break;
    }
    return first;
}

/// Counts lines, except those that list the including headers: they belong to the case.
std::size_t lines_of(const std::string& text) {
    std::size_t count = 0;
    std::istringstream lines{text};
    for (std::string line; std::getline(lines, line);)
        count += !line.starts_with("In file included from") && !line.starts_with("                 from ");
    return count;
}

/// The text between two marks; g++ prints the sentence as a string literal, clang as plain text.
std::string sentence_of(const std::string& error) {
    const auto between = [&error](std::string_view open, std::string_view close) {
        const std::size_t begin = error.find(open);
        if (begin == std::string::npos) return std::string{};
        const std::size_t end = close.empty() ? error.size() : error.rfind(close);
        return error.substr(begin + open.size(), end - begin - open.size());
    };
    for (const std::string_view open : {"requirement 'accepted': ", ".empty()': "})
        if (std::string plain = between(open, ""); !plain.empty()) return plain;
    std::string sentence;
    const std::string literal = between(">{\"", "\"}>");
    for (std::size_t i = 0; i < literal.size(); ++i) {
        if (literal[i] == '\\' && i + 1 < literal.size()) ++i;
        sentence += literal[i];
    }
    return sentence;
}

/// Returns whether both are equal; # in the expected text stands for any number.
bool matches(std::string_view expected, std::string_view said) {
    std::size_t at = 0;
    for (const char character : expected) {
        if (character != '#') {
            if (at == said.size() || said[at++] != character) return false;
            continue;
        }
        const std::size_t begin = at;
        while (at < said.size() && std::isdigit(static_cast<unsigned char>(said[at])) != 0) ++at;
        if (at == begin) return false;
    }
    return at == said.size();
}

bool is_clang(const Options& options) {
    return run(options.compiler + " --version").text.find("clang") != std::string::npos;
}

std::vector<Case> read_cases(const Options& options, std::string& fault) {
    std::vector<Case> cases;
    for (const auto& entry : std::filesystem::directory_iterator{options.cases}) {
        if (entry.path().extension() != ".cpp" ||
            entry.path().stem().string().find(options.only) == std::string::npos)
            continue;
        std::ifstream file{entry.path()};
        std::string line;
        std::getline(file, line);
        std::getline(file, line);
        constexpr std::string_view refused = "// refused: ", by_clang = "// refused by clang: ",
                                   by_name = "// refused by name: ", and_by_clang = "// and by clang: ";
        Case each;
        each.file = entry.path();
        each.effects = line.starts_with(by_clang);
        each.accepted = line == "// accepted";
        if (each.effects)
            each.expected = line.substr(by_clang.size());
        else if ((each.named = line.starts_with(by_name))) {
            each.expected = line.substr(by_name.size());
            if (std::getline(file, line) && line.starts_with(and_by_clang))
                each.by_clang = line.substr(and_by_clang.size());
        } else if (line.starts_with(refused))
            each.expected = line.substr(refused.size());
        else if (!each.accepted)
            fault = entry.path().string() + ": its second line is no \"// refused: ...\"";
        cases.push_back(each);
    }
    std::sort(cases.begin(), cases.end(), [](const Case& a, const Case& b) { return a.file < b.file; });
    return cases;
}

/// Parses the headers once for all cases. Returns the flags that use them, or nothing after printing the
/// fault.
std::string precompile(const Options& options, bool clang) {
    const std::filesystem::path place =
        options.build + "/precompiled/" + options.header + (clang ? ".pch" : ".gch");
    std::filesystem::create_directories(place.parent_path());
    const Output made = run("cd '" + options.source + "' && '" + options.compiler + "' " + options.flags +
                            " -x c++-header " + options.header + " -o '" + place.string() + "'");
    if (made.status != 0) {
        std::cerr << made.text;
        return {};
    }
    return clang ? "-include-pch '" + place.string() + "'" : "-I'" + options.build + "/precompiled'";
}

void judge(Case& each, const Options& options, const std::string& headers) {
    const Output output = run("cd '" + options.source + "' && '" + options.compiler + "' " + headers + " " +
                              options.flags + " -fsyntax-only '" + each.file.string() + "'");
    const auto [error, source] = first_error(output.text);
    const std::size_t lines = lines_of(output.text);
    const std::string stem = each.file.stem().string();
    const bool is_script = stem.starts_with("script_") || stem.starts_with("eds_") ||
                           stem.starts_with("network_") || stem.starts_with("dbc_value_");
    const std::size_t most = !options.lines.empty() ? std::stoul(options.lines)
                             : is_script            ? most_script_lines
                                                    : most_lines;
    each.sentence = each.effects ? error : sentence_of(error);
    if (each.accepted)
        each.fault = output.status == 0 ? "" : "it does not compile:\n" + output.text.substr(0, 4000);
    else if (output.status == 0)
        each.fault = "it compiles";
    else if (each.named) {
        const std::string place = each.file.filename().string() + ":";
        const bool is_shown = !options.clang || output.text.find(each.by_clang) != std::string::npos;
        if (!is_shown || output.text.find(each.expected) == std::string::npos ||
            output.text.find(place) == std::string::npos)
            each.fault = "the name or the faulty line is not shown";
        else if (lines > most_named_lines)
            each.fault = std::to_string(lines) + " lines of output";
    } else if (each.effects && (error + source).find(each.expected) == std::string::npos)
        each.fault = "the first error does not name the function";
    else if (each.effects && lines > most_effect_lines)
        each.fault = std::to_string(lines) + " lines of output";
    else if (!each.effects && each.sentence.empty())
        each.fault = "the first error is no sentence of ours:\n" + output.text.substr(0, 4000);
    else if (!each.effects && !matches(each.expected, each.sentence))
        each.fault = "another sentence";
    else if (!each.effects && lines > most)
        each.fault =
            std::to_string(lines) + " lines of output; at most " + std::to_string(most) + " are wanted";
}

int judge_all(const Options& options) {
    std::string fault;
    std::vector<Case> cases = read_cases(options, fault);
    if (!options.clang) std::erase_if(cases, [](const Case& each) { return each.effects; });
    if (!fault.empty() || cases.empty()) {
        std::cerr << (fault.empty() ? "there is no case to compile" : fault) << '\n';
        return 2;
    }
    const std::string headers = precompile(options, options.clang);
    if (headers.empty()) return 2;

    std::mutex next_mutex;
    std::size_t next = 0;
    std::vector<std::thread> workers;
    for (unsigned worker = 0; worker < at_a_time; ++worker)
        workers.emplace_back([&] {
            while (true) {
                std::size_t mine = 0;
                {
                    const std::lock_guard lock{next_mutex};
                    if (next == cases.size()) return;
                    mine = next++;
                }
                judge(cases[mine], options, headers);
            }
        });
    for (std::thread& worker : workers) worker.join();

    std::size_t faults = 0;
    for (const Case& each : cases) {
        if (options.write) {
            std::cout << each.file.stem().string() << "\t" << each.sentence << '\n';
            continue;
        }
        if (each.fault.empty()) continue;
        if (++faults > most_told) continue;
        std::cout << "FAILED " << each.file.string() << ": " << each.fault
                  << "\n  expected: " << each.expected << "\n  said:     " << each.sentence << '\n';
    }
    if (options.write) return 0;
    std::cout << cases.size() - faults << " of " << cases.size()
              << " cases are judged as expected, word by word\n";
    return faults == 0 ? 0 : 1;
}

} // namespace

int main(int count, char** words) {
    Options options;
    for (int i = 1; i < count; ++i) {
        const std::string_view word = words[i];
        if (word == "--write") {
            options.write = true;
            continue;
        }
        std::string* place = word == "--compiler" ? &options.compiler
                             : word == "--flags"  ? &options.flags
                             : word == "--source" ? &options.source
                             : word == "--build"  ? &options.build
                             : word == "--only"   ? &options.only
                             : word == "--cases"  ? &options.cases
                             : word == "--header" ? &options.header
                             : word == "--lines"  ? &options.lines
                                                  : nullptr;
        if (place == nullptr || i + 1 == count) {
            std::cerr << "usage: diagnostics --compiler PATH --flags FLAGS --source DIR --build DIR "
                         "[--cases DIR --header FILE] [--lines N] [--only TEXT] [--write]\n";
            return 2;
        }
        *place = words[++i];
    }
    if (options.flags.starts_with('@')) {
        std::ifstream file{options.flags.substr(1)};
        if (!std::getline(file, options.flags)) {
            std::cerr << "the file of flags cannot be read\n";
            return 2;
        }
    }
    options.clang = is_clang(options);
    if (options.cases.empty()) options.cases = options.source + "/tests/diagnostics/cases";
    return judge_all(options);
}
