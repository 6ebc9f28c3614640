// An emulated industrial PC with UEFI, one disk and a watchdog, as a box comes from its maker. What it says
// on its serial port is the text of a run.
#pragma once

#include <array>
#include <cerrno>
#include <cstdlib>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <vector>

#include <csignal>
#include <fcntl.h>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <sys/wait.h>
#include <unistd.h>

namespace tappet::bench {

class EmulatedBox {
public:
    /// With a copy of the disk, which is gone with this.
    explicit EmulatedBox(const std::filesystem::path& disk) {
        std::string pattern = (std::filesystem::temp_directory_path() / "tappet-box-XXXXXX").string();
        if (::mkdtemp(pattern.data()) == nullptr) throw std::runtime_error("no temporary folder " + pattern);
        folder_ = pattern;
        copy(disk, this->disk());
        copy("/usr/share/OVMF/OVMF_VARS_4M.fd", folder_ / "vars");
    }
    ~EmulatedBox() {
        switch_off();
        std::filesystem::remove_all(folder_);
    }
    EmulatedBox(const EmulatedBox&) = delete;
    EmulatedBox& operator=(const EmulatedBox&) = delete;

    [[nodiscard]] std::filesystem::path disk() const { return folder_ / "disk"; }
    [[nodiscard]] std::filesystem::path operator/(const char* name) const { return folder_ / name; }

    /// From power on. `more`: further words for the emulator.
    void switch_on(const std::vector<std::string>& more = {}) {
        const std::string code = "if=pflash,format=raw,readonly=on,file=/usr/share/OVMF/OVMF_CODE_4M.fd";
        std::vector<std::string> words{
            "qemu-system-x86_64", "-nodefaults", "-no-user-config", "-display", "none", "-machine",
            "q35,accel=tcg", "-m", "256",
            // One processor whose time follows its instructions, so that a busy host misses no deadline for
            // it. A wait for the host's disk leaps to the guest's next timer, at worst the watchdog's: hence
            // no flushing, and no bounds.
            "-icount", "shift=1,sleep=off", "-drive", code, "-drive",
            "if=pflash,format=raw,file=" + (folder_ / "vars").string(), "-drive",
            "if=none,id=disk,format=raw,cache=unsafe,file=" + disk().string(), "-device",
            "nvme,drive=disk,serial=1", "-device", "i6300esb", "-action", "watchdog=reset", "-serial",
            "stdio", "-monitor", "unix:" + (folder_ / "monitor").string() + ",server=on,wait=off"};
        words.insert(words.end(), more.begin(), more.end());
        start(words);
    }

    /// What it has said, once that holds `wanted`, or all when it switched itself off. Empty words never
    /// come.
    const std::string& await(const std::string& wanted) {
        std::array<char, 4096> piece{};
        while (said_.find(wanted) == std::string::npos) {
            const ssize_t count = ::read(output_, piece.data(), piece.size());
            if (count <= 0) break;
            said_.append(piece.data(), static_cast<std::size_t>(count));
        }
        return said_;
    }
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
        const std::string command = "system_powerdown\n";
        if (::connect(monitor, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0 ||
            ::write(monitor, command.data(), command.size()) != static_cast<ssize_t>(command.size()))
            throw std::runtime_error("the emulator's monitor does not answer");
        char answer = 0;
        while (answer != '\n' && ::read(monitor, &answer, 1) == 1) {
        }
        ::close(monitor);
    }

    /// The plug is pulled.
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

    void start(const std::vector<std::string>& words) {
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

    std::filesystem::path folder_{};
    std::string said_{};
    pid_t pid_ = -1;
    int output_ = -1;
};

} // namespace tappet::bench
