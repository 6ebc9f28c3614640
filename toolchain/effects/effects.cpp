// Compiles a source and has clang follow its function effects at the same time, so that g++ too refuses code
// of components that may block. CMake puts it before the compiler (toolchain/effects.cmake):
//     tappet-effects CHECK... -- COMPILE...
// CHECK is clang with its options, COMPILE the whole command of the other compiler. The source, the macros
// and the folders of headers are taken from COMPILE. The object is kept only if both succeed.
#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

namespace {

using Words = std::vector<std::string>;

int fail(std::string_view what, std::string_view why) {
    std::fprintf(stderr, "tappet-effects: %.*s: %.*s\n", static_cast<int>(what.size()), what.data(),
                 static_cast<int>(why.size()), why.data());
    return 3;
}

/// Returns the words of a compilation that change the meaning of its source; the other ones (optimisation,
/// warnings, outputs) differ between the compilers.
Words meaning_of(std::span<char* const> compile) {
    constexpr std::string_view begun[] = {"-D", "-U", "-I", "-std=", "-m", "-pthread"};
    constexpr std::string_view followed[] = {"-isystem", "-iquote", "-include", "-c"};
    Words words;
    for (std::size_t i = 0; i < compile.size(); ++i) {
        const std::string_view word = compile[i];
        if (std::ranges::find(followed, word) != std::end(followed) && i + 1 < compile.size()) {
            words.insert(words.end(), {compile[i], compile[i + 1]});
            ++i;
        } else if (word == "-o" || word.starts_with("-M")) {
            if (word == "-o" || word == "-MT" || word == "-MF" || word == "-MQ") ++i;
        } else if (std::ranges::any_of(begun,
                                       [&](std::string_view each) { return word.starts_with(each); })) {
            words.emplace_back(word);
        }
    }
    return words;
}

std::string object_of(std::span<char* const> compile) {
    const auto option = std::ranges::find(compile, std::string_view{"-o"});
    return option == compile.end() || option + 1 == compile.end() ? "" : *(option + 1);
}

/// Starts a program, with its messages written to `messages` unless that is empty. Returns its number; -1:
/// errno says why it did not start.
pid_t start(const Words& words, const std::string& messages) {
    std::vector<char*> arguments;
    for (const std::string& word : words) arguments.push_back(const_cast<char*>(word.c_str()));
    arguments.push_back(nullptr);
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    if (!messages.empty()) {
        posix_spawn_file_actions_addopen(&actions, 2, messages.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0644);
        posix_spawn_file_actions_adddup2(&actions, 2, 1);
    }
    pid_t started = -1;
    errno = posix_spawnp(&started, arguments[0], &actions, nullptr, arguments.data(), environ);
    const int fault = errno;
    posix_spawn_file_actions_destroy(&actions);
    errno = fault;
    return fault == 0 ? started : -1;
}

int exit_code_of(pid_t program) {
    int status = 0;
    while (waitpid(program, &status, 0) < 0)
        if (errno != EINTR) return 3;
    return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

/// Prints clang's errors with their lines of source and the first reason of each, without the whole chain of
/// calls below it. A file without an error, as of a crash, is printed whole.
void print_errors(const std::string& path) {
    std::ifstream file{path};
    std::string whole, errors;
    enum class Part { left_out, error, note } part = Part::left_out;
    for (std::string line; std::getline(file, line);) {
        const bool is_error = line.find(": error: ") != line.npos,
                   is_note = line.find(": note: ") != line.npos;
        const bool gives_reason = is_note && part == Part::error;
        if (is_error)
            part = Part::error;
        else if (gives_reason)
            part = Part::note;
        else if (is_note || line.starts_with("In file included from") || line.ends_with(" generated."))
            part = Part::left_out;
        if (gives_reason || (part == Part::error)) errors += line + '\n';
        whole += line + '\n';
    }
    std::fputs(errors.empty() ? whole.c_str() : errors.c_str(), stderr);
}

} // namespace

int main(int count, char** all) {
    const std::span<char* const> words{all + 1, static_cast<std::size_t>(count - 1)};
    const auto middle = std::ranges::find(words, std::string_view{"--"});
    if (middle == words.begin() || middle == words.end() || middle + 1 == words.end())
        return fail("usage", "tappet-effects CHECK... -- COMPILE...");
    const std::span<char* const> compile{middle + 1, words.end()};
    const std::string object = object_of(compile);
    if (object.empty()) return fail("the compiler's command", "it has no -o OBJECT");
    const std::string checked = object + ".effects", messages = checked + ".txt";
    Words check(words.begin(), middle);
    for (const std::string& word : meaning_of(compile)) check.push_back(word);
    check.insert(check.end(), {"-o", checked});

    const pid_t checks = start(check, messages);
    if (checks < 0) return fail(check[0], std::strerror(errno));
    const pid_t compiles = start(Words(compile.begin(), compile.end()), "");
    const int compiled = compiles < 0 ? fail(compile[0], std::strerror(errno)) : exit_code_of(compiles);
    const int is_real_time = exit_code_of(checks);
    // A source that does not compile has its own compiler's sentences only: clang's would repeat them.
    if (compiled == 0 && is_real_time != 0) {
        print_errors(messages);
        std::fputs(
            "tappet: the source compiles, but clang finds that a real-time function may block (above; "
            "TAPPET_REALTIME marks them). Call it from an activity that is not_real_time, or replace it; the "
            "guide's page rules.md says what real-time code may do\n",
            stderr);
        unlink(object.c_str());
    }
    unlink(checked.c_str());
    unlink(messages.c_str());
    return compiled != 0 ? compiled : is_real_time;
}
