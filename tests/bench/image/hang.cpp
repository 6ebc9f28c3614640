// A PID 1 that does nothing, like a new version that its makers never started.
#include <cstdio>

#include <fcntl.h>
#include <sys/mount.h>
#include <sys/stat.h>
#include <unistd.h>

int main() {
    ::mkdir("/dev", 0755);
    ::mount("devtmpfs", "/dev", "devtmpfs", 0, nullptr);
    if (const int console = ::open("/dev/ttyS0", O_WRONLY | O_NOCTTY); console >= 0)
        ::dprintf(console, "hang: it hangs\n");
    for (;;) ::pause();
}
