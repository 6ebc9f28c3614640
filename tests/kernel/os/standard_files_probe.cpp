// A small program that can be started without its standard files: it prints, opens a file, and exits with
// that file's number.
#include "kernel/os/terminal.hpp"

#include <fcntl.h>

int main() {
    tappet::os::print("printed\n");
    return open("/", O_RDONLY | O_DIRECTORY | O_CLOEXEC);
}
