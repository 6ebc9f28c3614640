// From words to an exit code: one command, or a prompt with many.
#include "toolchain/tools/browser/program.hpp"

#include "toolchain/tools/browser/shell.hpp"
#include "toolchain/tools/browser/value.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <iostream>
#include <ostream>

namespace tappet::browser {

namespace {

int tell(const Surroundings& surroundings, const Failure& failure, bool json) {
    const int code = static_cast<int>(failure.fault);
    if (json)
        surroundings.errors << "{\"error\": " << in_quotes(failure.sentence) << ", \"exit\": " << code
                            << "}\n";
    else
        surroundings.errors << "tappet-browse: " << failure.sentence << "\n";
    surroundings.errors.flush();
    return code;
}

Result<Machines> open_machines(const Line& line) {
    if (line.words.size() < 2 || line.words.front() != "post-mortem") return Machines::find(line);
    auto box = Session::open_black_box(line.words[1]);
    if (!box) return std::unexpected(box.error());
    return Machines::of(std::move(*box));
}

std::vector<Failure> run_line(Machines& machines, const Line& line, const Surroundings& surroundings) {
    auto failures = run_among(machines, line, surroundings.out, surroundings.screen, surroundings.signal);
    surroundings.out.flush();
    return failures;
}

std::string help_about(std::span<const std::string> words) {
    if (words.size() > 1) {
        const Command* command = find_command(words[1]);
        return command != nullptr ? help_of(*command) : unknown_command(words[1]) + "\n";
    }
    std::string text;
    for (const Command& each : commands()) text += help_of(each);
    return text + "help [COMMAND]\n    this\nquit\n    ends the prompt, as ^D does\n";
}

/// Runs lines of the prompt. For lines from a file, the program's exit code is that of the last failure.
class Lines {
public:
    Lines(Machines& machines, const Line& first, Surroundings& surroundings)
        : machines_{machines}, first_{first}, surroundings_{surroundings} {}

    Next run(const std::string& text) {
        if (surroundings_.signal != nullptr) *surroundings_.signal = 0;
        const auto words = split_line(text);
        if (!words) return fail({Fault::bad_request, words.error()});
        if (words->empty() || words->front().starts_with('#')) return Next::prompt;
        auto line = parse_line(*words);
        if (!line) return fail({Fault::bad_request, line.error()});
        if (line->words.empty()) return Next::prompt;
        const std::string& verb = line->words.front();
        if (verb == "quit" || verb == "exit") return Next::end;
        if (verb == "help" || line->help) {
            if (line->help) line->words.insert(line->words.begin(), "help");
            surroundings_.out << help_about(line->words) << std::flush;
            return Next::prompt;
        }
        line->json = line->json || first_.json;
        Next next = Next::prompt;
        for (const Failure& failure : run_line(machines_, *line, surroundings_))
            if (fail(failure) == Next::end) next = Next::end;
        return next;
    }
    [[nodiscard]] int code() const { return code_; }

private:
    Next fail(const Failure& failure) {
        const int code = tell(surroundings_, failure, first_.json);
        if (!surroundings_.interactive) code_ = code;
        if (failure.fault != Fault::no_machine || machines_.are_several()) return Next::prompt;
        code_ = code;
        return Next::end;
    }

    Machines& machines_;
    const Line& first_;
    Surroundings& surroundings_;
    int code_ = 0;
};

int run_lines(Machines& machines, const Line& first, Surroundings& surroundings) {
    Lines lines{machines, first, surroundings};
    const auto run = [&lines](const std::string& line) { return lines.run(line); };
    if (surroundings.interactive) {
        surroundings.out << "tab completes, help explains, quit ends";
        const std::vector<Session*> sessions = machines.reachable();
        if (machines.are_several())
            surroundings.out << "; " << sessions.size() << " of " << machines.names()
                             << " answer, list shows them";
        else
            surroundings.out << "; you are its " << sessions.front()->role();
        surroundings.out << std::endl;
        Shell{machines, surroundings.history_file, surroundings.signal, run}.run();
        return lines.code();
    }
    for (std::string line; std::getline(std::cin, line);)
        if (run(line) == Next::end) break;
    return lines.code();
}

int run(std::span<const std::string> words, Surroundings& surroundings) {
    const auto line = parse_line(words);
    if (!line) return tell(surroundings, {Fault::bad_request, line.error()}, false);
    if (line->help || (!line->words.empty() && line->words.front() == "help")) {
        const std::size_t named = !line->words.empty() && line->words.front() == "help" ? 1 : 0;
        if (line->words.size() <= named) {
            surroundings.out << usage();
            return 0;
        }
        const Command* const command = find_command(line->words[named]);
        if (command == nullptr)
            return tell(surroundings, {Fault::bad_request, unknown_command(line->words[named])}, line->json);
        surroundings.out << help_of(*command);
        return 0;
    }
    // Reports a misspelt command without a machine.
    const Command* const command = line->words.empty() ? nullptr : find_command(line->words.front());
    if (command == nullptr && !line->words.empty())
        return tell(surroundings, {Fault::bad_request, unknown_command(line->words.front())}, line->json);
    if (const auto fits = check_options(command, *line); !fits)
        return tell(surroundings, fits.error(), line->json);
    if (is_about_files(*line)) {
        const auto done = run_report_of_files(*line, surroundings.out);
        return done ? 0 : tell(surroundings, done.error(), line->json);
    }
    auto machines = open_machines(*line);
    if (!machines) return tell(surroundings, machines.error(), line->json);
    if (line->words.empty()) return run_lines(*machines, *line, surroundings);
    int code = 0;
    for (const Failure& failure : run_line(*machines, *line, surroundings))
        code = std::max(code, tell(surroundings, failure, line->json));
    return code;
}

} // namespace

int run_program(std::span<const std::string> words, Surroundings& surroundings) {
    try {
        return run(words, surroundings);
    } catch (const nlohmann::json::exception& wrong) {
        return tell(surroundings,
                    {Fault::no_machine,
                     std::string{"an answer violates the protocol; is another program at this socket? "} +
                         wrong.what()},
                    false);
    }
}

} // namespace tappet::browser
