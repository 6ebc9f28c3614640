// SPDX-License-Identifier: Apache-2.0
// PID 1 of the bench: brings up the box the manifest describes (kernel modules, CAN interfaces, GPIO chips),
// runs the manifest's commands in order, hands results to the host and switches the power off. There is
// nothing else in the guest: no shell, no service, nothing that wakes up by itself and disturbs a
// measurement.

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <sstream>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include <dirent.h>
#include <fcntl.h>
#include <linux/if_link.h>
#include <linux/rtnetlink.h>
#include <net/if.h>
#include <sys/ioctl.h>
#include <sys/mount.h>
#include <sys/reboot.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

namespace tappet::bench {
namespace {

using std::chrono::milliseconds;

struct BackgroundCommand {
    std::string name;
    pid_t pid = -1;
    int exit_code = -1; // of a command that ended, until somebody asks
};

// What the host reads: one line per fact, written at once, so that a bench that hangs still tells how far it
// got.
class Results {
public:
    void open(int descriptor) { descriptor_ = descriptor; }

    void line(const std::string& text) { write_all(text + "\n"); }

    void write_all(std::string_view bytes) {
        while (descriptor_ >= 0 && !bytes.empty()) {
            const ssize_t count = ::write(descriptor_, bytes.data(), bytes.size());
            if (count < 0 && errno == EINTR) {
                continue;
            }
            if (count <= 0) {
                return;
            }
            bytes.remove_prefix(static_cast<std::size_t>(count));
        }
    }

private:
    int descriptor_ = -1;
};

Results results;
int console = -1;

// Marks in the stream of output, for the host's eyes only; the same in bench.cpp.
constexpr char start_of_output = '\x1d';
constexpr char end_of_output = '\x1e';

bool say_to_host(char mark) { return ::write(console, &mark, 1) == 1; }

std::vector<BackgroundCommand> background;

[[noreturn]] void power_off() {
    ::sync();
    ::reboot(RB_POWER_OFF);
    std::abort();
}

// The guest cannot go on: the host must learn why, and on the kernel's console too if no port is up yet.
[[noreturn]] void give_up(const std::string& what) {
    const std::string reason = what + ": " + std::strerror(errno);
    std::fprintf(stderr, "bench init: %s\n", reason.c_str());
    results.line("fault " + reason);
    power_off();
}

void pause_for(milliseconds time) { std::this_thread::sleep_for(time); }

void make_folder(const std::string& path) {
    for (std::size_t at = path.find('/', 1); at != std::string::npos; at = path.find('/', at + 1)) {
        ::mkdir(path.substr(0, at).c_str(), 0755);
    }
    ::mkdir(path.c_str(), 0755);
}

bool write_text(const std::string& path, const std::string& text) {
    const int descriptor = ::open(path.c_str(), O_WRONLY | O_CLOEXEC);
    if (descriptor < 0) {
        return false;
    }
    const ssize_t count = ::write(descriptor, text.data(), text.size());
    const int error = errno;
    ::close(descriptor);
    errno = error;
    return count == static_cast<ssize_t>(text.size());
}

std::string read_line(const std::string& path) {
    std::ifstream file(path);
    std::string line;
    std::getline(file, line);
    return line;
}

void mount_at(const char* type, const std::string& path) {
    make_folder(path);
    if (::mount(type, path.c_str(), type, 0, nullptr) != 0 && errno != EBUSY) {
        give_up("mount " + path);
    }
}

// --- devices
// ---------------------------------------------------------------------------------------------------------

bool load_module(const std::string& path) {
    const int descriptor = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
    if (descriptor < 0) {
        return false;
    }
    const bool loaded = ::syscall(SYS_finit_module, descriptor, "", 0) == 0 || errno == EEXIST;
    const int error = errno;
    ::close(descriptor);
    errno = error;
    return loaded;
}

// A module fails as long as one that it needs is missing. Which needs which changes from kernel to kernel, so
// it is tried again after the others.
void load_modules(std::vector<std::string> modules) {
    while (!modules.empty()) {
        if (std::erase_if(modules, load_module) == 0) {
            load_module(modules.front());
            give_up("load module " + modules.front());
        }
    }
}

int open_port(const std::string& wanted) {
    const std::string folder = "/sys/class/virtio-ports";
    for (int attempt = 0; attempt < 500; ++attempt) {
        if (DIR* ports = ::opendir(folder.c_str())) {
            while (const dirent* entry = ::readdir(ports)) {
                const std::string port = entry->d_name;
                if (read_line(folder + "/" + port + "/name") == wanted) {
                    const int descriptor = ::open(("/dev/" + port).c_str(), O_RDWR | O_CLOEXEC);
                    if (descriptor >= 0) {
                        ::closedir(ports);
                        return descriptor;
                    }
                }
            }
            ::closedir(ports);
        }
        pause_for(milliseconds(10));
    }
    give_up("open host port " + wanted);
}

void set_link(const std::string& name, bool up) {
    const int socket = ::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
    ifreq request{};
    name.copy(request.ifr_name, sizeof request.ifr_name - 1);
    if (socket < 0 || ::ioctl(socket, SIOCGIFFLAGS, &request) != 0) {
        give_up("find interface " + name);
    }
    const int flags = request.ifr_flags;
    request.ifr_flags = static_cast<short>(up ? (flags | IFF_UP) : (flags & ~IFF_UP));
    if (::ioctl(socket, SIOCSIFFLAGS, &request) != 0) {
        give_up("set interface " + name);
    }
    ::close(socket);
}

// One rtnetlink request, laid out by hand: the alternative is an `ip` program and its libraries in every
// guest.
class LinkRequest {
public:
    LinkRequest() {
        header_.nlmsg_len = NLMSG_LENGTH(sizeof(ifinfomsg));
        header_.nlmsg_type = RTM_NEWLINK;
        header_.nlmsg_flags = NLM_F_REQUEST | NLM_F_CREATE | NLM_F_EXCL | NLM_F_ACK;
    }

    std::size_t begin(unsigned short type) {
        const std::size_t at = attributes_.size();
        rtattr attribute{};
        attribute.rta_type = type;
        append(&attribute, sizeof attribute);
        return at;
    }

    void end(std::size_t at) {
        const auto length = static_cast<unsigned short>(attributes_.size() - at);
        std::memcpy(attributes_.data() + at + offsetof(rtattr, rta_len), &length, sizeof length);
        attributes_.resize((attributes_.size() + 3) / 4 * 4);
    }

    void text(unsigned short type, const std::string& value) {
        const std::size_t at = begin(type);
        append(value.data(), value.size());
        end(at);
    }

    bool send() {
        header_.nlmsg_len += static_cast<unsigned>(attributes_.size());
        std::vector<char> message(header_.nlmsg_len);
        std::memcpy(message.data(), &header_, sizeof header_);
        std::memcpy(message.data() + NLMSG_LENGTH(sizeof(ifinfomsg)), attributes_.data(), attributes_.size());
        const int socket = ::socket(AF_NETLINK, SOCK_RAW | SOCK_CLOEXEC, NETLINK_ROUTE);
        if (socket < 0 || ::send(socket, message.data(), message.size(), 0) < 0) {
            return false;
        }
        char answer[1024];
        const ssize_t count = ::recv(socket, answer, sizeof answer, 0);
        ::close(socket);
        if (count < static_cast<ssize_t>(NLMSG_LENGTH(sizeof(nlmsgerr)))) {
            errno = EPROTO;
            return false;
        }
        nlmsgerr error{};
        std::memcpy(&error, answer + NLMSG_LENGTH(0), sizeof error);
        errno = -error.error;
        return error.error == 0;
    }

private:
    void append(const void* bytes, std::size_t count) {
        const auto* first = static_cast<const char*>(bytes);
        attributes_.insert(attributes_.end(), first, first + count);
    }

    nlmsghdr header_{};
    std::vector<char> attributes_;
};

void create_can(const std::string& name) {
    LinkRequest request;
    request.text(IFLA_IFNAME, name);
    const std::size_t info = request.begin(IFLA_LINKINFO);
    request.text(IFLA_INFO_KIND, "vcan");
    request.end(info);
    if (!request.send()) {
        give_up("create CAN interface " + name);
    }
    set_link(name, true);
}

// A chip is reached by its name on both sides: /dev/NAME is the character device a driver opens, /sim/NAME is
// the folder in which the outside world pulls inputs and reads outputs (sim_gpioN/pull, sim_gpioN/value).
void create_gpio_chip(const std::string& name, const std::string& lines) {
    const std::string chip = "/sys/kernel/config/gpio-sim/" + name;
    const std::string bank = chip + "/bank0";
    if (::mkdir(chip.c_str(), 0755) != 0 || ::mkdir(bank.c_str(), 0755) != 0) {
        give_up("create GPIO chip " + name);
    }
    if (!write_text(bank + "/label", name) || !write_text(bank + "/num_lines", lines) ||
        !write_text(chip + "/live", "1")) {
        give_up("start GPIO chip " + name + " with " + lines + " lines");
    }
    const std::string device = read_line(bank + "/chip_name");
    const std::string simulation = "/sys/devices/platform/" + read_line(chip + "/dev_name") + "/" + device;
    make_folder("/sim");
    if (::symlink(("/dev/" + device).c_str(), ("/dev/" + name).c_str()) != 0 ||
        ::symlink(simulation.c_str(), ("/sim/" + name).c_str()) != 0) {
        give_up("name GPIO chip " + name);
    }
}

// --- commands
// --------------------------------------------------------------------------------------------------------

// Words are parted by blanks; single or double quotes keep blanks. Nothing else is special: what needs a
// shell brings one along.
std::vector<std::string> split(const std::string& line) {
    std::vector<std::string> words;
    std::string word;
    bool inside = false;
    char quote = 0;
    for (const char c : line) {
        if (quote != 0) {
            if (c == quote) {
                quote = 0;
            } else {
                word += c;
            }
        } else if (c == '\'' || c == '"') {
            quote = c;
            inside = true;
        } else if (c == ' ' || c == '\t') {
            if (inside) {
                words.push_back(word);
            }
            word.clear();
            inside = false;
        } else {
            word += c;
            inside = true;
        }
    }
    if (inside) {
        words.push_back(word);
    }
    return words;
}

std::string base_name(const std::string& path) { return path.substr(path.rfind('/') + 1); }

int to_exit_code(int status) { return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status); }

pid_t start(const std::vector<std::string>& words) {
    const pid_t pid = ::fork();
    if (pid < 0) {
        give_up("fork");
    }
    if (pid > 0) {
        return pid;
    }
    ::setsid();
    ::signal(SIGPIPE, SIG_DFL);
    ::dup2(console, STDOUT_FILENO);
    ::dup2(console, STDERR_FILENO);
    std::vector<char*> arguments;
    for (const std::string& word : words) {
        arguments.push_back(const_cast<char*>(word.c_str()));
    }
    arguments.push_back(nullptr);
    ::execvp(arguments[0], arguments.data());
    ::dprintf(STDERR_FILENO, "bench: cannot run '%s': %s; was it given to the bench with --file or --tool?\n",
              words[0].c_str(), std::strerror(errno));
    ::_exit(127);
}

void note_end_of(pid_t pid, int status) {
    for (BackgroundCommand& command : background) {
        if (command.pid == pid) {
            command.pid = -1;
            command.exit_code = to_exit_code(status);
            results.line("ended " + std::to_string(command.exit_code) + " " + command.name);
        }
    }
}

// PID 1 inherits every orphan, so each wait may see a process other than the one waited for.
int wait_for(pid_t wanted) {
    for (;;) {
        int status = 0;
        const pid_t pid = ::waitpid(-1, &status, 0);
        if (pid == wanted) {
            return to_exit_code(status);
        }
        if (pid > 0) {
            note_end_of(pid, status);
        } else if (errno == ECHILD) {
            return 127;
        }
    }
}

void collect_ended() {
    int status = 0;
    for (pid_t pid = ::waitpid(-1, &status, WNOHANG); pid > 0; pid = ::waitpid(-1, &status, WNOHANG)) {
        note_end_of(pid, status);
    }
}

int report_misuse(const std::string& message) {
    ::dprintf(console, "bench: %s\n", message.c_str());
    return 2;
}

BackgroundCommand* find_background(const std::string& name) {
    // The last one of a name is meant, so that a command can be started again.
    for (auto command = background.rbegin(); command != background.rend(); ++command) {
        if (command->name == name) {
            return &*command;
        }
    }
    return nullptr;
}

// Ends when `wanted` ends, with its code; when `other` ends first, with that one's, which then is a failure.
int wait_while(const BackgroundCommand& wanted, const BackgroundCommand& other) {
    while (wanted.pid > 0 && other.pid > 0) {
        int status = 0;
        if (const pid_t pid = ::waitpid(-1, &status, 0); pid > 0) {
            note_end_of(pid, status);
        }
    }
    if (wanted.pid < 0) {
        return wanted.exit_code;
    }
    ::dprintf(console, "bench: '%s' ended with exit code %d while '%s' was still at work\n",
              other.name.c_str(), other.exit_code, wanted.name.c_str());
    return other.exit_code != 0 ? other.exit_code : 1;
}

int signal_number(const std::string& name) {
    if (name == "TERM" || name.empty()) return SIGTERM;
    if (name == "INT") return SIGINT;
    if (name == "KILL") return SIGKILL;
    if (name == "STOP") return SIGSTOP;
    if (name == "CONT") return SIGCONT;
    if (name == "USR1") return SIGUSR1;
    if (name == "HUP") return SIGHUP;
    return -1;
}

int run_builtin(const std::vector<std::string>& words) {
    const std::string& name = words[0];
    const std::string first = words.size() > 1 ? words[1] : "";
    const std::string second = words.size() > 2 ? words[2] : "";
    if (name == "@sleep") {
        pause_for(milliseconds(static_cast<long>(std::strtod(first.c_str(), nullptr) * 1000)));
        return 0;
    }
    if (name == "@write") {
        if (write_text(first, second)) {
            return 0;
        }
        return report_misuse("@write " + first + ": " + std::strerror(errno));
    }
    if (name == "@link" && (second == "up" || second == "down")) {
        if (::if_nametoindex(first.c_str()) == 0) {
            return report_misuse("@link: there is no interface '" + first + "'; ask for it with --can");
        }
        set_link(first, second == "up");
        return 0;
    }
    if (name == "@signal" || name == "@wait") {
        collect_ended();
        BackgroundCommand* command = find_background(first);
        if (command == nullptr) {
            return report_misuse(name + ": no command '" + first + "' was started with '&'");
        }
        if (name == "@wait" && second == "while") {
            const BackgroundCommand* other = find_background(words.size() > 3 ? words[3] : "");
            if (other == nullptr) {
                return report_misuse("@wait NAME while OTHER: OTHER was not started with '&'");
            }
            return wait_while(*command, *other);
        }
        if (name == "@wait") {
            if (command->pid > 0) {
                const int code = wait_for(command->pid);
                command->pid = -1;
                command->exit_code = code;
            }
            return command->exit_code;
        }
        const int number = signal_number(second);
        if (number < 0) {
            return report_misuse("@signal: unknown signal '" + second +
                                 "'; use TERM INT KILL STOP CONT USR1 HUP");
        }
        if (command->pid < 0) {
            return report_misuse("@signal: '" + first + "' has ended already, with exit code " +
                                 std::to_string(command->exit_code));
        }
        return ::kill(command->pid, number) == 0
                   ? 0
                   : report_misuse("@signal: " + std::string(std::strerror(errno)));
    }
    return report_misuse(
        "unknown step '" + name +
        "'; use @sleep S, @write PATH TEXT, @link NAME up|down, @signal NAME SIGNAL or @wait NAME [while OTHER]");
}

int run(const std::string& line) {
    results.line("start " + line);
    std::vector<std::string> words = split(line);
    bool ignore = false;
    bool in_background = false;
    if (!words.empty() && words.front() == "-") {
        ignore = true;
        words.erase(words.begin());
    }
    if (!words.empty() && words.back() == "&") {
        in_background = true;
        words.pop_back();
    }
    if (words.empty()) {
        return 0;
    }
    int code = 0;
    if (words[0].front() == '@') {
        code = run_builtin(words);
    } else if (in_background) {
        background.push_back({base_name(words[0]), start(words), -1});
    } else {
        code = wait_for(start(words));
    }
    results.line("done " + std::to_string(code) + " " + line);
    return ignore ? 0 : code;
}

void stop_background() {
    collect_ended();
    const auto running = [] {
        collect_ended();
        return std::ranges::any_of(background,
                                   [](const BackgroundCommand& command) { return command.pid > 0; });
    };
    for (const int number : {SIGTERM, SIGKILL}) {
        for (const BackgroundCommand& command : background) {
            if (command.pid > 0) {
                ::kill(command.pid, number);
                ::kill(command.pid, SIGCONT);
            }
        }
        for (int attempt = 0; attempt < 200 && running(); ++attempt) {
            pause_for(milliseconds(10));
        }
    }
}

void hand_over(const std::string& path) {
    std::ifstream file(path, std::ios::binary);
    if (!file) {
        results.line("missing " + path);
        return;
    }
    std::ostringstream content;
    content << file.rdbuf();
    const std::string bytes = std::move(content).str();
    results.line("file " + std::to_string(bytes.size()) + " " + path);
    results.write_all(bytes);
}

[[noreturn]] void serve() {
    mount_at("devtmpfs", "/dev");
    mount_at("proc", "/proc");
    mount_at("sysfs", "/sys");
    for (const char* folder : {"/dev/shm", "/tmp", "/run"}) {
        mount_at("tmpfs", folder);
    }
    mount_at("devpts", "/dev/pts");
    ::setenv("PATH", "/bin:/usr/bin", 1);
    ::setenv("HOME", "/tmp", 1);
    // A command that dies in the middle must not take PID 1 with it.
    ::signal(SIGPIPE, SIG_IGN);

    std::vector<std::string> modules;
    std::vector<std::string> commands;
    std::vector<std::string> files;
    std::vector<std::pair<std::string, std::string>> devices;
    std::ifstream manifest("/bench/manifest");
    for (std::string line; std::getline(manifest, line);) {
        const std::size_t blank = line.find(' ');
        const std::string kind = line.substr(0, blank);
        const std::string rest = blank == std::string::npos ? "" : line.substr(blank + 1);
        if (kind == "module") {
            modules.push_back(rest);
        } else if (kind == "run") {
            commands.push_back(rest);
        } else if (kind == "collect") {
            files.push_back(rest);
        } else {
            devices.emplace_back(kind, rest);
        }
    }

    load_modules(modules);
    console = open_port("tappet.console");
    results.open(open_port("tappet.results"));
    ::mount("configfs", "/sys/kernel/config", "configfs", 0, nullptr);
    set_link("lo", true);
    for (const auto& [kind, rest] : devices) {
        if (kind == "can") {
            create_can(rest);
        } else if (kind == "gpio") {
            const std::size_t blank = rest.find(' ');
            create_gpio_chip(rest.substr(0, blank), rest.substr(blank + 1));
        } else if (kind == "set") {
            const std::size_t blank = rest.find(' ');
            if (!write_text(rest.substr(0, blank), rest.substr(blank + 1))) {
                give_up("set " + rest);
            }
        }
    }
    results.line("booted");
    say_to_host(start_of_output);

    int code = 0;
    for (const std::string& command : commands) {
        code = run(command);
        if (code != 0) {
            break;
        }
    }
    stop_background();
    for (const std::string& file : files) {
        hand_over(file);
    }
    results.line("exit " + std::to_string(code));

    // The host answers when it has read everything; only then may the power go.
    char answer = 0;
    if (say_to_host(end_of_output)) {
        while (::read(console, &answer, 1) < 0 && errno == EINTR) {
        }
    }
    power_off();
}

} // namespace
} // namespace tappet::bench

int main() { tappet::bench::serve(); }
