// An emulated industrial PC with UEFI, one disk and a watchdog, as delivered by its maker. The output of its
// serial port is the text of a run.
#pragma once

#include "tests/toolchain/folder.hpp"

#include <array>
#include <cerrno>
#include <cstdlib>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <vector>

#include <csignal>
#include <fcntl.h>
#include <netinet/in.h>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <sys/wait.h>
#include <unistd.h>

namespace tappet::bench {

class EmulatedBox {
public:
    /// Uses a copy of the disk, which is deleted with this object. `keys`: keys enrolled in its setup, after
    /// which it boots only what they signed.
    explicit EmulatedBox(const std::filesystem::path& disk, const std::filesystem::path& keys = {}) {
        copy(disk, this->disk());
        copy("/usr/share/OVMF/OVMF_VARS_4M.fd", folder_ / "vars");
        if (!keys.empty()) enrol(keys);
        port_ = free_port();
    }
    ~EmulatedBox() { switch_off(); }
    EmulatedBox(const EmulatedBox&) = delete;
    EmulatedBox& operator=(const EmulatedBox&) = delete;

    [[nodiscard]] std::filesystem::path disk() const { return folder_ / "disk"; }
    [[nodiscard]] std::filesystem::path operator/(const char* name) const { return folder_ / name; }

    /// The address of its service.
    [[nodiscard]] std::string address() const { return "127.0.0.1:" + std::to_string(port_); }
    /// From now on, everything written to its disk is also logged, and every flush.
    std::filesystem::path record() {
        std::filesystem::remove(folder_ / "log");
        const int log = ::open((folder_ / "log").c_str(), O_CREAT | O_WRONLY | O_CLOEXEC, 0600);
        if (log < 0 || ::ftruncate(log, 1L << 32) != 0) throw std::runtime_error("no room for a log");
        ::close(log);
        is_recorded_ = true;
        return folder_ / "log";
    }

    /// Starts from power on. `more`: further arguments for the emulator.
    void switch_on(std::vector<std::string> more = {}) {
        more.insert(more.end(),
                    {"-drive", "if=pflash,format=raw,readonly=on,file=/usr/share/OVMF/OVMF_CODE_4M.fd",
                     "-drive", "if=pflash,format=raw,file=" + (folder_ / "vars").string()});
        start_counting(more);
    }

    /// The same without UEFI and loader, which take most of the host's time.
    void switch_on_at_kernel(const std::filesystem::path& kernel, const std::filesystem::path& root,
                             const std::string& command_line) {
        start_counting({"-kernel", kernel.string(), "-initrd", root.string(), "-append", command_line});
    }

    /// Boots another kernel and its root, without the loader, and in the host's time. The disk is at a SATA
    /// port, whose driver flushes; the emulated NVMe disk would forget at a kill which writes must be on the
    /// disk.
    void switch_on_with(const std::filesystem::path& kernel, const std::filesystem::path& root) {
        start({"-device", "ide-hd,drive=disk,bus=ide.0", "-kernel", kernel.string(), "-initrd", root.string(),
               "-append", "console=ttyS0 quiet panic=-1 rdinit=/init", "-no-reboot"});
    }

    /// Returns its output once that contains `wanted`, or all output when it switched itself off. An empty
    /// `wanted` never matches.
    const std::string& await(const std::string& wanted) {
        std::array<char, 4096> piece{};
        while (said_.find(wanted) == std::string::npos) {
            const ssize_t count = ::read(output_, piece.data(), piece.size());
            if (count <= 0) break;
            said_.append(piece.data(), static_cast<std::size_t>(count));
        }
        return said_;
    }
    /// From now on, await() counts only new output.
    void forget() { said_.clear(); }
    const std::string& await_end() {
        await(std::string(1, '\0') + "never");
        ::waitpid(pid_, nullptr, 0);
        pid_ = -1;
        return said_;
    }

    void press_power_button() const {
        const int monitor = ::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0);
        sockaddr_un address{};
        address.sun_family = AF_UNIX;
        (folder_ / "monitor").string().copy(address.sun_path, sizeof address.sun_path - 1);
        // The monitor answers the second command once the first one is done; hanging up earlier would cancel
        // it.
        const std::string command = "system_powerdown\ninfo status\n";
        if (::connect(monitor, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0 ||
            ::write(monitor, command.data(), command.size()) != static_cast<ssize_t>(command.size()))
            throw std::runtime_error("the emulator's monitor does not answer");
        std::string answer;
        for (char character = 0; !answer.contains("VM status") && ::read(monitor, &character, 1) == 1;)
            answer += character;
        ::close(monitor);
    }

    /// Pulls the plug.
    void switch_off() {
        if (pid_ > 0) {
            ::kill(pid_, SIGKILL);
            ::waitpid(pid_, nullptr, 0);
        }
        pid_ = -1;
        if (output_ >= 0) ::close(output_);
        output_ = -1;
        said_.clear();
    }

private:
    static void copy(const std::filesystem::path& from, const std::filesystem::path& to) {
        const std::string line = "cp --sparse=always '" + from.string() + "' '" + to.string() + "'";
        if (std::system(line.c_str()) != 0) throw std::runtime_error(line); // NOLINT: a test's own words
    }

    void enrol(const std::filesystem::path& keys) const {
        const std::string owner = " 74617070-6574-4d00-8000-000000000000 ",
                          vars = (folder_ / "vars").string();
        const auto certificate = [&](const char* name) { return owner + (keys / name).string() + ".crt"; };
        const std::string line = "virt-fw-vars --inplace " + vars + " --set-pk" + certificate("PK") +
                                 " --add-kek" + certificate("KEK") + " --add-db" + certificate("db") +
                                 " --sb >/dev/null 2>&1";
        if (std::system(line.c_str()) != 0) throw std::runtime_error(line); // NOLINT: a test's own words
    }

    /// A free port; a process that takes it before the emulator does makes the test fail, not pass.
    static unsigned free_port() {
        const int socket = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
        sockaddr_in address{};
        address.sin_family = AF_INET;
        address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
        socklen_t length = sizeof address;
        if (::bind(socket, reinterpret_cast<const sockaddr*>(&address), length) != 0 ||
            ::getsockname(socket, reinterpret_cast<sockaddr*>(&address), &length) != 0)
            throw std::runtime_error("no port is left");
        ::close(socket);
        return ntohs(address.sin_port);
    }

    void start_counting(const std::vector<std::string>& more) {
        std::vector<std::string> words{
            // One processor whose time follows its instructions, so that a busy host misses no deadline for
            // it. A wait for the host's disk leaps to the guest's next timer, at worst the watchdog's: hence
            // no flushing, and no bounds.
            "-icount", "shift=1,sleep=off", "-device", "nvme,drive=disk,serial=1", "-netdev",
            "user,id=net,hostfwd=tcp:127.0.0.1:" + std::to_string(port_) + "-:4848",
            // Without the card's own program, which would boot from the network as the last choice.
            "-device", "e1000e,netdev=net,romfile="};
        words.insert(words.end(), more.begin(), more.end());
        start(words);
    }

    void start(const std::vector<std::string>& more) {
        const std::string monitor = "unix:" + (folder_ / "monitor").string() + ",server=on,wait=off";
        std::vector<std::string> words{"qemu-system-x86_64",
                                       "-nodefaults",
                                       "-no-user-config",
                                       "-display",
                                       "none",
                                       "-machine",
                                       "q35,accel=tcg",
                                       "-m",
                                       "256",
                                       "-device",
                                       "i6300esb",
                                       "-action",
                                       "watchdog=reset",
                                       "-serial",
                                       "stdio",
                                       "-monitor",
                                       monitor};
        const std::string unflushed = ",cache.no-flush=on,driver=file,filename=";
        const auto add = [&](const std::string& node) { words.insert(words.end(), {"-blockdev", node}); };
        add("node-name=file" + unflushed + disk().string());
        add(std::string{"driver=raw,file=file,cache.no-flush=on,node-name="} +
            (is_recorded_ ? "plain" : "disk"));
        if (is_recorded_) {
            add("node-name=log" + unflushed + (folder_ / "log").string());
            add("driver=blklogwrites,node-name=disk,file=plain,log=log");
        }
        words.insert(words.end(), more.begin(), more.end());
        int ends[2];
        if (::pipe2(ends, O_CLOEXEC) != 0) throw std::runtime_error("no pipe left");
        std::vector<char*> arguments;
        for (const std::string& word : words) arguments.push_back(const_cast<char*>(word.c_str()));
        arguments.push_back(nullptr);
        const pid_t parent = ::getpid();
        pid_ = ::fork();
        if (pid_ == 0) {
            ::prctl(PR_SET_PDEATHSIG, SIGKILL);
            if (::getppid() != parent) ::_exit(127);
            ::close(STDIN_FILENO);
            ::dup2(ends[1], STDOUT_FILENO);
            ::dup2(ends[1], STDERR_FILENO);
            ::execvp(arguments[0], arguments.data());
            ::_exit(127);
        }
        ::close(ends[1]);
        output_ = ends[0];
    }

    test::Folder folder_{};
    std::string said_{};
    bool is_recorded_ = false;
    pid_t pid_ = -1;
    int output_ = -1;
    unsigned port_ = 0;
};

} // namespace tappet::bench
