// The plant of an image whose firmware is harmed, like faults of a new version that its makers never saw.
//     --sabotage crash|late|both, then the plant's own words
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <string>

#include <csignal>
#include <ctime>
#include <sched.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <unistd.h>

extern "C" const unsigned char the_plant[];
extern "C" const unsigned char the_plant_end[];
asm(".section .rodata\n"
    ".global the_plant, the_plant_end\n"
    "the_plant: .incbin \"" PLANT "\"\n"
    "the_plant_end: .byte 0\n"
    ".text\n");

namespace {

pid_t parent_of(pid_t process) {
    pid_t parent = 0;
    if (std::FILE* const file = std::fopen(("/proc/" + std::to_string(process) + "/stat").c_str(), "r")) {
        if (std::fscanf(file, "%*d (%*[^)]) %*c %d", &parent) != 1) parent = 0;
        std::fclose(file);
    }
    return parent;
}

/// Finds the process of a firmware that runs the machine: the guardian is its parent, and init's child.
pid_t find_machine() {
    for (const auto& each : std::filesystem::directory_iterator{"/proc"}) {
        const pid_t pid = std::atoi(each.path().filename().c_str());
        std::error_code error;
        if (pid <= 1 || std::filesystem::read_symlink(each.path() / "exe", error) != "/bin/firmware")
            continue;
        if (parent_of(pid) > 1) return pid;
    }
    return 0;
}

double now_s() {
    timespec now{};
    ::clock_gettime(CLOCK_MONOTONIC, &now);
    return static_cast<double>(now.tv_sec) + static_cast<double>(now.tv_nsec) * 1e-9;
}

void do_harm(const char* which) {
    pid_t machine = 0;
    while ((machine = find_machine()) == 0) ::usleep(100'000);
    ::sleep(1); // it weaves, and has not yet proven itself
    if (std::strcmp(which, "crash") == 0) {
        ::kill(machine, SIGSEGV);
        return;
    }
    sched_param above_all{99};
    ::sched_setscheduler(0, SCHED_FIFO, &above_all);
    if (std::strcmp(which, "both") == 0) { // no process is left to write safe values
        ::kill(parent_of(machine), SIGKILL);
        ::kill(machine, SIGKILL);
        return;
    }
    for (const double until = now_s() + 0.03; now_s() < until;) {
    }
}

} // namespace

int main(int count, char** words) {
    if (count < 3 || std::strcmp(words[1], "--sabotage") != 0) return 2;
    const pid_t us = ::getpid();
    if (::fork() == 0) {
        ::prctl(PR_SET_PDEATHSIG, SIGKILL);
        if (::getppid() == us) do_harm(words[2]);
        return 0;
    }
    const int program = ::memfd_create("plant", MFD_CLOEXEC);
    const auto size = static_cast<std::size_t>(the_plant_end - the_plant);
    if (::write(program, the_plant, size) != static_cast<ssize_t>(size)) return 2;
    words[2] = words[0];
    ::fexecve(program, words + 2, environ);
    std::perror("saboteur: cannot become the plant");
    return 2;
}
