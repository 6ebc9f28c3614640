// The one place where the compiler accepts the loom's table for the host's board.
#include "apps/carpet_loom/host/loom_on_host.hpp"

#include "apps/carpet_loom/machine.hpp"
#include "board/host/board.hpp"
#include "kernel/services/configuration/property_files.hpp"

namespace tappet::carpet {

AcceptedMachine loom_on_host() { return Firmware<carpet_loom, board::host>::machine(); }

namespace {

PropertyFiles& files() {
    static PropertyFiles on_host{board::host.properties_directory};
    return on_host;
}

} // namespace

void keep_properties_in(std::string_view directory) { files().keep_in(directory); }

PropertyStore properties_on_host() { return files().store(); }

} // namespace tappet::carpet
