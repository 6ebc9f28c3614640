// Asks the kernel for its release and the file system for the size of this program.
#include "kernel/os/box.hpp"

#include "kernel/os/arming.hpp"

#include <string_view>

#include <sys/stat.h>
#include <sys/utsname.h>

namespace tappet::os {

Sentence kernel_release() noexcept {
    utsname names{};
    if (uname(&names) != 0) return Sentence{"unknown"};
    return Sentence{std::string_view{names.release}};
}

bool kernel_is_realtime() noexcept {
    const ArmingOptions here;
    for (const SystemCheck& check : system_checks())
        if (check.name == "realtime-kernel") return check.look(here, {}).good;
    return false;
}

std::size_t binary_bytes() noexcept {
    struct stat status{};
    return stat("/proc/self/exe", &status) == 0 ? static_cast<std::size_t>(status.st_size) : 0;
}

} // namespace tappet::os
