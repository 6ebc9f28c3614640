// Checks all objects of an EDS or DCF file, whoever maps or writes them.
#include "drivers/canopen/eds_faults.hpp"
#include "toolchain/tools/check/check.hpp"

namespace tappet::checking {

std::vector<Finding> check_eds(std::string_view text) {
    std::vector<Finding> found;
    for (canopen::EdsFault& each : canopen::eds_faults({"", text})) {
        const bool is_note = each.affects == "nobody";
        found.push_back(
            {.line = each.line,
             .weight = each.is_fatal ? Weight::unreadable
                       : is_note     ? Weight::note
                                     : Weight::fault,
             .meaning = std::move(each.meaning),
             .affects = is_note ? std::vector<std::string>{} : std::vector{std::move(each.affects)}});
    }
    return found;
}

} // namespace tappet::checking
