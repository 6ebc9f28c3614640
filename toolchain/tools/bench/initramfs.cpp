// SPDX-License-Identifier: Apache-2.0
#include "toolchain/tools/bench/initramfs.hpp"

#include <array>
#include <cstdlib>
#include <fstream>
#include <sstream>
#include <vector>

#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

namespace tappet::bench {

namespace fs = std::filesystem;

namespace {

std::string read_file(const fs::path& path) {
    std::ifstream file(path, std::ios::binary);
    if (!file) {
        throw BenchError("cannot read '" + path.string() +
                         "' for the guest; check --file and --tool, and build it first");
    }
    std::ostringstream content;
    content << file.rdbuf();
    return std::move(content).str();
}

// The loader lists the libraries of a program; for a static program it prints nothing.
std::string libraries_of(const fs::path& program) {
    int ends[2];
    if (::pipe(ends) != 0) throw BenchError("no pipe left on the host to run ldd");
    const pid_t pid = ::fork();
    if (pid == 0) {
        ::dup2(ends[1], STDOUT_FILENO);
        ::close(STDERR_FILENO);
        ::close(ends[0]);
        ::execlp("ldd", "ldd", program.c_str(), static_cast<char*>(nullptr));
        ::_exit(127);
    }
    ::close(ends[1]);
    std::string text;
    std::array<char, 4096> piece{};
    for (ssize_t count = 0; (count = ::read(ends[0], piece.data(), piece.size())) > 0;)
        text.append(piece.data(), static_cast<std::size_t>(count));
    ::close(ends[0]);
    ::waitpid(pid, nullptr, 0);
    return text;
}

// Returns true for parts of Python's standard library that nothing on the bench uses: more than half of it.
bool is_ballast(const std::string& folder) {
    static const std::set<std::string> names = {"test",    "idlelib", "ensurepip",
                                                "lib2to3", "tkinter", "pydoc_data"};
    return names.contains(folder) || folder.starts_with("config-3.");
}

} // namespace

fs::path find_program(const std::string& name) {
    if (name.find('/') != std::string::npos) return name;
    const char* variable = std::getenv("PATH");
    // The distribution's folders come first: other programs on a developer's path may be scripts around them.
    std::istringstream folders("/usr/bin:/usr/sbin:" + std::string(variable != nullptr ? variable : ""));
    for (std::string folder; std::getline(folders, folder, ':');) {
        const fs::path candidate = fs::path(folder) / name;
        if (::access(candidate.c_str(), X_OK) == 0 && !fs::is_directory(candidate)) return candidate;
    }
    throw BenchError("the program '" + name + "' is not on this machine; run ci/setup once as root");
}

Initramfs::Initramfs(const fs::path& archive, const Architecture& architecture)
    : architecture_(architecture), archive_(std::fopen(archive.c_str(), "wb")) {
    if (archive_ == nullptr) {
        throw BenchError("cannot write '" + archive.string() +
                         "'; check the space and rights of the temporary folder");
    }
    // The kernel opens this file for PID 1 before anything is mounted.
    add_folder("/dev");
    entry("/dev/console", S_IFCHR | 0600, {}, 5, 1);
}

Initramfs::~Initramfs() {
    if (archive_ != nullptr) std::fclose(archive_);
}

void Initramfs::entry(const std::string& guest, unsigned mode, std::string_view content, unsigned major,
                      unsigned minor) {
    static constexpr std::array<char, 4> padding{};
    const std::string name = guest.substr(guest.find_first_not_of('/'));
    std::array<char, 111> header{};
    std::snprintf(header.data(), header.size(), "070701%08X%08X%08X%08X%08X%08X%08X%08X%08X%08X%08X%08X%08X",
                  next_inode_++, mode, 0U, 0U, 1U, 0U, static_cast<unsigned>(content.size()), 0U, 0U, major,
                  minor, static_cast<unsigned>(name.size() + 1), 0U);
    std::fwrite(header.data(), 1, 110, archive_);
    std::fwrite(name.c_str(), 1, name.size() + 1, archive_);
    std::fwrite(padding.data(), 1, (4 - (110 + name.size() + 1) % 4) % 4, archive_);
    std::fwrite(content.data(), 1, content.size(), archive_);
    std::fwrite(padding.data(), 1, (4 - content.size() % 4) % 4, archive_);
}

void Initramfs::add_folder(const std::string& guest) {
    if (guest.empty() || guest == "/" || !present_.insert(guest).second) return;
    add_folder(guest.substr(0, guest.rfind('/')));
    entry(guest, S_IFDIR | 0755, {});
}

void Initramfs::add_text(const std::string& guest, std::string_view text) {
    add_folder(guest.substr(0, guest.rfind('/')));
    if (present_.insert(guest).second) entry(guest, S_IFREG | 0644, text);
}

void Initramfs::add_file(const fs::path& host, const std::string& guest) {
    if (present_.contains(guest)) return;
    add_folder(guest.substr(0, guest.rfind('/')));
    const std::string content = read_file(host);
    const std::uint16_t elf = elf_machine_of(host);
    if (elf != 0 && elf != architecture_.elf) {
        throw BenchError("'" + host.string() + "' is a program for " + architecture_of(elf, host).name +
                         ", and the first one given makes this box an " + architecture_.name +
                         "; give programs of one architecture, and no tools of the host to a box of another");
    }
    present_.insert(guest);
    // Not the file's own mode, which depends on its builder: the same files must give the same archive.
    entry(guest, S_IFREG | (::access(host.c_str(), X_OK) == 0 ? 0755U : 0644U), content);
    if (elf != 0) add_libraries(host);
}

void Initramfs::add_libraries(const fs::path& program) {
    std::istringstream lines(libraries_of(program));
    for (std::string line; std::getline(lines, line);) {
        if (line.find("not found") != std::string::npos) {
            throw BenchError("'" + program.string() + "' needs a library that this machine lacks:" + line +
                             "; install it, or link the program statically");
        }
        const std::size_t from = line.find('/');
        if (from != std::string::npos) {
            const std::string library = line.substr(from, line.find(' ', from) - from);
            add_file(library, library);
        }
    }
}

void Initramfs::add(const fs::path& host, const std::string& guest) {
    if (guest.empty() || guest.front() != '/') {
        throw BenchError("'" + guest +
                         "' is not a path in the guest; give an absolute path, as in --file HOST=/GUEST");
    }
    if (!fs::exists(host)) {
        throw BenchError("'" + host.string() +
                         "' does not exist on this machine; check --file, and build it first");
    }
    if (!fs::is_directory(host)) {
        add_file(host, guest);
        return;
    }
    add_folder(guest);
    for (auto item = fs::recursive_directory_iterator(host); item != fs::recursive_directory_iterator();
         ++item) {
        if (item->is_directory() && is_ballast(item->path().filename().string()))
            item.disable_recursion_pending();
        else if (item->is_regular_file())
            add_file(item->path(), guest + "/" + fs::relative(item->path(), host).string());
    }
}

void Initramfs::add_tool(const std::string& name) {
    const fs::path program = find_program(name);
    add(program, "/bin/" + program.filename().string());
    const std::string interpreter = fs::canonical(program).filename().string();
    if (interpreter.starts_with("python3.")) add("/usr/lib/" + interpreter, "/usr/lib/" + interpreter);
}

void Initramfs::finish() {
    entry("TRAILER!!!", 0, {});
    const bool complete = std::fclose(archive_) == 0;
    archive_ = nullptr;
    if (!complete)
        throw BenchError("the guest's archive could not be written; check the space of the temporary folder");
}

} // namespace tappet::bench
