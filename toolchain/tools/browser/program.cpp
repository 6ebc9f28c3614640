// From words to an exit code: one command, or a prompt with many.
#include "toolchain/tools/browser/program.hpp"

#include "toolchain/tools/browser/shell.hpp"
#include "toolchain/tools/browser/value.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <filesystem>
#include <iostream>
#include <ostream>

namespace tappet::browser {

int tell_failure(std::ostream& errors, const Failure& failure, bool json) {
    const int code = static_cast<int>(failure.fault);
    if (json)
        errors << "{\"error\": " << in_quotes(failure.sentence) << ", \"exit\": " << code << "}\n";
    else
        errors << "tappet-browse: " << failure.sentence << "\n";
    errors.flush();
    return code;
}

std::expected<Line, int> accept_line(std::span<const std::string> words, std::ostream& out,
                                     std::ostream& errors) {
    auto line = parse_line(words);
    if (!line) return std::unexpected(tell_failure(errors, {Fault::bad_request, line.error()}, false));
    const std::size_t named = !line->words.empty() && line->words.front() == "help" ? 1 : 0;
    const bool is_help = line->help || named == 1;
    if (is_help && line->words.size() <= named) {
        out << usage();
        return std::unexpected(0);
    }
    if (line->words.empty()) {
        if (const auto fits = check_options(nullptr, *line); !fits)
            return std::unexpected(tell_failure(errors, fits.error(), line->json));
        return std::move(*line);
    }
    const Command* const command = find_command(line->words[is_help ? named : 0]);
    if (command == nullptr)
        return std::unexpected(tell_failure(
            errors, {Fault::bad_request, unknown_command(line->words[is_help ? named : 0])}, line->json));
    if (is_help) {
        out << help_of(*command);
        return std::unexpected(0);
    }
    if (const auto fits = check_options(command, *line); !fits)
        return std::unexpected(tell_failure(errors, fits.error(), line->json));
    return std::move(*line);
}

namespace {

Failure not_the_protocol(const nlohmann::json::exception& thrown) {
    return {Fault::no_machine,
            std::string{"an answer violates the protocol; is another program at this socket? "} +
                thrown.what()};
}

/// Prints the failures. Returns the exit code.
int tell_all(std::ostream& errors, std::span<const Failure> failures, bool json) {
    int code = 0;
    for (const Failure& failure : failures) code = std::max(code, tell_failure(errors, failure, json));
    return code;
}

Result<Machines> open_machines(const Line& line) {
    if (line.words.size() < 2 || line.words.front() != "post-mortem") return Machines::find(line);
    auto box = Session::open_black_box(line.words[1]);
    if (!box) return std::unexpected(box.error());
    return Machines::of(std::move(*box));
}

std::vector<Failure> run_line(Machines& machines, const Line& line, const Means& means) {
    auto failures = run_among(machines, line, means);
    means.out.flush();
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
    Lines(Machines& machines, const Line& first, Surroundings& surroundings, const Means& means)
        : machines_{machines}, first_{first}, surroundings_{surroundings}, means_{means} {}

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
        for (const Failure& failure : run_line(machines_, *line, means_))
            if (fail(failure) == Next::end) next = Next::end;
        return next;
    }
    [[nodiscard]] int code() const { return code_; }

private:
    Next fail(const Failure& failure) {
        const int code = tell_failure(surroundings_.errors, failure, first_.json);
        if (!surroundings_.interactive) code_ = code;
        if (failure.fault != Fault::no_machine || machines_.are_several()) return Next::prompt;
        code_ = code;
        return Next::end;
    }

    Machines& machines_;
    const Line& first_;
    Surroundings& surroundings_;
    const Means& means_;
    int code_ = 0;
};

int run_lines(Machines& machines, const Line& first, Surroundings& surroundings, const Means& means) {
    Lines lines{machines, first, surroundings, means};
    const auto run = [&lines](const std::string& line) { return lines.run(line); };
    if (surroundings.interactive) {
        if (machines.are_several()) static_cast<void>(list_machines(machines, first, means));
        surroundings.out << "tab completes, help explains, quit ends";
        if (!machines.are_several())
            surroundings.out << "; you are its " << machines.reachable().front()->role();
        surroundings.out << std::endl;
        Shell{machines, surroundings.history_file, surroundings.signal, run}.run();
        return lines.code();
    }
    for (std::string line; std::getline(std::cin, line);)
        if (run(line) == Next::end) break;
    return lines.code();
}

int run(std::span<const std::string> words, Surroundings& surroundings) {
    LocalFiles files;
    const Means means{surroundings.out, files, surroundings.signal, surroundings.screen};
    const auto line = accept_line(words, surroundings.out, surroundings.errors);
    if (!line) return line.error();
    if (is_about_files(*line)) {
        const auto done = run_report_of_files(*line, means);
        return done ? 0 : tell_failure(surroundings.errors, done.error(), line->json);
    }
    auto machines = open_machines(*line);
    if (!machines) return tell_failure(surroundings.errors, machines.error(), line->json);
    if (line->words.empty()) return run_lines(*machines, *line, surroundings, means);
    return tell_all(surroundings.errors, run_line(*machines, *line, means), line->json);
}

/// Puts the black box that the user names into the line, by its path. `shown`: the directory of those that
/// may be named.
Result<void> name_black_box(Line& line, const std::string& shown) {
    constexpr std::string_view suffix = ".blackbox";
    if (shown.empty())
        return wrong("no black boxes are shown here; fetch the file, and name it without an address");
    std::string known;
    std::error_code error;
    for (std::filesystem::directory_iterator each{shown, error}, end; !error && each != end;
         each.increment(error)) {
        const std::string name = each->path().filename().string();
        if (!name.ends_with(suffix)) continue;
        if (line.words.size() > 1 && name == line.words[1]) {
            line.words[1] = each->path().string();
            return {};
        }
        known += (known.empty() ? "" : ", ") + name;
    }
    return wrong(known.empty()
                     ? "there is no black box; a guardian writes one when its machine ends unexpectedly"
                     : "name one of the black boxes, as in post-mortem NAME; there are " + known);
}

/// Returns why a user elsewhere may not run the line.
Result<void> check_remote(const Line& line) {
    for (const char* const option : {"--socket", "--directory"})
        if (std::ranges::find(line.given, option) != line.given.end())
            return wrong(std::string{option} +
                         " names a place on this program's own host; remove it, the address "
                         "says which machines are meant");
    if (line.words.size() > 1 && line.words[0] == "scope" && line.words[1] == "record" &&
        line.length > most_remote_cycles)
        return wrong("over the network, 'scope record' takes at most " +
                     std::to_string(most_remote_cycles.count() / 1000) + "s; record several times");
    return {};
}

int run_remote(const RemoteLine& remote) {
    auto line = accept_line(remote.words, remote.out, remote.errors);
    if (!line) return line.error();
    const auto refuse = [&](const Failure& failure) {
        return tell_failure(remote.errors, failure, line->json);
    };
    if (const auto may = check_remote(*line); !may) return refuse(may.error());
    line->directory = remote.directory;
    line->patience = std::min(line->patience, most_remote_patience);
    const Means means{remote.out, remote.files, &remote.stop, remote.screen.has_value(), remote.screen};
    if (is_about_files(*line)) {
        const auto done = run_report_of_files(*line, means);
        return done ? 0 : refuse(done.error());
    }
    const bool is_dead = !line->words.empty() && line->words.front() == "post-mortem";
    if (is_dead)
        if (const auto named = name_black_box(*line, remote.black_boxes); !named)
            return refuse(named.error());
    auto machines = is_dead ? open_machines(*line) : Machines::find(*line, remote.user);
    if (!machines) return refuse(machines.error());
    const auto failures =
        line->words.empty() ? list_machines(*machines, *line, means) : run_line(*machines, *line, means);
    return tell_all(remote.errors, failures, line->json);
}

} // namespace

int run_program(std::span<const std::string> words, Surroundings& surroundings) {
    try {
        return run(words, surroundings);
    } catch (const nlohmann::json::exception& thrown) {
        return tell_failure(surroundings.errors, not_the_protocol(thrown), false);
    }
}

int run_remote_line(const RemoteLine& remote) {
    try {
        return run_remote(remote);
    } catch (const nlohmann::json::exception& thrown) {
        return tell_failure(remote.errors, not_the_protocol(thrown), false);
    }
}

} // namespace tappet::browser
