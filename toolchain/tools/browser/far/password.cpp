// The terminal is /dev/tty: standard input may be a pipe.
#include "toolchain/tools/browser/far/password.hpp"

#include <array>
#include <cstdlib>
#include <fstream>

#include <fcntl.h>
#include <sys/stat.h>
#include <termios.h>
#include <unistd.h>

namespace tappet::browser {

namespace {

Result<std::string> read_password(const std::string& name) {
    struct stat state{};
    std::ifstream file{name};
    if (!file || ::stat(name.c_str(), &state) != 0)
        return wrong("'" + name + "', which TAPPET_PASSWORD_FILE names, cannot be opened; is it there?");
    if ((state.st_mode & 077) != 0)
        return wrong("'" + name + "' holds a password and others may read it; chmod 600 it");
    std::string line;
    std::getline(file, line);
    if (line.empty()) return wrong("'" + name + "' is empty; write the password into its first line");
    return line;
}

} // namespace

Result<std::string> ask_password(const std::string& question) {
    if (const char* const file = std::getenv("TAPPET_PASSWORD_FILE"); file != nullptr && *file != 0)
        return read_password(file);
    const int terminal = ::open("/dev/tty", O_RDWR | O_CLOEXEC | O_NOCTTY);
    termios before{};
    if (terminal < 0 || ::tcgetattr(terminal, &before) != 0) {
        if (terminal >= 0) ::close(terminal);
        return wrong("there is no terminal to ask the password at; write it into a file, and name that in "
                     "TAPPET_PASSWORD_FILE");
    }
    termios quiet = before;
    quiet.c_lflag &= ~static_cast<tcflag_t>(ECHO);
    ::tcsetattr(terminal, TCSAFLUSH, &quiet);
    static_cast<void>(::write(terminal, question.data(), question.size()));
    std::string password;
    bool is_given = false;
    std::array<char, 256> typed{};
    if (const ssize_t count = ::read(terminal, typed.data(), typed.size());
        count > 0) { // one line; a signal ends it
        password.assign(typed.data(), static_cast<std::size_t>(count));
        is_given = password.ends_with('\n');
    }
    ::tcsetattr(terminal, TCSAFLUSH, &before);
    static_cast<void>(::write(terminal, "\n", 1));
    ::close(terminal);
    if (!is_given) return wrong("no password was typed");
    password.pop_back();
    return password;
}

} // namespace tappet::browser
