// The prompt with libedit: tab completes or lists, arrows and ^R search the history.
#include "toolchain/tools/browser/shell.hpp"

#include "toolchain/tools/browser/completion.hpp"

#include <cerrno>
#include <csignal>
#include <cstdio>

#include <histedit.h>
#include <poll.h>
#include <unistd.h>

namespace tappet::browser {

namespace {

constexpr int history_lines = 500;
constexpr std::size_t listed_most = 60;

/// The data of libedit's callbacks, passed through EL_CLIENTDATA.
struct Client {
    Machines& machines;
    std::string prompt{};
};

Client& client_of(EditLine* editor) {
    Client* client = nullptr;
    ::el_get(editor, EL_CLIENTDATA, &client);
    return *client;
}

char* prompt_of(EditLine* editor) { return client_of(editor).prompt.data(); }

void print_candidates(const Completion& completion) {
    std::fputc('\n', stdout);
    std::size_t told = 0;
    for (const std::string& each : completion.candidates) {
        if (++told > listed_most) {
            std::printf("... and %zu more\n", completion.candidates.size() - listed_most);
            break;
        }
        std::printf("%s\n", each.c_str());
    }
    std::fflush(stdout);
}

unsigned char on_tab(EditLine* editor, int) {
    const LineInfo* line = ::el_line(editor);
    const std::string before{line->buffer, static_cast<std::size_t>(line->cursor - line->buffer)};
    const Completion completion = complete(client_of(editor).machines, before);
    if (completion.candidates.empty()) return CC_REFRESH_BEEP;
    std::string more = completion.common().substr(before.size() - completion.begin);
    // A component's name continues with a dot: no blank after it while others begin with it.
    if (completion.candidates.size() == 1) more += ' ';
    if (more.empty()) {
        print_candidates(completion);
        return CC_REDISPLAY;
    }
    return ::el_insertstr(editor, more.c_str()) == 0 ? CC_REFRESH : CC_REFRESH_BEEP;
}

/// While a line is typed, signals are unblocked only during the wait for the next character, which they end:
/// a signal just before the wait would otherwise have no effect until the next character.
class SignalsHeld {
public:
    SignalsHeld() {
        sigset_t held;
        sigemptyset(&held);
        for (const int signal : {SIGINT, SIGTERM, SIGHUP}) sigaddset(&held, signal);
        ::sigprocmask(SIG_BLOCK, &held, &before_);
        open = before_;
    }
    ~SignalsHeld() { ::sigprocmask(SIG_SETMASK, &before_, nullptr); }
    SignalsHeld(const SignalsHeld&) = delete;
    SignalsHeld& operator=(const SignalsHeld&) = delete;

    static inline sigset_t open{}; ///< the mask of the wait

private:
    sigset_t before_{};
};

int read_character(EditLine*, wchar_t* character) {
    pollfd input{STDIN_FILENO, POLLIN, 0};
    if (::ppoll(&input, 1, nullptr, &SignalsHeld::open) < 0) return -1;
    char byte = 0;
    const ssize_t count = ::read(STDIN_FILENO, &byte, 1);
    // An end of input typed before the prompt owned the terminal arrives as a zero.
    constexpr wchar_t end_of_input = 4;
    *character = byte == 0 ? end_of_input : static_cast<unsigned char>(byte);
    return static_cast<int>(count);
}

std::string without_end(const char* text, int count) {
    std::string line{text, static_cast<std::size_t>(count)};
    while (!line.empty() && (line.back() == '\n' || line.back() == '\r' || line.back() == ' '))
        line.pop_back();
    return line;
}

} // namespace

void Shell::run() {
    Client client{machines_, machines_.are_several() ? std::to_string(machines_.all().size()) + " machines> "
                                                     : machines_.all().front().name + "> "};
    EditLine* const editor = ::el_init("tappet-browse", stdin, stdout, stderr);
    if (editor == nullptr) return;
    History* const history = ::history_init();
    HistEvent event{};
    ::history(history, &event, H_SETSIZE, history_lines);
    ::history(history, &event, H_SETUNIQUE, 1);
    if (!history_file_.empty()) ::history(history, &event, H_LOAD, history_file_.c_str());
    ::el_set(editor, EL_CLIENTDATA, &client);
    ::el_set(editor, EL_PROMPT, &prompt_of);
    ::el_set(editor, EL_EDITOR, "emacs");
    ::el_set(editor, EL_HIST, ::history, history);
    ::el_set(editor, EL_SIGNAL, 0);
    ::el_set(editor, EL_GETCFN, &read_character);
    ::el_set(editor, EL_ADDFN, "tappet-complete", "completes a command or a name", &on_tab);
    ::el_set(editor, EL_BIND, "^I", "tappet-complete", nullptr);
    ::el_set(editor, EL_BIND, "^R", "em-inc-search-prev", nullptr);
    for (;;) {
        int count = 0;
        const char* text = nullptr;
        int error = 0;
        {
            const SignalsHeld held;
            errno = 0;
            text = ::el_gets(editor, &count);
            error = errno;
        }
        if (text == nullptr && error == EINTR && signal_ != nullptr && *signal_ == SIGINT) {
            std::fputs("\n", stdout);
            ::el_reset(editor);
            continue;
        }
        if (text == nullptr || count <= 0) break;
        const std::string line = without_end(text, count);
        if (line.empty()) continue;
        ::history(history, &event, H_ENTER, line.c_str());
        if (run_(line) == Next::end) break;
    }
    if (!history_file_.empty()) ::history(history, &event, H_SAVE, history_file_.c_str());
    ::history_end(history);
    ::el_end(editor);
}

} // namespace tappet::browser
